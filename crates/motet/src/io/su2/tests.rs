use super::*;
use crate::base::{Result, VertexId};
use crate::io::in_memory::{parsed, printed_text, refuses};
use crate::mesh::{Cells, Field, Mesh};

fn parse_noted(text: &str) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.su2", text.as_bytes())
}

fn parse(text: &str) -> Mesh {
    parse_noted(text).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// A tet and a pyramid with three markers, written in the ways that SU2 permits.
const TWO: &str = "\
% made by hand
NDIME= 3
NELEM=2
10 0 1 2 4 0  % a tet
14 0 1 5 2 3
%
NPOIN= 6 6
 0 0 0 0
 1. 0 0 1
 0 1 0 2
 0 0 -1 3

 0 0 1 4
 1 1 0
NMARK = 3
MARKER_TAG= wall % of the vessel
MARKER_ELEMS= 2
5 0 2 1 0
5 0 1 4
MARKER_TAG= 7
MARKER_ELEMS= 0
MARKER_TAG= in let
MARKER_ELEMS= 1
9 0 1 5 2
FFD_NBOX= 1
FFD_CORNER_POINTS= 1
0.0 0.0 0.0
";

#[test]
fn elements_and_markers_are_read() {
    let (mesh, notes) = parse_noted(TWO);
    let mesh = mesh.unwrap();
    let kinds = [CellKind::TETRA, CellKind::PYRAMID, CellKind::TRIANGLE, CellKind::TRIANGLE, CellKind::QUAD];
    assert_eq!(mesh.cells.kinds(), kinds);
    assert_eq!(mesh.points[3], [0.0, 0.0, -1.0]);
    let patches = mesh.patches().unwrap();
    assert_eq!(patches.ids, [0, 0, 1, 1, 2]);
    assert_eq!(
        (patches.name(1), patches.name(2), patches.name(7)),
        ("wall".into(), "in let".into(), "7".into())
    );
    assert_eq!(notes, ["`FFD_NBOX` is skipped", "`FFD_CORNER_POINTS` is skipped"]);
}

#[test]
fn what_is_read_comes_back() {
    let mesh = parse(TWO);
    let (text, lost) = print(&mesh);
    assert_eq!(lost, ["the patch \"in let\" is written as in_let: SU2 names are single words"]);
    let mut back = parse(&text);
    back.label_names = mesh.label_names.clone();
    assert_eq!(back, mesh);
}

#[test]
fn markers_may_precede_the_elements() {
    let (elements, rest) = TWO.split_at(TWO.find("NPOIN").unwrap());
    let (head, elements) = elements.split_at(elements.find("NELEM").unwrap());
    let turned = format!("{head}{}{elements}", &rest[..rest.find("FFD").unwrap()]);
    assert_eq!(parse(&turned), parse(TWO));
}

#[test]
fn a_mesh_of_two_dimensions_is_a_surface_with_labelled_lines() {
    let text = "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0 1\n0 1\nNMARK= 1\nMARKER_TAG= 4\nMARKER_ELEMS= 1\n3 0 1\n";
    let mesh = parse(text);
    assert_eq!(mesh.cells.kinds(), [CellKind::TRIANGLE, CellKind::LINE]);
    assert_eq!(mesh.points[1], [1.0, 0.0, 0.0]);
    assert_eq!(mesh.cell_field(TAG).unwrap().values, vec![0, 4].into());
    let (again, lost) = print(&mesh);
    assert!(again.starts_with("NDIME= 2\n") && lost.is_empty(), "{lost:?}");
    assert_eq!(parse(&again), mesh);
}

#[test]
fn what_cannot_be_held_is_reported() {
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::QUADRATIC_LINE, [0, 1, 2].map(VertexId));
    let mut mesh = Mesh::new(vec![[0.0; 3]; 4], cells);
    mesh.set_cell_field(Field::scalars("region", vec![0, 3, 0]));
    mesh.set_point_field(Field::scalars("p", vec![0.5; 4]));
    mesh.label_names.regions.insert(3, "blood".into());
    let (text, lost) = print(&mesh);
    for expected in ["line3", "region", "blood", "p", "order", "unlabelled"] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
    assert_eq!(parse(&text).cells.kinds(), [CellKind::TETRA, CellKind::TRIANGLE]);
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        ("NDIME= 3", "NDIME= 4", "line 2: expected dimension 2 or 3, found 4"),
        ("NDIME= 3\n", "", "line 2: elements precede the dimension; put NDIME first"),
        (
            "NELEM=2",
            "NELEM=2000",
            "line 3: 2000 elements declared, but the rest of the file can hold at most",
        ),
        ("10 0 1 2 4 0", "10 0 1", "line 4: expected vertex of a cell, found the end of the line"),
        ("10 0 1 2 4 0", "10 0 1 2 4 0 7", "line 4: element: expected the end of the line, found `7`"),
        ("10 0 1 2 4 0", "24 0 1 2 4 0", "line 4: expected an element type 10 (tetra), 12 (hexahedron)"),
        ("10 0 1 2 4 0", "10 0 1 2 -4 0", "line 4: a cell refers to vertex -4"),
        ("10 0 1 2 4 0", "10 0 1 2 6 0", "cell 0: refers to point 6, but there are 6 points"),
        ("5 0 2 1 0", "5 0 2 9 0", "line 18: a cell refers to vertex 9, but there are 6 vertices"),
        ("1. 0 0 1", "1. 0", "line 9: expected coordinate, found the end of the line"),
        ("NPOIN= 6 6", "NPOIN= 5", "line 14: line: expected `KEY= value`, found `1 1 0`"),
        ("NPOIN= 6 6", "NPOIM= 6 6", "there are no points (NPOIN)"),
        ("NMARK = 3", "NMARK = 4", "4 markers declared, but the file has 3"),
        ("% made by hand", "NZONE= 2", "line 1: the file has 2 zones, of which a mesh holds one; write each"),
        ("MARKER_TAG= 7", "MARKER_TAG= SEND_RECEIVE", "line 20: the file is a part of a partitioned mesh"),
        ("MARKER_TAG= 7", "MARKER_TAG= % 7", "line 20: expected the name of a marker"),
    ];
    refuses(&FORMAT, "in.su2", TWO, &damages);
}
