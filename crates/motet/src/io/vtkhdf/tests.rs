//! Round trips, steps, parts, and damaged or invalid files.

use crate::base::{Csr, Result, Threads, VertexId};
use crate::io::format::{Compression, Notes, WriteOptions};
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::in_memory::{parsed, printed};
use crate::io::vtkhdf::{FORMAT, StepPath, is_transient, read_step, times};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

fn parse(bytes: &[u8]) -> Result<(Mesh, Vec<String>)> {
    let (mesh, notes) = parsed(&FORMAT, "a.vtkhdf", bytes);
    Ok((mesh?, notes))
}

fn refused(bytes: &[u8]) -> String {
    parse(bytes).unwrap_err().to_string()
}

fn print(mesh: &Mesh, compression: Compression) -> (Vec<u8>, Vec<String>) {
    printed(&FORMAT, mesh, &WriteOptions { compression, ..WriteOptions::default() })
}

fn ids(ids: &[u32]) -> Vec<VertexId> {
    ids.iter().map(|&v| VertexId(v)).collect()
}

/// A tet, a triangle, and a tet stored as a polyhedron; arrays of several types.
fn grid() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, ids(&[0, 1, 2, 3]));
    cells.push(CellKind::TRIANGLE, ids(&[0, 1, 2]));
    let mut faces = Csr::default();
    [[1, 2, 3], [1, 4, 2], [2, 4, 3], [3, 4, 1]].iter().for_each(|face| faces.push(ids(face)));
    cells.push_polyhedron(ids(&[1, 2, 3, 4]), faces);
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, -0.0]];
    let mut mesh = Mesh::new(points, cells);
    mesh.point_data = vec![
        Field {
            name: "a".into(),
            components: 3,
            values: Values::F64((0..15).map(|i| 0.1 * f64::from(i)).collect()),
        },
        Field::scalars("b", vec![f32::NAN, f32::INFINITY, -0.0, 1.0, 2.0]),
        Field::scalars("c", vec![u64::MAX, 0, 1, 2, 3]),
    ];
    mesh.cell_data = vec![
        Field::scalars("i16", vec![i16::MIN, 0, 1]),
        Field::scalars("i8", vec![-1i8, 0, 1]),
        Field::scalars("patch", vec![0i32, 4, 0]),
        Field::scalars("region", vec![7i32, 0, 8]),
        Field::scalars("u16", vec![u16::MAX, 0, 1]),
    ];
    mesh.field_data = vec![
        Field { name: "m".into(), components: 2, values: Values::I64(vec![1, 2, 3, 4]) },
        Field::scalars("title", Values::Text(vec!["täst".into(), String::new()])),
    ];
    mesh.label_names.regions.insert(7, "outer wall".into());
    mesh.label_names.patches.insert(4, "inlet".into());
    mesh
}

/// Compares meshes by their text, since NaN does not compare equal to itself.
fn same(a: &Mesh, b: &Mesh) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

#[test]
fn meshes_round_trip_bit_for_bit() {
    for compression in [Compression::None, Compression::Zlib] {
        let (bytes, lost) = print(&grid(), compression);
        assert_eq!(lost, [""; 0]);
        let (back, notes) = parse(&bytes).unwrap();
        assert!(same(&back, &grid()), "{back:?}");
        assert_eq!(notes, [""; 0]);
        assert_eq!(print(&back, compression).0, bytes);
    }
    let empty = Mesh::default();
    assert_eq!(parse(&print(&empty, Compression::Zlib).0).unwrap().0, empty);
}

#[test]
fn surfaces_are_polygonal_data_where_nothing_is_lost() {
    let mut cells = Cells::new();
    cells.push(CellKind::VERTEX, ids(&[1]));
    cells.push(CellKind::LINE, ids(&[0, 1]));
    cells.push(CellKind::QUAD, ids(&[0, 1, 2, 3]));
    cells.push(CellKind::TRIANGLE, ids(&[0, 1, 2]));
    let mut mesh = Mesh::new(grid().points, cells);
    mesh.cell_data = vec![Field::scalars("n", vec![1i32, 2, 3, 4])];
    let (bytes, lost) = print(&mesh, Compression::Zlib);
    assert!(bytes.windows(8).any(|w| w == b"PolyData") && lost.is_empty());
    assert_eq!(parse(&bytes).unwrap().0, mesh);
    // In polygonal data the line would precede the other cells.
    mesh.cells.push(CellKind::LINE, ids(&[2, 3]));
    mesh.cell_data.clear();
    let (bytes, _) = print(&mesh, Compression::Zlib);
    assert!(!bytes.windows(8).any(|w| w == b"PolyData"));
    assert_eq!(parse(&bytes).unwrap().0, mesh);
}

