use std::fs;
use std::path::Path;

use super::*;
use crate::base::VertexId;
use crate::io::{WriteOptions, read, read_noted, write};
use crate::mesh::{Cells, Field, Mesh, Values, shapes};

fn put(folder: &Path, files: &[(&str, &str)]) {
    files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
}

const POINTS: &str = "7\n0 0 0\n1000.5 0 0\n0 1000 0\n0 0 1000\n1 1 1\n2 2 2\n3 3 3\n";
const ELEMENTS: &str = "3\nTt 0 1 2 3 4\nTr 0 2 1 -7\nCx 5 6\n";

#[test]
fn each_name_reads_all_files() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), &[("a.pts", POINTS), ("a.elem", ELEMENTS)]);
    put(folder.path(), &[("a.lon", "2\n1 0 0 0 1 0\n\n0 1 0 0 0 1\n0 0 1 0.5 0 0\n")]);
    let mesh = read(folder.path().join("a.pts")).unwrap();
    assert_eq!(mesh.points[1], [1000.5, 0.0, 0.0]);
    assert_eq!(mesh.cells.kinds(), [CellKind::TETRA, CellKind::TRIANGLE, CellKind::LINE]);
    assert_eq!(mesh.regions().unwrap().ids, [4, 0, 0]);
    assert_eq!(mesh.patches().unwrap().ids, [0, -7, 0]);
    assert_eq!(mesh.cell_field("fiber").unwrap().to_vectors().unwrap()[2], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.cell_field("sheet").unwrap().to_vectors().unwrap()[2], [0.5, 0.0, 0.0]);
    for name in ["a.elem", "a.lon"] {
        assert_eq!(read(folder.path().join(name)).unwrap(), mesh);
    }
    fs::remove_file(folder.path().join("a.elem")).unwrap();
    let (bare, notes) = read_noted(folder.path().join("a.pts")).unwrap();
    assert!(bare.cells.is_empty() && bare.points == mesh.points);
    assert_eq!(notes, ["there is no .elem file of the same name: only points are read"]);
}

#[test]
fn directions_may_come_without_their_number() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), &[("a.pts", POINTS), ("a.elem", ELEMENTS), ("a.lon", "1 0 0\n0 1 0\n0 0 1")]);
    let mesh = read(folder.path().join("a.elem")).unwrap();
    assert_eq!(
        mesh.cell_field("fiber").unwrap().values,
        vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0].into()
    );
    assert!(mesh.cell_field("sheet").is_none());
}

#[test]
fn what_is_written_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.pts");
    let mut mesh = shapes::mixed(2);
    mesh.cell_data.clear();
    mesh.label_names = Default::default();
    let n = mesh.cells.len();
    mesh.set_cell_field(Field::scalars(TAG, (0..n as i32).collect::<Vec<_>>()));
    let vectors: Vec<[f64; 3]> = (0..n).map(|i| [0.1, -0.0, i as f64 / 3.0]).collect();
    mesh.set_cell_field(Field::vectors("fiber", &vectors));
    mesh.point_data.clear();
    let kinds: Vec<CellKind> = mesh.cells.counts().iter().map(|(kind, _)| *kind).collect();
    assert!([CellKind::WEDGE, CellKind::HEXAHEDRON, CellKind::PYRAMID].iter().all(|k| kinds.contains(k)));
    assert_eq!(write(&path, &mesh, &WriteOptions::default()).unwrap(), Vec::<String>::new());
    assert_eq!(read(&path).unwrap(), mesh);
}

