use super::*;
use crate::base::{Result, VertexId};
use crate::io::in_memory::{parsed, printed_text, refuses, survives_changed_bytes};
use crate::mesh::{CellKind, Cells, Field, Mesh};

fn parse_noted(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.cas", bytes)
}

pub(super) fn parse(text: &str) -> Mesh {
    parse_noted(text.as_bytes()).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// Two tets, each a zone of its own; the face between them is a wall, the others are three zones. Points
/// begin with number 5 and come in two sections.
pub(super) const TWO: &str = "\
(0 \"by hand, with a bracket ( in it\")
(1 \"motet \\\"3D\\\"\")
(2 3)
(37 ((relax 1) (name \"a (\")))
(10 (0 1 5 0))
(10 (2 7 9 1 3)(
0 1 0
0 0 1
-1 0 0.5
))
(10 (1 5 6 1 3)(
0 0 0 1 0 0))
(12 (0 1 2 0))
(12 (a 1 1 1 2))
(12 (b 2 2 1 0)(2))
(13 (0 1 7 0))
(13 (3 1 1 3 3)(
5 7 8 1 2
))
(13 (4 2 4 a 0)(
3 5 6 7 1 0
3 5 8 6 1 0
3 6 8 7 1 0
))
(13 (5 5 7 24 3)(
5 9 7 0 2
5 9 8 2 0
8 9 7 2 0
))
(45 (10 fluid blood)())
(39 (11 solid tissue 1)(
(material . wood) (x \")\")))
(45 (3 wall flap)())
(45 (4 velocity-inlet in-let)())
(45 (99 wall nowhere)())
";

#[test]
fn cells_are_found_from_faces() {
    let mesh = parse(TWO);
    assert_eq!(mesh.cells.kinds()[..2], [CellKind::TETRA; 2]);
    assert_eq!(mesh.cells.kinds()[2..], [CellKind::TRIANGLE; 7]);
    let volume = |cell: usize| {
        let v = mesh.cells.connectivity().list(cell);
        let p: Vec<_> = v.iter().map(|v| mesh.points[v.index()]).collect();
        crate::geometry::tet::volume([p[0], p[1], p[2], p[3]])
    };
    assert!(volume(0) > 0.0 && volume(1) > 0.0);
    assert_eq!(mesh.points[4], [-1.0, 0.0, 0.5]);
    let (regions, patches) = (mesh.regions().unwrap(), mesh.patches().unwrap());
    assert_eq!(regions.ids, [10, 11, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!((regions.name(10), regions.name(11)), ("blood".into(), "tissue".into()));
    assert_eq!(patches.ids, [0, 0, 3, 4, 4, 4, 5, 5, 5]);
    assert_eq!(
        (patches.name(3), patches.name(4), patches.name(5)),
        ("flap".into(), "in-let".into(), "5".into())
    );
    assert_eq!(patches.names.len(), 2);
}

#[test]
fn msh_files_are_told_apart_by_their_contents() {
    let found = parsed(&crate::io::msh::FORMAT, "in.msh", TWO.as_bytes()).0.unwrap();
    assert_eq!(found, parse(TWO));
    for (text, is) in
        [("(0 \"x\")", true), (" \n( 2 3)", true), ("$MeshFormat\n", false), ("()", false), ("", false)]
    {
        assert_eq!(has_sections(text.as_bytes()), is, "{text}");
    }
}

#[test]
fn compressed_files_are_read() {
    let bytes = crate::io::gzip::compress(TWO.as_bytes());
    assert_eq!(parsed(&FORMAT, "in.cas.gz", &bytes).0.unwrap(), parse(TWO));
}

#[test]
fn what_is_read_comes_back() {
    // The wall between cells is a zone of faces between them as well.
    let mesh =
        parse(&TWO.replace("(13 (3 1 1 3 3)", "(13 (3 1 1 2 3)").replace("(45 (3 wall", "(45 (3 interior"));
    let (text, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    let back = parse(&text);
    assert_eq!((&back.points, &back.cell_data), (&mesh.points, &mesh.cell_data));
    assert_eq!(back.label_names.regions, mesh.label_names.regions);
    assert_eq!(
        (back.patches().unwrap().name(4), back.patches().unwrap().name(5)),
        ("in-let".into(), "wall-5".into())
    );
    assert_eq!(print(&back).0, text);
}

/// A section in binary form.
fn binary(index: &str, header: &str, bytes: &[u8]) -> Vec<u8> {
    [
        format!("({index} ({header})(").as_bytes(),
        bytes,
        format!(")\nEnd of Binary Section   {index})\n").as_bytes(),
    ]
    .concat()
}

#[test]
fn binary_sections_are_those_of_text() {
    let ints = |numbers: &[i32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let points = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.5];
    let single: Vec<u8> = points.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect();
    let double: Vec<u8> = [0.0f64, 0.0, 0.0, 1.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let at = |text: &str| TWO.find(text).unwrap();
    let head = &TWO[..at("(10 (2 7")];
    let (cells, tail) = (&TWO[at("(12 (0")..at("(12 (b")], &TWO[at("(45 (10")..]);
    let mixed = [3, 5, 6, 7, 1, 0, 3, 5, 8, 6, 1, 0, 3, 6, 8, 7, 1, 0];
    for line in ["", "\n", "\r\n"] {
        let broken = |bytes: &[u8]| [line.as_bytes(), bytes].concat();
        let bytes = [
            head.as_bytes(),
            &binary("2010", "2 7 9 1 3", &broken(&single)),
            &binary("3010", "1 5 6 1 3", &broken(&double)),
            cells.as_bytes(),
            &binary("2012", "b 2 2 1 0", &broken(&ints(&[2]))),
            &binary("3040", "0 1 2 2 0", b"(((\"\""),
            &binary("2013", "3 1 1 3 3", &broken(&ints(&[5, 7, 8, 1, 2]))),
            &binary("3013", "4 2 4 a 0", &broken(&ints(&mixed))),
            &binary("3013", "5 5 7 24 3", &broken(&ints(&[5, 9, 7, 0, 2, 5, 9, 8, 2, 0, 8, 9, 7, 2, 0]))),
            tail.as_bytes(),
        ]
        .concat();
        assert_eq!(parse_noted(&bytes).0.unwrap(), parse(TWO), "{line:?}");
        let last_face = bytes.windows(3).rposition(|w| w == b"(45").unwrap() - 200;
        for end in 0..bytes.len() {
            let is_cut = parse_noted(&bytes[..end]).0.is_err();
            assert!(is_cut || end > last_face, "{end}");
        }
    }
}

#[test]
fn cells_with_listed_nodes_are_read_as_meshio_writes_them() {
    let text = "(1 \"meshio\")\n(2 3)\n(10 (0 1 5 0))\n(12 (0 1 2 0))\n(10 (1 1 5 1 3)(\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n))\n\
                (12 (1 0 0 1 2)(\n1 2 3 4\n))\n(12 (1 1 1 1 1)(\n1 2 3\n))\n";
    let mesh = parse(text);
    assert_eq!(mesh.cells.kinds(), [CellKind::TETRA, CellKind::TRIANGLE]);
    assert_eq!(mesh.cells.connectivity().list(1), [0, 1, 2].map(VertexId));
    assert_eq!((mesh.regions().unwrap().ids, mesh.patches().unwrap().ids), (vec![1, 0], vec![0, 1]));
}

#[test]
fn names_and_numbers_that_fluent_lacks_are_reported() {
    let mut mesh = parse(TWO);
    mesh.set_cell_field(Field::scalars("region", vec![-3, 0, 0, 0, 0, 0, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 0, 0, 4, 4, 4, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("q", vec![0.5; 9]));
    mesh.label_names.patches.insert(4, "Inlet (1)".into());
    let (text, lost) = print(&mesh);
    assert_eq!(
        lost,
        [
            "1 surface cells are not written: they are not on the boundary",
            "cell arrays are not written (Fluent has none): q",
            "region -3 is written with number 1",
            "the name \"Inlet (1)\" is written as Inlet__1_",
        ]
    );
    let back = parse(&text);
    assert_eq!(back.regions().unwrap().ids[..2], [1, 2]);
    assert!(
        text.contains("(45 (4 velocity-inlet Inlet__1_)())") && text.contains("(45 (3 wall wall-3)())"),
        "{text}"
    );
    let mut surface = Cells::new();
    surface.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    let surface = Mesh::new(mesh.points, surface);
    let error = FORMAT.to_files(&surface, &Default::default(), &crate::base::Threads::single()).unwrap_err();
    assert!(error.to_string().contains("Fluent needs volume cells, but the mesh has none"), "{error}");
}

#[test]
fn every_beginning_is_a_mesh_or_an_error() {
    let names = TWO.find("(45 (10").unwrap();
    for end in 0..TWO.len() {
        let result = parse_noted(&TWO.as_bytes()[..end]).0;
        assert!(result.is_err() || end >= names - 1, "{end}");
        assert!(result.is_ok() || end != names, "{end}");
    }
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        (
            "(2 3)",
            "(2 2)",
            "line 3: the mesh has two dimensions, which are not supported; open it in ParaView",
        ),
        ("(2 3)", "(2 4)", "line 3: expected dimension 3, found 4"),
        ("(2 3)", "2 3)", "line 3: expected `(`, found `2`"),
        ("7 9 1 3)(", "7 9 1 2)(", "line 6: the points have two dimensions"),
        (
            "7 9 1 3)(",
            "7 ffffff 1 3)(",
            "line 6: 16777209 points declared, but the rest of the file can hold at most",
        ),
        ("7 9 1 3)(", "8 a 1 3)(", "points 7 are expected to follow, found 8"),
        ("-1 0 0.5", "-1 0 x", "line 9: coordinate z: expected a number, found `x`"),
        ("-1 0 0.5", "-1 0", "line 10: expected coordinate z, found `)`"),
        ("(12 (b 2 2", "(12 (b 2 3", "expected type of a cell, found `)`"),
        ("(12 (a 1 1", "(12 (a 1 9", "zones have more than the 2 cells that faces refer to"),
        ("a 0)(\n3 5", "a 0)(\n9 5", "line 24: expected number of points of a face, found `)`"),
        ("a 0)(\n3 5", "a 0)(\n1 5", "line 21: a face has fewer than two points"),
        ("(13 (3 1 1 3 3)", "(13 (3 1 1 3 2)", "faces have two points, as in two dimensions"),
        ("5 7 8 1 2", "5 7 4 1 2", "face 0: refers to point 4, but there are 5 points, numbered from 5"),
        (
            "5 7 8 1 2",
            "5 7 8 1 77",
            "refers to cell 118, but cell numbers must be below the number of faces, 7",
        ),
        ("(13 (0 1 7 0))", "(13 (0 1 9 0))", "9 faces declared, but the file has 7"),
        (
            "(12 (0 1 2 0))",
            "(12 (0 1 7fffffffffffffff 0))",
            "9223372036854775807 cells declared, but the file has 2",
        ),
        ("(45 (10 fluid", "(45 (xx fluid", "number of a zone: expected a whole number, found `xx`"),
        (
            "(37 ((relax 1) (name \"a (\")))",
            "(59 (1 2 3 4)(",
            "line 4: the mesh was refined and has hanging nodes",
        ),
        ("(37 ((relax", "(37 (((relax", "expected `)` at the end of a section, found the end of the file"),
    ];
    refuses(&FORMAT, "in.cas", TWO, &damages);
}

#[test]
fn changed_bytes_are_survived() {
    survives_changed_bytes(&FORMAT, "in.cas", TWO.as_bytes(), b"()0fx \"\\\xff");
}