#[test]
fn names_that_hdf5_cannot_hold_are_reported() {
    let mut mesh = grid();
    mesh.point_data = ["a/b", "a.b", "", "a_b"].map(|name| Field::scalars(name, vec![1u8; 5])).to_vec();
    let (bytes, lost) = print(&mesh, Compression::Zlib);
    assert_eq!(lost.len(), 4, "{lost:?}");
    assert!(lost[0].contains("`a/b`") && lost[0].contains("`a_b`"), "{lost:?}");
    let names: Vec<_> = parse(&bytes).unwrap().0.point_data.into_iter().map(|f| f.name).collect();
    assert_eq!(names, ["a_b", "a_b_2", "a_b_3", "unnamed"]);
    let lz4 = WriteOptions { compression: Compression::Lz4, ..WriteOptions::default() };
    assert!(FORMAT.to_files(&mesh, &lz4, &Threads::single()).unwrap_err().remedy_text().is_some());
}

#[test]
fn truncated_files_are_refused() {
    let (bytes, _) = print(&grid(), Compression::Zlib);
    for n in 0..bytes.len() {
        let error = parse(&bytes[..n]).expect_err("a truncated file");
        assert!(error.remedy_text().is_some(), "{error}");
    }
}

#[test]
fn flipped_bits_never_panic() {
    for compression in [Compression::None, Compression::Zlib] {
        let (bytes, _) = print(&grid(), compression);
        for i in 0..bytes.len() {
            let mut bad = bytes.clone();
            bad[i] ^= 1 << (i % 8);
            if let Ok((mesh, _)) = parse(&bad) {
                mesh.validate().unwrap();
            }
        }
    }
}

/// A file with one tet, after `change` of its arrays.
fn one_tet(change: impl FnOnce(&mut Vec<(&str, Vec<i64>)>)) -> Vec<u8> {
    let mut arrays = vec![
        ("NumberOfPoints", vec![4]),
        ("NumberOfCells", vec![1]),
        ("NumberOfConnectivityIds", vec![4]),
        ("Types", vec![10]),
        ("Offsets", vec![0, 4]),
        ("Connectivity", vec![0, 1, 2, 3]),
    ];
    change(&mut arrays);
    let mut root = Node::new("VTKHDF");
    root.attribute("Version", Attribute::Ints(vec![2, 0]));
    root.attribute("Type", Attribute::Text("UnstructuredGrid".into()));
    root.array("Points", Values::F64(vec![0.5; 12]), &[4, 3], Storage::Plain);
    for (name, values) in arrays {
        let n = values.len();
        root.array(name, Values::I64(values), &[n], Storage::Plain);
    }
    let mut file = Node::new("");
    file.group(root);
    file.into_file().unwrap()
}

#[test]
fn inconsistent_arrays_are_reported_with_their_place() {
    assert_eq!(parse(&one_tet(|_| ())).unwrap().0.cells.counts(), [(CellKind::TETRA, 1)]);
    let with = |name: &'static str, values: &[i64]| {
        refused(&one_tet(|arrays| {
            arrays.iter_mut().filter(|a| a.0 == name).for_each(|a| a.1 = values.to_vec())
        }))
    };
    for (name, values, expected) in [
        ("NumberOfPoints", &[-1][..], "/VTKHDF/NumberOfPoints: -1 is not a valid number"),
        ("NumberOfPoints", &[5], "/VTKHDF/Points: rows 0 to 5 requested, but there are 4"),
        ("NumberOfPoints", &[i64::MAX], "more than a mesh can hold"),
        ("NumberOfPoints", &[i64::MAX, i64::MAX], "more than a mesh can hold"),
        ("NumberOfPoints", &[3], "/VTKHDF/Connectivity: id 3 is out of range: there are 3"),
        ("NumberOfCells", &[2], "/VTKHDF/Offsets: rows 0 to 3"),
        ("NumberOfCells", &[i64::MAX], "/VTKHDF/Offsets: rows 0 to"),
        ("NumberOfCells", &[], "/VTKHDF/NumberOfCells: rows 0 to 1"),
        ("NumberOfConnectivityIds", &[5], "the offsets do not ascend from 0 to 5, the number of ids"),
        ("Offsets", &[0, 3], "the offsets do not ascend from 0 to 4, the number of ids"),
        ("Offsets", &[4, 0], "the offsets do not ascend"),
        ("Offsets", &[-4, 4], "the offsets do not ascend"),
        ("Connectivity", &[0, 1, 2, -1], "/VTKHDF/Connectivity: id -1 is out of range"),
        ("Connectivity", &[0, 1, 2], "/VTKHDF/Connectivity: rows 0 to 4"),
        ("Types", &[300], "/VTKHDF/Types: a cell type is not between 0 and 255"),
        ("Types", &[12], "a hexahedron has 8 vertices"),
        ("Types", &[42], "/VTKHDF: the array NumberOfFaces is missing"),
    ] {
        let error = with(name, values);
        assert!(error.contains(expected), "{name} {values:?}: {error}");
    }
    let missing = refused(&one_tet(|arrays| arrays.retain(|a| a.0 != "Types")));
    assert!(missing.contains("/VTKHDF: the array Types is missing"), "{missing}");
    assert!(refused(b"hello, this is text").contains("not an HDF5 file"));
    assert!(refused(&Node::new("").into_file().unwrap()).contains("without a group VTKHDF"));
}

