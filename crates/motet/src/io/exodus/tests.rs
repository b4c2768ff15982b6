use super::*;
use crate::base::{Result, VertexId};
use crate::io::WriteOptions;
use crate::io::in_memory::{parsed, printed};
use crate::mesh::{CellKind, Cells, Field, Mesh, shapes};

fn parse_noted(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.exo", bytes)
}

fn parse(bytes: &[u8]) -> Mesh {
    parse_noted(bytes).0.unwrap()
}

fn print(mesh: &Mesh) -> (Vec<u8>, Vec<String>) {
    printed(&FORMAT, mesh, &WriteOptions::default())
}

/// Two regions of tets and one wedge with facets of two patches, and what goes with them.
fn labelled() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TETRA, [1, 2, 3, 4].map(VertexId));
    cells.push(CellKind::WEDGE, [0, 1, 2, 5, 6, 7].map(VertexId));
    cells.push(CellKind::LINE, [0, 7].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [1, 2, 3].map(VertexId));
    cells.push(CellKind::QUAD, [0, 1, 6, 5].map(VertexId));
    let mut mesh = Mesh::new((0..8).map(|i| [0.1 * f64::from(i), -0.0, 1.0 / 3.0]).collect(), cells);
    mesh.set_cell_field(Field::scalars("region", vec![4, 7, 7, 0, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 0, 0, 0, 3, 3, 9]));
    mesh.label_names.regions.extend([(4, "blood".into()), (7, "clot".into())]);
    mesh.label_names.patches.insert(3, "a wall whose name is longer than thirty-two bytes".into());
    mesh.set_point_field(Field::scalars("p", (0..8).map(|i| f64::from(i) / 3.0).collect::<Vec<_>>()));
    mesh.set_point_field(Field::vectors("u", &[[0.1, -0.0, 2.0]; 8]));
    mesh.set_point_field(Field::scalars("nset:ends", vec![1u8, 0, 0, 0, 0, 0, 0, 1]));
    mesh.set_cell_field(Field::scalars("q", vec![0.5, 1.5, 2.5, 3.5, 0.0, 0.0, 0.0]));
    mesh
}

/// Points, cells by region and patch, labels and arrays in one order.
fn sorted(mut mesh: Mesh) -> Mesh {
    mesh.cell_data.sort_by(|a, b| a.name.cmp(&b.name));
    mesh.point_data.sort_by(|a, b| a.name.cmp(&b.name));
    mesh
}

#[test]
fn blocks_sets_and_variables_come_back() {
    let mesh = labelled();
    let (bytes, lost) = print(&mesh);
    assert_eq!(lost, ["cells without a patch are written as block 2"]);
    let (back, notes) = parse_noted(&bytes);
    let mut back = back.unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    // The line is in a block of its own.
    let line = back.cell_data.iter().position(|f| f.name == "elset:PATCH_2").unwrap();
    assert_eq!(back.cell_data.remove(line).values, vec![0u8, 0, 0, 1, 0, 0, 0].into());
    assert_eq!(sorted(back), sorted(mesh));
    assert!(bytes.starts_with(b"CDF\x02"));
}

#[test]
fn cells_of_each_kind_come_back() {
    let kinds = [
        CellKind::TETRA,
        CellKind::QUADRATIC_TETRA,
        CellKind::HEXAHEDRON,
        CellKind::QUADRATIC_HEXAHEDRON,
        CellKind::TRIQUADRATIC_HEXAHEDRON,
        CellKind::WEDGE,
        CellKind::QUADRATIC_WEDGE,
        CellKind::PYRAMID,
        CellKind::QUADRATIC_PYRAMID,
        CellKind::TRIANGLE,
        CellKind::QUADRATIC_TRIANGLE,
        CellKind::QUAD,
        CellKind::QUADRATIC_QUAD,
        CellKind::BIQUADRATIC_QUAD,
    ];
    for kind in kinds {
        let n = kind.n_vertices().unwrap() as u32;
        let cells = Cells::uniform(kind, (0..n).map(VertexId).collect()).unwrap();
        let mut mesh = Mesh::new((0..n).map(|i| [f64::from(i), 0.0, 0.0]).collect(), cells);
        let array = if kind.dim() == Some(3) { "region" } else { "patch" };
        mesh.set_cell_field(Field::scalars(array, vec![5]));
        let (bytes, lost) = print(&mesh);
        assert_eq!(lost, Vec::<String>::new());
        assert_eq!(parse(&bytes), mesh);
        // Each facet of the cell is one of its sides, and the other way round.
        let sides = kinds::sides(kind);
        let facets = crate::mesh::facets::facet_shapes(kind).unwrap_or_default();
        assert_eq!(sides.len(), if kind.dim() == Some(3) { facets.len() } else { 0 });
        for shape in facets.iter().filter(|_| kind.dim() == Some(3)) {
            let ring = shape.corners();
            let is_side = |side: &&&[u8]| {
                let start = side.iter().position(|c| *c == ring[0]);
                side.len() == ring.len()
                    && start.is_some_and(|start| {
                        (0..ring.len()).all(|i| side[(start + i) % side.len()] == ring[i])
                    })
            };
            assert_eq!(sides.iter().filter(is_side).count(), 1, "{kind:?} {ring:?}");
        }
    }
}

