use super::*;
use crate::base::{Result, VertexId};
use crate::io::in_memory::{parsed, printed_text, refuses, survives_changed_bytes};
use crate::mesh::{CellKind, Cells, Field, Mesh};

fn parse_noted(text: &str) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.cdb", text.as_bytes())
}

fn parse(text: &str) -> Mesh {
    parse_noted(text).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// A tet of second order, the four shapes of a brick, a shell, a triangle of second order from a surface
/// element, and a contact element; numbers have gaps.
const MIXED: &str = "\
/COM,ANSYS RELEASE 2024
/PREP7
/NOPR
*SET,tid,3
ETBLOCK,        2,        2
(2i9,19a9)
        1      187        0        0
        2      185        0        0
       -1
ET,tid,154
ET,        4,181
ET,5,174
MPTEMP,R5.0, 1, 1,  0.0,
NBLOCK,6,SOLID,      1009,       14
(3i9,6e21.13e3)
     1001        0        0
     1000        0        0 0.0000000000000E+000 1.0000000000000E+000-2.5000000000000E-001
     1002        0        0 1.0000000000000E+000
     1003        0        0 0.0000000000000E+000 0.0000000000000E+000 1.0000000000000E+000
        1        0        0 5.0000000000000E-001
        2        0        0 5.0000000000000E-001 5.0000000000000E-001
        3        0        0 0.0000000000000E+000 5.0000000000000E-001
        4        0        0
        5        0        0
        6        0        0
       11        0        0
       12        0        0
       13        0        0
       14        0        0
N,R5.3,LOC,       -1,
EBLOCK,19,SOLID,        30,        6
(19i9)
        7        1        1        1        0        0        0        0       10        0       10     1001     1002     1000     1003        1        2        3        4
        5        6
        7        2        1        1        0        0        0        0        8        0       11     1001     1002     1000        1        2        3        4        5
        8        2        1        1        0        0        0        0        8        0       12     1001     1002     1000     1000        2        3        4        4
        8        2        1        1        0        0        0        0        8        0       20     1001     1002     1000        1        2        2        2        2
        8        2        1        1        0        0        0        0        8        0       21     1001     1002     1000     1000        2        2        2        2
        8        4        1        1        0        0        0        0        4        0       30     1001     1002     1000     1000
        8        5        1        1        0        0        0        0        4        0       31     1001     1002     1000     1000
       -1
eblock,10,,,1
(15i9)
       40        3        9        9       12     1001     1002     1000     1000        1        2     1000        3
-1
CMBLOCK,LEFT    ,ELEM,       2  ! users element component definition
(8i10)
        10       -11
CMBLOCK,TOP,ELEMENT,       4
(8i10)
        20       -29        30        40
CMBLOCK,ends    ,NODE,       4
(8i10)
         2        -5      1000      -999
CMBLOCK,nowhere,NODE,1
(8i10)
       999
D,1,UX,0
FINISH
";

#[test]
fn nodes_elements_and_components_are_read() {
    let (mesh, notes) = parse_noted(MIXED);
    let mesh = mesh.unwrap();
    assert_eq!(mesh.cells.kinds(), [24, 12, 13, 14, 10, 5, 22].map(CellKind));
    assert_eq!(mesh.points[1], [0.0, 1.0, -0.25]);
    let list = |cell: usize| mesh.cells.connectivity().list(cell).iter().map(|v| v.0).collect::<Vec<_>>();
    assert_eq!(list(0), [0, 2, 1, 3, 4, 5, 6, 7, 8, 9]);
    assert_eq!((list(2), list(3), list(4)), (vec![0, 2, 1, 5, 6, 7], vec![0, 2, 1, 4, 5], vec![0, 2, 1, 5]));
    assert_eq!((list(5), list(6)), (vec![0, 2, 1], vec![0, 2, 1, 4, 5, 6]));
    let (regions, patches) = (mesh.regions().unwrap(), mesh.patches().unwrap());
    assert_eq!((regions.ids, regions.names.get(&7).unwrap().as_str()), (vec![7, 7, 8, 8, 8, 0, 0], "LEFT"));
    assert_eq!((patches.ids, patches.names.len()), (vec![0, 0, 0, 0, 0, 8, 9], 0));
    assert_eq!(mesh.cell_field("elset:TOP").unwrap().values, vec![0u8, 0, 0, 1, 1, 1, 1].into());
    let ends = vec![0u8, 1, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0];
    assert_eq!(mesh.point_field("nset:ends").unwrap().values, ends.into());
    assert_eq!(
        notes,
        [
            "elements of type 174 are skipped",
            "other commands are skipped: D, MPTE",
            "component nowhere has nonexistent members: 1",
        ]
    );
}

#[test]
fn what_is_read_comes_back() {
    let mesh = parse(MIXED);
    let (text, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    assert_eq!(parse(&text), mesh);
}

#[test]
fn without_several_materials_components_are_labels() {
    let text = MIXED
        .replace("\n        8        2", "\n        7        2")
        .replace("      9       12     1001", "      8       12     1001");
    let mesh = parse(&text);
    let regions = mesh.regions().unwrap();
    assert_eq!(regions.ids, [1, 1, 0, 2, 2, 0, 0]);
    assert_eq!((regions.name(1), regions.name(2)), ("LEFT".into(), "TOP".into()));
    let bare = &text[..text.find("CMBLOCK").unwrap()];
    assert!(parse(bare).regions().is_none());
}

#[test]
fn labels_and_names_that_ansys_lacks_are_reported() {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TETRA, [1, 2, 3, 0].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::BIQUADRATIC_TRIANGLE, [0, 1, 2, 3, 0, 1, 2].map(VertexId));
    let mut mesh =
        Mesh::new(vec![[0.1, -0.0, 5e-324], [f64::MAX, 1e-300, -1.0 / 3.0], [1.0; 3], [2.0; 3]], cells);
    mesh.set_cell_field(Field::scalars("region", vec![-4, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 0, 1, 0]));
    mesh.set_point_field(Field::scalars("p", vec![0.5; 4]));
    mesh.label_names.regions.insert(-4, "blood".into());
    mesh.label_names.patches.insert(1, "7 in let".into());
    let (text, lost) = print(&mesh);
    assert_eq!(
        lost,
        [
            "1 cells of kind triangle7 are not written: an Ansys archive has no such cells",
            "region -4 of volume cells is written as material 1",
            "volume cells without a region are written with material 2",
            "the name \"7 in let\" is written as C7_in_let",
            "point arrays are not written (an Ansys archive has none): p",
        ]
    );
    let back = parse(&text);
    let bits = |mesh: &Mesh| mesh.points.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&back), bits(&mesh));
    assert_eq!(
        (back.regions().unwrap().name(1), back.patches().unwrap().name(1)),
        ("blood".into(), "C7_in_let".into())
    );
}