/// Three steps of a moving tet, whose topology is stored once.
fn transient(parts: &[i64]) -> Vec<u8> {
    let mut root = Node::new("VTKHDF");
    root.attribute("Version", Attribute::Ints(vec![2, 0]));
    root.attribute("Type", Attribute::Text("UnstructuredGrid".into()));
    let points: Vec<f64> = (0..36).map(f64::from).collect();
    root.array("Points", Values::F64(points), &[12, 3], Storage::Zlib);
    let mut int = |name: &str, values: &[i64]| {
        root.array(name, Values::I64(values.to_vec()), &[values.len()], Storage::Plain);
    };
    int("NumberOfPoints", &[4]);
    int("NumberOfCells", &[1]);
    int("NumberOfConnectivityIds", &[4]);
    int("Types", &[10]);
    int("Offsets", &[0, 4]);
    int("Connectivity", &[0, 1, 2, 3]);
    let mut data = Node::new("PointData");
    data.array("u", Values::I32((0..12).collect()), &[12], Storage::Zlib);
    root.group(data);
    let mut steps = Node::new("Steps");
    steps.attribute("NSteps", Attribute::Ints(vec![3]));
    steps.array("Values", Values::F64(vec![0.0, 0.5, 2.0]), &[3], Storage::Plain);
    let mut int = |name: &str, values: &[i64]| {
        steps.array(name, Values::I64(values.to_vec()), &[values.len()], Storage::Plain);
    };
    int("PartOffsets", parts);
    int("NumberOfParts", &[1, 1, 1]);
    int("PointOffsets", &[0, 4, 8]);
    int("CellOffsets", &[0, 0, 0]);
    int("ConnectivityIdOffsets", &[0, 0, 0]);
    root.group(steps);
    let mut file = Node::new("");
    file.group(root);
    file.into_file().unwrap()
}

#[test]
fn steps_are_read_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flow.vtkhdf");
    std::fs::write(&path, transient(&[0, 0, 0])).unwrap();
    assert!(is_transient(&path) && !is_transient(folder.path()));
    let frames = times(&path).unwrap();
    assert_eq!(frames.iter().map(|f| f.0).collect::<Vec<_>>(), [0.0, 0.5, 2.0]);
    for (k, (_, frame)) in frames.iter().enumerate() {
        let mesh = read_step(&StepPath::of(frame).unwrap(), &Notes::default()).unwrap();
        assert_eq!(mesh.points[0], [0, 1, 2].map(|i| (12 * k + i) as f64));
        assert_eq!(
            mesh.point_field("u").unwrap().values,
            Values::I32((0..4).map(|i| i + 4 * k as i32).collect())
        );
        assert_eq!(mesh.cells.counts(), [(CellKind::TETRA, 1)]);
    }
    let beyond = StepPath { file: path, step: 3 };
    assert!(read_step(&beyond, &Notes::default()).unwrap_err().to_string().contains("there is no step 3"));
    let (first, notes) = parse(&transient(&[0, 0, 0])).unwrap();
    assert_eq!(first.points[0], [0.0, 1.0, 2.0]);
    assert!(notes[0].contains("3 steps"), "{notes:?}");
    let error = refused(&transient(&[1, 0, 0]));
    assert!(error.contains("step 0 refers to 1 parts from part 1, but there are 1"), "{error}");
    assert!(refused(&transient(&[-1, 0, 0])).contains("-1 is not a valid number"));
    assert!(refused(&transient(&[])).contains("rows 0 to 1 requested"));
}