/// By the edges of meshtool's elements: node 0 of a hexahedron is joined to 1, 3 and 4, and 5 lies at 3.
#[test]
fn hexahedra_and_prisms_go_round_the_other_way_on_top() {
    let mut cells = Cells::new();
    cells.push(CellKind::HEXAHEDRON, [0, 1, 2, 3, 4, 5, 6, 7].map(VertexId));
    cells.push(CellKind::WEDGE, [0, 1, 2, 3, 4, 5].map(VertexId));
    let mesh = Mesh::new(vec![[0.0; 3]; 8], cells);
    let files =
        FORMAT.to_files(&mesh, &WriteOptions::default(), &crate::base::Threads::single()).unwrap().files;
    assert_eq!(files.len(), 2);
    assert_eq!(String::from_utf8_lossy(&files[1].1), "2\nHx 7 6 5 4 3 0 1 2 0\nPr 0 1 2 3 5 4 0\n");
}

#[test]
fn what_cannot_be_held_is_reported() {
    let mut mesh = shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    mesh.set_cell_field(Field::scalars("sheet", vec![0.5; mesh.cells.len()]));
    mesh.set_point_field(Field::scalars("p", vec![0.5; mesh.points.len()]));
    mesh.field_data.push(Field::scalars("t", Values::F64(vec![1.0])));
    mesh.label_names.patches.insert(1, "wall".into());
    let lost =
        FORMAT.to_files(&mesh, &WriteOptions::default(), &crate::base::Threads::single()).unwrap().lost;
    for expected in ["cell arrays", "sheet", "point arrays", "field arrays", "wall"] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
}

#[test]
fn damage_is_reported_with_its_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let lon = "1\n1 0 0\n0 1 0\n0 0 1\n";
    for (name, text, expected) in [
        (
            "a.pts",
            "8\n0 0 0\n",
            "a.pts: line 1: 8 points declared, but the rest of the file can hold at most",
        ),
        ("a.pts", "1\n0 0 x\n", "a.pts: line 2: coordinate z: expected a number"),
        ("a.elem", "1\nTt 0 1 2\n", "a.elem: line 2: expected vertex of a cell, found the end of the line"),
        (
            "a.elem",
            "1\nTt 0 1 2 7 1\n",
            "a.elem: line 2: a cell refers to vertex 7, but there are 7 vertices",
        ),
        ("a.elem", "1\nTx 0 1 2 7 1\n", "a.elem: line 2: element type: expected Tt, Tr, Ln"),
        ("a.elem", "1\nTr 0 1 2 7 1\n", "a.elem: line 2: element: expected the end of the line, found `1`"),
        ("a.elem", "1\nTr 0 1 2 9999999999\n", "a.elem: line 2: region: expected a whole number of 32 bits"),
        ("a.elem", "99999999\nTr 0 1 2\n", "a.elem: line 1: 99999999 elements declared"),
        ("a.lon", "3\n1 0 0\n", "a.lon: line 1: the number of directions: expected 1 or 2, found `3`"),
        ("a.lon", "1\n1 0 0\n0 1 0\n", "the directions of element 2 of 3 are incomplete; the files do not"),
        ("a.lon", "1\n1 0 0\n0 1\n0 0 1\n", "a.lon: line 3: the directions of element 1 of 3 are incomplete"),
        (
            "a.lon",
            "1\n1 0 0\n0 1 0\n0 0 1 1\n",
            "line 4: directions: expected the end of the line, found `1`",
        ),
        ("a.lon", "1\n1 0 0\n0 1 0\n0 0 1\n0 1 1\n", "there are directions for more than 3 elements"),
    ] {
        put(folder.path(), &[("a.pts", POINTS), ("a.elem", ELEMENTS), ("a.lon", lon), (name, text)]);
        let error = read(folder.path().join("a.elem")).unwrap_err().to_string();
        assert!(error.contains(expected), "{text:?}: {error}");
    }
    for (missing, given) in [("a.pts", "a.lon"), ("a.elem", "a.lon"), ("a.pts", "a.elem")] {
        put(folder.path(), &[("a.pts", POINTS), ("a.elem", ELEMENTS), ("a.lon", lon)]);
        fs::remove_file(folder.path().join(missing)).unwrap();
        let error = read(folder.path().join(given)).unwrap_err().to_string();
        assert!(error.contains(missing) && error.contains("does not exist; put the ."), "{error}");
    }
}
