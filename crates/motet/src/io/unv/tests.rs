use super::*;
use crate::base::{Result, VertexId};
use crate::io::in_memory::{parsed, printed_text, refuses};
use crate::mesh::{CellKind, Cells, Field, Mesh};

fn parse_noted(text: &str) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.unv", text.as_bytes())
}

fn parse(text: &str) -> Mesh {
    parse_noted(text).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// Two tets, a triangle, two beams and a point mass, with gaps in the numbering.
const TWO: &str = "\
    -1
   151
-1 is no end here
    -1
    -1
   164
         2BG: Foot (pound f)  2
    3.2808399000000000D+00    2.2480894000000000D-01    1.8000000000000000D+00
    4.5967000000000000D+02
    -1
    -1
  2411
       100         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         7         1         1        11
   1.5000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
        20         1         1        11
   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00
         8         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   1.0000000000000000D+00
         9         1         1        11
   1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D-03
    -1
    -1
  2412
         5       111         1         1         7         4
       100         7        20         8
         6       111         2         1         7         4
         7        20         8         9
        30        41         1         1         7         3
         7        20         9
        31        21         1         1         7         2
         0         1         1
         7        20
        32        11         1         1         7         2
        20         9
        33       161         1         1         7         1
         9
    -1
    -1
  2467
         4         0         0         0         0         0         0         1
left half
         8         5         0         0
         9         0         0         0         0         0         0         1
right
         8         6         0         0
         2         0         0         0         0         0         0         2
lid and beam
         8        30         0         0         8        31         0         0
         3         0         0         0         0         0         0         3
ends
         7       100         0         0         7         9         0         0
         7       999         0         0
    -1
    -1
  2414
    1.0
    -1
";

#[test]
fn nodes_elements_and_groups_are_read() {
    let (mesh, notes) = parse_noted(TWO);
    let mesh = mesh.unwrap();
    assert_eq!(mesh.cells.kinds(), [10, 10, 5, 3, 3].map(CellKind));
    assert_eq!(mesh.points[1], [1.5, 0.0, 0.0]);
    assert_eq!(mesh.cells.connectivity().list(4), [2, 4].map(VertexId));
    let (regions, patches) = (mesh.regions().unwrap(), mesh.patches().unwrap());
    assert_eq!(regions.ids, [4, 9, 0, 0, 0]);
    assert_eq!((regions.name(4), regions.name(9)), ("left half".into(), "right".into()));
    assert_eq!((patches.ids[2], patches.name(2)), (2, "lid and beam".into()));
    assert_eq!(mesh.cell_field("elset:lid and beam").unwrap().values, vec![0u8, 0, 1, 1, 0].into());
    assert_eq!(mesh.point_field("nset:ends").unwrap().values, vec![1u8, 0, 0, 0, 1].into());
    assert_eq!(
        notes,
        [
            "coordinates are in the unit of the file (BG: Foot (pound f)), of which 3.2808399 are a metre",
            "elements of type 161 are skipped",
            "dataset `2414` is skipped",
        ]
    );
}

#[test]
fn what_is_read_comes_back() {
    let mesh = parse(TWO);
    let (text, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    assert_eq!(parse(&text), mesh);
}

#[test]
fn without_groups_properties_are_labels() {
    let bare = format!("{}{}", &TWO[..TWO.find("  2467").unwrap()], "  2414\n    -1\n");
    let mesh = parse(&bare);
    assert_eq!(mesh.regions().unwrap().ids, [1, 2, 0, 0, 0]);
    assert!(mesh.patches().is_none());
}

#[test]
fn a_region_and_a_patch_with_one_number_get_two() {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::PYRAMID, [0, 1, 2, 3, 0].map(VertexId));
    let mut mesh = Mesh::new(vec![[0.1, -0.0, 5e-324]; 4], cells);
    mesh.set_cell_field(Field::scalars("region", vec![1, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 1, 0]));
    mesh.set_point_field(Field::scalars("p", vec![0.5; 4]));
    mesh.label_names.regions.insert(1, "blood".into());
    mesh.label_names.patches.insert(1, "wall".into());
    let (text, lost) = print(&mesh);
    for expected in ["pyramid", "the label wall is written with number 2", "point arrays"] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
    let back = parse(&text);
    assert_eq!(
        back.points.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
        mesh.points.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>()
    );
    assert_eq!(
        (back.regions().unwrap().name(1), back.patches().unwrap().name(2)),
        ("blood".into(), "wall".into())
    );
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        ("-1\n   151", "1\n   151", "line 1: the start of a dataset: expected `-1`, found `1`; check"),
        ("0000D+00\n         7 ", "0000X+00\n         7 ", "line 14: coordinate z: expected a number"),
        (
            "       111         2",
            "       111       2.5",
            "physical property: expected a whole number, found `2.5`",
        ),
        ("7         4\n       100", "7        -4\n       100", "expected at most 64 nodes, found -4"),
        (
            "7         4\n       100",
            "7         5\n       100",
            "elements of type 111 with 5 nodes are not supported",
        ),
        ("       100         7", "       100        -7", "node of an element is negative: -7"),
        ("       100         7", "       100        77", "element 5 refers to node 77, which does not exist"),
        ("         6       111", "         5       111", "element 5 occurs twice"),
        ("  2411", "  2410", "there are no nodes (dataset 2411)"),
        ("0         1\nleft", "0   5000000\nleft", "5000000 members of a group declared, but the rest of"),
        (
            "    1.0\n    -1\n",
            "    1.0\n",
            "expected `-1` at the end of the dataset, found the end of the file",
        ),
    ];
    refuses(&FORMAT, "in.unv", TWO, &damages);
}
