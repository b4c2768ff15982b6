use super::*;
use crate::base::{Result, VertexId};
use crate::io::in_memory::{parsed, printed_text, refuses};
use crate::mesh::{CellKind, Cells, Field, Mesh};

fn parse_noted(text: &str) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.bdf", text.as_bytes())
}

fn parse(text: &str) -> Mesh {
    parse_noted(text).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// Two tets, a triangle and a rod in fields of all kinds, with gaps in the numbering.
const TWO: &str = "\
SOL 101
CEND
GRID,1,,9.,9.,9.
BEGIN BULK
$ANSA_NAME_COMMENT;4;PSOLID;the blood;;NO;
$HMNAME PROP                   9\"lid\"
$ Femap Property 12 : nobody
GRID         100              0.     0.0       0       0
GRID,7,,1.5,,$ free
grid*                 20                              0.              1.
$ between
*                     0.
GRID*,8,,0.0,-0.0,*
*,1.-0
GRID\t9\t\t1.\t1.0D+0\t1.5-3
CTETRA         5       4     100       7      20       8
CTETRA*,6,5,7,20,+A
*A,8,9
CTRIA3        30       9       7      20       9     .25
CROD,31,3,7,20
MAT1,1,2.1E11,,.3
FORCE          1       8             1.0
PSOLID,4,1
ENDDATA
GRID,1,,9.,9.,9.
";

#[test]
fn points_elements_and_names_are_read() {
    // All fields in one line, and continued without a mark.
    let [wide, bare] = ["8,9", "\n*,8,9"].map(|rest| TWO.replace("+A\n*A,8,9", rest));
    for text in [TWO, &wide, &bare, &TWO.replace('\n', "\r\n")] {
        let (mesh, notes) = parse_noted(text);
        let mesh = mesh.unwrap();
        assert_eq!(mesh.cells.kinds(), [10, 10, 5, 3].map(CellKind));
        let points = [[0.0; 3], [1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.5e-3]];
        assert_eq!(mesh.points, points);
        assert_eq!(mesh.cells.connectivity().list(1), [1, 2, 3, 4].map(VertexId));
        assert_eq!(mesh.cell_field("nastran:ref").unwrap().values, vec![4, 5, 9, 3].into());
        assert_eq!(mesh.regions().unwrap().name(4), "the blood");
        assert_eq!(mesh.patches().unwrap().name(9), "lid");
        assert_eq!((mesh.label_names.regions.len(), mesh.label_names.patches.len()), (1, 1));
        assert_eq!(notes, ["other cards are skipped: FORCE, MAT1"]);
    }
}

#[test]
fn what_is_read_comes_back() {
    let mesh = parse(TWO);
    let (text, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    assert_eq!(parse(&text), mesh);
    // Without the parts around the bulk data, too.
    let bare = text.replace("SOL 101\nCEND\nBEGIN BULK\n", "").replace("ENDDATA\n", "");
    assert_eq!(parse(&bare), mesh);
}

#[test]
fn middle_nodes_are_in_the_order_of_vtk() {
    let kinds = [
        CellKind::QUADRATIC_TETRA,
        CellKind::QUADRATIC_HEXAHEDRON,
        CellKind::QUADRATIC_WEDGE,
        CellKind::QUADRATIC_PYRAMID,
        CellKind::QUADRATIC_TRIANGLE,
        CellKind::QUADRATIC_QUAD,
    ];
    for kind in kinds {
        let n = kind.n_vertices().unwrap() as u32;
        let mut mesh = Mesh::new(
            vec![[0.5; 3]; n as usize],
            Cells::uniform(kind, (0..n).map(VertexId).collect()).unwrap(),
        );
        mesh.set_cell_field(Field::scalars(REF, vec![2]));
        assert_eq!(parse(&print(&mesh).0), mesh);
    }
    let mut mesh =
        Mesh::new(vec![[0.5; 3]; 20], Cells::uniform(kinds[1], (0..20).map(VertexId).collect()).unwrap());
    mesh.set_cell_field(Field::scalars(REF, vec![2]));
    let text = print(&mesh).0;
    // After the bottom the nodes between bottom and top.
    let line = "+              7       8       9      10      11      12      17      18+\n";
    assert!(text.contains(line), "{text}");
}

#[test]
fn each_label_gets_a_property_of_its_own() {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 3].map(VertexId));
    cells.push(CellKind::POLYGON, [0, 1, 2, 3, 0].map(VertexId));
    let mut mesh = Mesh::new(vec![[0.1, -0.0, 1.0 / 3.0]; 4], cells);
    mesh.set_cell_field(Field::scalars("region", vec![1, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 1, 0, 0]));
    mesh.set_cell_field(Field::scalars("q", vec![0.5; 4]));
    mesh.set_point_field(Field::scalars("p", vec![0.5; 4]));
    mesh.label_names.regions.insert(1, "blood".into());
    mesh.label_names.patches.insert(1, "wall".into());
    let (text, lost) = print(&mesh);
    for expected in [
        "polygon",
        "patch 1 is written with property 3",
        "surface cells without a patch are written with property 2",
        "4 coordinates are rounded to the 16 characters of a field",
        "cell arrays are not written (Nastran has none): q",
        "point arrays",
    ] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
    let back = parse(&text);
    assert_eq!(back.cell_field(REF).unwrap().values, vec![1, 3, 2].into());
    assert_eq!(
        (back.regions().unwrap().name(1), back.patches().unwrap().name(3)),
        ("blood".into(), "wall".into())
    );
    assert_eq!(back.points[0][1].to_bits(), (-0.0f64).to_bits());
    assert!((back.points[0][2] - 1.0 / 3.0).abs() < 1e-15);
}