#[test]
fn surfaces_alone_are_shells() {
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::QUADRATIC_QUAD, [0, 1, 2, 3, 0, 1, 2, 3].map(VertexId));
    let mesh = Mesh::new(vec![[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]], cells);
    let (text, lost) = print(&mesh);
    assert!(lost.is_empty() && text.contains("ET,1,181\nET,2,281\n"), "{text}");
    assert_eq!(parse(&text), mesh);
}

#[test]
fn single_commands_are_refused_with_advice() {
    let error = parse_noted("/PREP7\nN,1,0,0,0\nEN,1,1,2,3,4\n").0.unwrap_err().to_string();
    assert_eq!(
        error,
        "in.cdb: there are no nodes (NBLOCK); write the file with blocks: CDWRITE,DB,file,cdb,,,,BLOCKED"
    );
}

#[test]
fn every_beginning_is_a_mesh_or_an_error() {
    let end_of_elements = MIXED.find("CMBLOCK").unwrap();
    for end in 0..MIXED.len() {
        let result = parse_noted(&MIXED[..end]).0;
        let is_inside = |from: &str, to: &str| {
            let start = MIXED.find(from).unwrap() + from.len();
            (start..start + MIXED[start..].find(to).unwrap()).contains(&end)
        };
        let cut = is_inside("NBLOCK", "N,R5.3")
            || is_inside("EBLOCK", "       -1\neblock")
            || is_inside("eblock", "-1\nCM");
        assert!(!cut || result.is_err(), "{end}");
        assert!(end != end_of_elements || result.is_ok());
    }
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        (
            "(3i9,6e21.13e3)",
            "3i9,6e21.13e3",
            "line 15: expected the format of a block, such as (19i9), found `3i9,",
        ),
        ("(3i9,6e21.13e3)", "(3i9)", "has no columns for a number and three coordinates"),
        (
            "1.0000000000000E+000-2.5",
            "1.0000000000000X+000-2.5",
            "line 17: coordinate: expected a number, found `1.00",
        ),
        ("     1003        0", "    -1003        0", "line 19: the number of the node is negative: -1003"),
        ("     1003        0", "     1002        0", "node 1002 occurs twice"),
        (
            "       10        0       10     1001",
            "       99        0       10     1001",
            "expected at most 64 nodes, found 99",
        ),
        ("        5        6\n", "", "element 10 has 8 nodes of 10"),
        (
            "       12     1001     1002     1000     1000",
            "       12     1001     1002     1000        0",
            "element 12 lacks nodes: it has 7",
        ),
        ("       11     1001", "       11     1234", "element 11 refers to node 1234, which does not exist"),
        ("       11     1001", "       10     1001", "element 10 occurs twice"),
        ("(19i9)", "(9i9)", "a block of elements has 9 columns of at least 12"),
        ("ELEM,       2", "ELEM,        ", "component LEFT: the number of members is missing"),
        ("NODE,       4", "NODE, 4000000", "line 54: component ends has 4 members of 4000000"),
    ];
    refuses(&FORMAT, "in.cdb", MIXED, &damages);
    let cut = MIXED.replace("NODE,1\n", "NODE,9\n");
    let error = parse_noted(&cut[..cut.find("       999\n").unwrap()]).0.unwrap_err().to_string();
    assert!(
        error.contains("expected the 9 members of component nowhere, found the end of the file"),
        "{error}"
    );
}

#[test]
fn changed_bytes_are_survived() {
    survives_changed_bytes(&FORMAT, "in.cdb", MIXED.as_bytes(), b"-90 ,(\n\xff");
}