#[test]
fn what_cannot_be_held_is_reported() {
    let mut mesh = shapes::mixed(2);
    let n = mesh.cells.len();
    mesh.set_cell_field(Field::scalars("n", vec![3u8; n]));
    mesh.set_cell_field(Field { name: "t".into(), components: 2, values: vec![0.5; 2 * n].into() });
    mesh.set_point_field(Field::scalars("text", vec![String::from("x"); mesh.points.len()]));
    mesh.field_data.push(Field::scalars("time", vec![0.5]));
    let (bytes, lost) = print(&mesh);
    for expected in [
        "cell arrays are written in double precision: n",
        "cell arrays are written as an array for each column: t",
        "text arrays",
        "field arrays",
    ] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
    let back = parse(&bytes);
    assert_eq!(back.cell_field("t_2").unwrap().values.len(), back.cells.len());
    let mut facets = labelled();
    facets.set_cell_field(Field::scalars("q", vec![1.0; 7]));
    facets
        .cell_data
        .iter_mut()
        .filter(|f| f.name == "patch")
        .for_each(|f| f.values = vec![0, 0, 0, 0, 9, 3, 3].into());
    let (_, lost) = print(&facets);
    for expected in
        ["the order of the cells is not kept", "values on the facets of side sets are not written: q"]
    {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
}

/// The bytes of a file in which one sequence of bytes is replaced by another.
fn replaced(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|w| w == from).unwrap();
    [&bytes[..at], to, &bytes[at + from.len()..]].concat()
}

#[test]
fn damage_is_reported() {
    let (bytes, _) = print(&labelled());
    let int = |values: &[i32]| values.iter().flat_map(|v| v.to_be_bytes()).collect::<Vec<u8>>();
    let changes: [(Vec<u8>, Vec<u8>, &str); 5] = [
        (int(&[1, 2, 3, 4]), int(&[1, 2, 3, 40]), "array connect1: refers to node 40 of 8"),
        (int(&[1, 2, 3, 4]), int(&[1, 2, 3, -4]), "expected numbers of nodes, found -4"),
        (b"coordx\0\0".to_vec(), b"boordx\0\0".to_vec(), "there are no coordinates"),
        (
            int(&[10, 13]),
            int(&[10, 1 << 30]),
            "1073741824 dimensions declared, but the rest can hold at most",
        ),
        (b"CDF\x02".to_vec(), b"CDF\x03".to_vec(), "is not a netCDF file"),
    ];
    for (from, to, expected) in changes {
        let at = bytes.windows(from.len()).any(|w| w == from);
        let from = if at { from } else { int(&[10]) };
        let to = if at { to } else { int(&[11]) };
        let expected = if at { expected } else { "expected the list of dimensions" };
        let error = parse_noted(&replaced(&bytes, &from, &to)).0.unwrap_err().to_string();
        assert!(error.starts_with("in.exo: ") && error.contains(expected), "{expected}: {error}");
    }
    // A file cut anywhere is refused, or its last values are not needed.
    for n in (0..bytes.len()).step_by(7) {
        if let Err(error) = parse_noted(&bytes[..n]).0 {
            assert!(!error.to_string().contains("panicked"), "{error}");
        }
    }
    assert!(
        parse_noted(&bytes[..bytes.len() - 8]).0.is_ok_and(|mesh| mesh != labelled())
            || parse_noted(&bytes[..bytes.len() - 8]).0.is_err()
    );
}

#[test]
fn arrays_over_time_are_read_at_the_last_step() {
    let mut layout = layout::Layout::default();
    layout.dimension("time_step", 1);
    let name = layout.dimension("len_name", 33);
    let n = layout.dimension("num_nodes", 2);
    let one = layout.dimension("num_nod_var", 1);
    for coordinate in ["coordx", "coordy"] {
        layout.numbers(coordinate, &[n], vec![1.0, 2.0].into());
    }
    layout.texts("name_nod_var", [one, name], vec!["p".into()]);
    layout.numbers("time_whole", &[], vec![0.5].into()).is_over_time = true;
    layout.numbers("vals_nod_var1", &[n], vec![3.0, 4.0].into()).is_over_time = true;
    let mut bytes = Vec::new();
    let threads = crate::base::Threads::single();
    encode::encode(&layout, &mut crate::io::Output::to_memory(&mut bytes, &threads)).unwrap();
    let mesh = parse(&bytes);
    assert_eq!(mesh.points, [[1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]);
    assert_eq!(mesh.point_field("p").unwrap().values, vec![3.0, 4.0].into());
    // A second step.
    let mut two = bytes.clone();
    two[4..8].copy_from_slice(&2u32.to_be_bytes());
    two.extend([0.6f64, 5.0, 6.0].iter().flat_map(|x| x.to_be_bytes()));
    let (mesh, notes) = parse_noted(&two);
    assert_eq!(mesh.unwrap().point_field("p").unwrap().values, vec![5.0, 6.0].into());
    assert_eq!(notes, ["of 2 steps over time the last is read"]);
}