#[test]
fn large_numbers_are_written_in_wide_fields() {
    let mut mesh = parse(TWO);
    mesh.set_cell_field(Field::scalars(REF, vec![4, 5, 9, 123_456_789]));
    let (text, lost) = print(&mesh);
    assert!(text.contains("CROD*   ") && lost.is_empty(), "{lost:?}");
    assert_eq!(parse(&text), mesh);
}

#[test]
fn coordinate_systems_other_than_the_basic_one_are_refused() {
    let other = TWO.replace("GRID,7,,", "GRID,7,3,");
    let (mesh, notes) = parse_noted(&other);
    assert_eq!(mesh.unwrap(), parse(TWO));
    assert_eq!(notes[0], "coordinate system 3 is not defined: the basic one is used");
    let error = parse_noted(&other.replace("MAT1,1,2", "CORD2C,3,2")).0.unwrap_err().to_string();
    assert!(error.contains("points are in coordinate system 3; write them in the basic"), "{error}");
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        ("GRID,7,,1.5", "GRID,7,,1.5.5", "line 9: GRID: coordinate: expected a number, found `1.5.5`"),
        ("GRID,7,,", "GRID,7,x,", "coordinate system: expected a whole number, found `x`"),
        ("GRID,7,,", "GRID,-7,,", "the number of the point is negative: -7"),
        ("GRID,7,,", "GRID,100,,", "point 100 occurs twice"),
        ("CTETRA*,6,5,7", "CTETRA*,6,5,", "CTETRA: element 6 needs 4 nodes, or 10, but has 3"),
        ("*A,8,9", "*A,8,9,7", "line 17: CTETRA: element 6 needs 4 nodes, or 10, but has 5"),
        ("*A,8,9", "+A,8,77", "element 6 refers to node 77, which does not exist"),
        ("CTETRA*,6,5", "CTETRA*,6,5000000000", "property 5000000000 needs more than 32 bits"),
        ("CTETRA*,6,", "CTETRA*,,", "the number of the element is missing"),
        ("BEGIN BULK", "BEGIN BULK\nENDDATA", "there are no points (GRID)"),
    ];
    refuses(&FORMAT, "in.bdf", TWO, &damages);
}
