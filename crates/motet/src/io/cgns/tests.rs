//! Round trips, variants written by other programs, and damaged or invalid files.

use crate::base::{Csr, Result, VertexId};
use crate::io::WriteOptions;
use crate::io::cgns::FORMAT;
use crate::io::cgns::kinds::ElementType;
use crate::io::cgns::tree::Tree;
use crate::io::in_memory::{parsed, printed};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

fn parse(bytes: &[u8]) -> Result<(Mesh, Vec<String>)> {
    let (mesh, notes) = parsed(&FORMAT, "a.cgns", bytes);
    Ok((mesh?, notes))
}

fn refused(bytes: &[u8]) -> String {
    let error = parse(bytes).unwrap_err();
    assert!(error.remedy_text().is_some(), "{error}");
    error.to_string()
}

fn print(mesh: &Mesh) -> (Vec<u8>, Vec<String>) {
    printed(&FORMAT, mesh, &WriteOptions::default())
}

fn round_trip(mesh: &Mesh) -> Mesh {
    let (bytes, lost) = print(mesh);
    assert_eq!(lost, [""; 0]);
    let (back, notes) = parse(&bytes).unwrap();
    assert_eq!(notes, [""; 0]);
    back
}

fn ids(ids: &[u32]) -> Vec<VertexId> {
    ids.iter().map(|&v| VertexId(v)).collect()
}

fn points(n: usize) -> Vec<[f64; 3]> {
    (0..n).map(|i| [0, 1, 2].map(|axis| (0.1 + i as f64) * 0.7f64.powi(axis))).collect()
}

/// Two regions of several kinds, two patches, an unlabelled surface, a curve and a point.
fn mixed() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, ids(&[0, 1, 2, 3]));
    cells.push(CellKind::HEXAHEDRON, ids(&[0, 1, 2, 3, 4, 5, 6, 7]));
    cells.push(CellKind::WEDGE, ids(&[0, 1, 2, 4, 5, 6]));
    cells.push(CellKind::TETRA, ids(&[1, 2, 3, 7]));
    cells.push(CellKind::TRIANGLE, ids(&[0, 1, 2]));
    cells.push(CellKind::QUAD, ids(&[0, 1, 5, 4]));
    cells.push(CellKind::TRIANGLE, ids(&[1, 2, 3]));
    cells.push(CellKind::TRIANGLE, ids(&[2, 3, 0]));
    cells.push(CellKind::LINE, ids(&[0, 1]));
    cells.push(CellKind::VERTEX, ids(&[3]));
    let mut mesh = Mesh::new(points(8), cells);
    mesh.point_data = vec![
        Field::scalars("p", vec![f32::NAN, f32::INFINITY, -0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
        Field::vectors("v", &points(8)),
    ];
    mesh.cell_data = vec![
        Field::scalars("n", vec![1i64, i64::MIN, i64::MAX, 4, 5, 6, 7, 8, 0, 0]),
        Field::scalars("patch", vec![0i32, 0, 0, 0, 4, 4, 9, 0, 0, 0]),
        Field::scalars("region", vec![7i32, 7, 7, 3, 0, 0, 0, 0, 0, 0]),
    ];
    mesh.label_names.patches.insert(4, "wall".into());
    mesh.label_names.regions.insert(7, "solid".into());
    mesh
}

#[test]
fn mixed_cells_labels_and_arrays_round_trip() {
    let mesh = mixed();
    let mut back = round_trip(&mesh);
    back.cell_data.sort_by(|a, b| a.name.cmp(&b.name));
    let Values::F32(p) = &back.point_data[0].values else { panic!("another type") };
    assert!(p[0].is_nan() && p[2].is_sign_negative());
    back.point_data[0] = mesh.point_data[0].clone();
    // NaN does not compare equal to itself.
    assert_eq!(format!("{back:?}"), format!("{mesh:?}"));
}

#[test]
fn every_kind_round_trips_with_its_node_order() {
    for number in 0..60 {
        let Some(kind) = ElementType::of(number).and_then(|t| t.kind) else { continue };
        let Some(n) = kind.n_vertices() else { continue };
        let mut cells = Cells::new();
        for shift in [0, 1] {
            cells.push(kind, (0..n as u32).map(|v| VertexId(v + shift)));
        }
        let mesh = Mesh::new(points(n + 1), cells);
        assert_eq!(round_trip(&mesh), mesh, "{}", kind.label());
    }
}

/// A polyhedron, a tet that shares a face with it, and a polygon and triangles on their boundary.
fn polyhedral() -> Mesh {
    let mut cells = Cells::new();
    let prism = [&[0u32, 2, 1][..], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
    let mut faces = Csr::default();
    // One edge has a vertex inside it, so that this is not a wedge.
    faces.push(ids(&[0, 2, 1, 6]));
    prism[1..2].iter().chain(&prism[3..]).for_each(|face| faces.push(ids(face)));
    faces.push(ids(&[0, 6, 1, 4, 3]));
    cells.push_polyhedron(ids(&[0, 1, 2, 3, 4, 5, 6]), faces);
    cells.push(CellKind::TETRA, ids(&[3, 4, 5, 7]));
    cells.push(CellKind::POLYGON, ids(&[0, 6, 1, 4, 3]));
    cells.push(CellKind::TRIANGLE, ids(&[3, 4, 5]));
    cells.push(CellKind::TRIANGLE, ids(&[4, 3, 7]));
    let mut points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    points.extend([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.5, -0.5, 0.0], [0.2, 0.2, 2.0]]);
    let mut mesh = Mesh::new(points, cells);
    mesh.cell_data = vec![
        Field::scalars("x", vec![1.5, 2.5, 3.5, 4.5, 5.5]),
        Field::scalars("patch", vec![0i32, 0, 1, 2, 0]),
        Field::scalars("region", vec![1i32, 2, 0, 0, 0]),
    ];
    mesh.label_names.patches.insert(2, "between".into());
    mesh
}

#[test]
fn polyhedra_round_trip_with_their_faces() {
    let mesh = polyhedral();
    let (bytes, lost) = print(&mesh);
    assert!(matches!(&lost[..], [what] if what.contains("order of the cells")), "{lost:?}");
    let back = parse(&bytes).unwrap().0;
    assert_eq!(back.cells.counts().len(), 4);
    let facets = crate::mesh::adjacency::Facets::of(&back.cells);
    for (cell, kind, _) in back.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        let before = crate::mesh::cell_volumes(&mesh.cells, &mesh.points);
        let after = crate::mesh::cell_volume(&facets, cell, &back.points);
        let same = mesh.cells.iter().position(|(_, k, _)| k == kind).unwrap();
        assert!((before[same] - after).abs() < 1e-12 && after > 0.0, "{}: {after}", kind.label());
    }
    assert_eq!(back.points, mesh.points);
    // Polygons come before the cells made of them.
    let patch = back.cell_field("patch").unwrap();
    assert_eq!(patch.values, Values::I32(vec![1, 2, 0, 0, 0]));
    assert_eq!(back.cell_field("region").unwrap().values, Values::I32(vec![0, 0, 0, 1, 2]));
    assert_eq!(back.cell_field("x").unwrap().values, Values::F64(vec![3.5, 4.5, 5.5, 1.5, 2.5]));
    assert_eq!(back.label_names, mesh.label_names);
    assert_eq!(round_trip(&back), back);
}

#[test]
fn surfaces_with_polygons_round_trip() {
    let mut cells = Cells::new();
    cells.push(CellKind::POLYGON, ids(&[0, 1, 2, 3, 4]));
    cells.push(CellKind::TRIANGLE, ids(&[0, 1, 5]));
    cells.push(CellKind::QUAD, ids(&[1, 2, 3, 5]));
    let mut mesh = Mesh::new(points(6), cells);
    mesh.cell_data = vec![Field::scalars("patch", vec![3i32, 3, 5])];
    assert_eq!(round_trip(&mesh), mesh);
}

#[test]
fn points_without_cells_and_empty_meshes_round_trip() {
    assert_eq!(round_trip(&Mesh::default()), Mesh::default());
    let mut mesh = Mesh::new(points(3), Cells::new());
    mesh.point_data = vec![Field::scalars("p", vec![1i32, 2, 3])];
    assert_eq!(round_trip(&mesh), mesh);
}

#[test]
fn losses_are_reported() {
    let mut mesh = mixed();
    let long = "a name that is longer than names may be here";
    mesh.label_names.regions.insert(7, long.into());
    mesh.label_names.patches.insert(9, "wall".into());
    mesh.cells.push(CellKind::POLY_LINE, ids(&[0, 1, 2]));
    let n = mesh.cells.len();
    mesh.cell_data = vec![
        Field { name: "pair".into(), components: 2, values: Values::F64(vec![0.5; 2 * n]) },
        Field::scalars("small", vec![7u8; n]),
        Field::scalars("region", vec![7i32, 7, 7, 7, 0, 0, 0, 0, 0, 0, 0]),
        Field::scalars("patch", vec![0i32, 0, 0, 0, 4, 4, 9, 9, 0, 0, 0]),
    ];
    mesh.field_data = vec![Field::scalars("title", Values::Text(vec!["x".into()]))];
    let (bytes, lost) = print(&mesh);
    for expected in ["poly_line", "pair is written as 2", "array small", "title", long, "wall_2"] {
        assert!(lost.iter().any(|l| l.contains(expected)), "{expected}: {lost:?}");
    }
    let back = parse(&bytes).unwrap().0;
    assert_eq!(back.label_names.regions[&7], long[..32].trim());
    assert_eq!(back.label_names.patches[&9], "wall_2");
    assert_eq!(back.cell_field("small").unwrap().values, Values::I32([&[7; 8][..], &[0; 2]].concat()));
}

#[test]
fn truncated_files_are_refused() {
    let (bytes, _) = print(&mixed());
    for n in (0..bytes.len()).step_by(7) {
        refused(&bytes[..n]);
    }
}

#[test]
fn flipped_bits_never_panic() {
    for mesh in [mixed(), polyhedral()] {
        let (bytes, _) = print(&mesh);
        for i in (0..bytes.len()).step_by(3) {
            let mut bad = bytes.clone();
            bad[i] ^= 1 << (i % 8);
            if let Ok((mesh, _)) = parse(&bad) {
                mesh.validate().unwrap();
            }
        }
    }
}

fn int(name: &str, label: &str, values: &[i32]) -> Tree {
    Tree::with(name, label, Values::I32(values.to_vec()))
}

/// A section of elements.
fn section(name: &str, number: i32, range: [i32; 2], ids: &[i32]) -> Tree {
    let mut section = int(name, "Elements_t", &[number, 0]);
    section.child(int("ElementRange", "IndexRange_t", &range));
    section.child(int("ElementConnectivity", "DataArray_t", ids));
    section
}

/// A zone with five points.
fn zone(name: &str, children: Vec<Tree>) -> Tree {
    let mut zone = int(name, "Zone_t", &[5, 2, 0]);
    zone.child(Tree::with_text("ZoneType", "ZoneType_t", "Unstructured"));
    let mut grid = Tree::new("GridCoordinates", "GridCoordinates_t");
    for axis in ["X", "Y", "Z"] {
        let values = Values::F32(vec![0.0, 1.0, 2.0, 3.0, 4.0]);
        grid.child(Tree::with(&format!("Coordinate{axis}"), "DataArray_t", values));
    }
    zone.child(grid);
    zone.children(children);
    zone
}

fn file(children: Vec<Tree>) -> Vec<u8> {
    let mut base = int("Base", "CGNSBase_t", &[3, 3]);
    base.children(children);
    Tree::file(vec![base]).unwrap()
}

fn condition(name: &str, location: Option<&str>, family: Option<&str>, list: &[i32]) -> Tree {
    let mut condition = Tree::with_text(name, "BC_t", "BCWall");
    condition.child(int("PointList", "IndexArray_t", list));
    condition.children(location.map(|place| Tree::with_text("GridLocation", "GridLocation_t", place)));
    condition.children(family.map(|name| Tree::with_text("FamilyName", "FamilyName_t", name)));
    condition
}

fn conditions(all: Vec<Tree>) -> Tree {
    let mut node = Tree::new("ZoneBC", "ZoneBC_t");
    node.children(all);
    node
}

fn tets() -> Tree {
    section("Tets", 10, [1, 2], &[1, 2, 3, 4, 2, 3, 4, 5])
}

#[test]
fn conditions_refer_to_elements_or_points_and_families_name_them() {
    let mut family = Tree::new("S_1", "Family_t");
    family.child(Tree::with_text("inlet", "FamilyName_t", "inlet"));
    let faces = section("Faces", 5, [3, 6], &[1, 2, 3, 2, 3, 4, 3, 4, 5, 1, 3, 4]);
    let all = conditions(vec![
        condition("S_1", Some("FaceCenter"), Some("S_1"), &[3]),
        condition("a", None, None, &[2, 3, 4]),
        condition("nothing", None, None, &[1, 5]),
    ]);
    let (mesh, notes) = parse(&file(vec![family, zone("Zone", vec![tets(), faces, all])])).unwrap();
    assert_eq!(mesh.cell_field("patch").unwrap().values, Values::I32(vec![0, 0, 1, 2, 0, 0]));
    assert_eq!(mesh.label_names.patches.values().collect::<Vec<_>>(), ["inlet", "a"]);
    assert!(mesh.cell_field("region").is_none());
    assert!(notes.len() == 1 && notes[0].contains("condition nothing is skipped"), "{notes:?}");
}

#[test]
fn sections_and_zones_are_labels_by_default() {
    let side = |name| section(name, 5, [3, 3], &[1, 2, 3]);
    let (mesh, _) =
        parse(&file(vec![zone("left", vec![tets(), side("in")]), zone("right", vec![tets(), side("out")])]))
            .unwrap();
    assert_eq!(mesh.points.len(), 10);
    assert_eq!(mesh.cells.connectivity().list(3), ids(&[5, 6, 7, 8]));
    assert_eq!(mesh.cell_field("region").unwrap().values, Values::I32(vec![1, 1, 0, 2, 2, 0]));
    assert_eq!(mesh.label_names.regions.values().collect::<Vec<_>>(), ["left", "right"]);
    assert_eq!(mesh.label_names.patches.values().collect::<Vec<_>>(), ["in", "out"]);
    let one = |name, i: i32| section(name, 10, [i, i], &[1, 2, 3, 4]);
    let (mesh, _) = parse(&file(vec![zone("Zone", vec![one("b", 1), one("a", 2)])])).unwrap();
    assert_eq!(mesh.label_names.regions.values().collect::<Vec<_>>(), ["b", "a"]);
    // Sections by kind carry no information about regions.
    let pyramid = section("Pyramids", 12, [3, 3], &[1, 2, 3, 4, 5]);
    let (mesh, _) = parse(&file(vec![zone("Zone", vec![tets(), pyramid])])).unwrap();
    assert!(mesh.cell_field("region").is_none() && mesh.label_names.regions.is_empty());
}

#[test]
fn points_where_zones_meet_are_merged_if_they_coincide() {
    let seam = |other: &str, own: &[i32], theirs: &[i32]| {
        let mut seam = Tree::with_text("Seam", "GridConnectivity_t", other);
        seam.child(Tree::with_text("GridConnectivityType", "GridConnectivityType_t", "Abutting1to1"));
        seam.child(int("PointList", "IndexArray_t", own));
        seam.child(int("PointListDonor", "IndexArray_t", theirs));
        let mut all = Tree::new("ZoneGridConnectivity", "ZoneGridConnectivity_t");
        all.child(seam);
        all
    };
    let two = |own: &[i32], theirs: &[i32]| {
        let left = zone("left", vec![tets(), seam("right", own, theirs)]);
        parse(&file(vec![left, zone("right", vec![tets(), seam("left", theirs, own)])])).unwrap()
    };
    let (mesh, notes) = two(&[4, 5], &[4, 5]);
    assert_eq!((mesh.points.len(), notes.len()), (8, 0));
    assert_eq!(mesh.cells.connectivity().list(2), ids(&[5, 6, 7, 3]));
    assert_eq!(mesh.cells.connectivity().list(3), ids(&[6, 7, 3, 4]));
    for (own, theirs) in [(&[4, 5][..], &[5, 4][..]), (&[4], &[4, 5])] {
        let (mesh, notes) = two(own, theirs);
        assert_eq!(mesh.points.len(), 10);
        assert!(notes[0].contains("where zones meet"), "{notes:?}");
    }
    let (mesh, _) = two(&[-1, 0, 6, i32::MAX, 1], &[1, 1, 1, 1, 1]);
    assert_eq!(mesh.points.len(), 9);
}

#[test]
fn lists_have_offsets_or_counts() {
    let polygons = [3, 1, 2, 3, 3, 1, 2, 4, 3, 2, 3, 4, 3, 3, 1, 4];
    let bare: Vec<i32> = polygons.chunks(4).flat_map(|list| &list[1..]).copied().collect();
    let old = section("Polygons", 22, [1, 4], &polygons);
    let mut new = section("Polygons", 22, [1, 4], &bare);
    new.child(int("ElementStartOffset", "DataArray_t", &[0, 3, 6, 9, 12]));
    let old_cells = section("Cells", 23, [5, 5], &[4, -1, 2, 3, 4]);
    let mut new_cells = section("Cells", 23, [5, 5], &[-1, 2, 3, 4]);
    new_cells.child(int("ElementStartOffset", "DataArray_t", &[0, 4]));
    let old = parse(&file(vec![zone("Zone", vec![old, old_cells])])).unwrap();
    let new = parse(&file(vec![zone("Zone", vec![new, new_cells])])).unwrap();
    assert_eq!(old, new);
    assert_eq!(new.0.cells.counts(), [(CellKind::TETRA, 1)]);
    // Without polyhedra the polygons themselves are the cells.
    let alone = section("Polygons", 22, [1, 4], &polygons);
    let alone = parse(&file(vec![zone("Zone", vec![alone])])).unwrap().0;
    assert_eq!(alone.cells.counts(), [(CellKind::TRIANGLE, 4)]);
}

#[test]
fn arrays_missing_in_a_zone_are_nan_and_components_form_vectors() {
    let mut solution = Tree::new("Solution", "FlowSolution_t");
    solution.child(Tree::with_text("GridLocation", "GridLocation_t", "CellCenter"));
    for (name, value) in [("VelocityX", 1.0), ("VelocityY", 2.0), ("VelocityZ", 3.0), ("Index", 4.0)] {
        solution.child(Tree::with(name, "DataArray_t", Values::F64(vec![value; 2])));
    }
    let mut more = Tree::new("More", "FlowSolution_t");
    more.child(int("Index", "DataArray_t", &[1, 2, 3, 4, 5]));
    more.child(int("Short", "DataArray_t", &[1]));
    let (mesh, notes) = parse(&file(vec![
        zone("a", vec![tets(), section("S", 5, [3, 3], &[1, 2, 3])]),
        zone("b", vec![tets(), solution, more]),
    ]))
    .unwrap();
    let velocity = mesh.cell_field("Velocity").unwrap();
    let Values::F64(values) = &velocity.values else { panic!("another type") };
    assert!(values[..9].iter().all(|x| x.is_nan()));
    assert_eq!((velocity.components, &values[9..]), (3, &[1.0, 2.0, 3.0, 1.0, 2.0, 3.0][..]));
    let index = &mesh.point_field("Index").unwrap().values;
    assert_eq!(*index, Values::I32([&[0; 5][..], &[1, 2, 3, 4, 5]].concat()));
    assert!(notes.iter().any(|n| n.contains("/Base/b/More/Short has 1 values for 5 points")), "{notes:?}");
}

#[test]
fn errors_report_their_place() {
    let with = |sections: Vec<Tree>| refused(&file(vec![zone("Zone", sections)]));
    for (number, range, ids, expected) in [
        (
            10,
            [1, 1],
            &[1, 2, 3, 6][..],
            "/Base/Zone/Bad: an element refers to point 6, but there are 5 points",
        ),
        (10, [1, 1], &[1, 2, 3, 0], "refers to point 0"),
        (10, [1, 2], &[1, 2, 3, 4], "2 elements declared"),
        (10, [1, i32::MAX], &[1, 2, 3, 4], "2147483647 elements declared"),
        (10, [2, 0], &[], "invalid element range: 2 to 0"),
        (10, [0, 1], &[1, 2, 3, 4], "element range: 0 to 1"),
        (99, [1, 1], &[1], "type 99"),
        (20, [1, 1], &[10, 1, 2], "is truncated"),
        (20, [1, 1], &[22, 1, 2], "type 22 in a mixed section"),
        (20, [1, 2], &[5, 1, 2, 3], "2 elements declared"),
        (22, [1, 1], &[4, 1, 2], "a list of length 4 exceeds"),
        (22, [1, 1], &[-1, 1, 2], "a list of length -1"),
        (22, [1, 1], &[2, 1, 2], "a polygon has 2 nodes"),
        (23, [1, 1], &[4, 1, 2, 3, 4], "refers to element 1, which is not a polygon"),
        (23, [1, 1], &[1, 1], "a polyhedron has 1 polygons"),
    ] {
        let error = with(vec![section("Bad", number, range, ids)]);
        assert!(error.contains(expected), "{number} {range:?}: {error}");
    }
    let twice = with(vec![tets(), section("More", 10, [2, 2], &[1, 2, 3, 4])]);
    assert!(twice.contains("Tets and More overlap in element numbers"), "{twice}");
    let mut structured = int("Zone", "Zone_t", &[5, 4, 0]);
    structured.child(Tree::with_text("ZoneType", "ZoneType_t", "Structured"));
    assert!(refused(&file(vec![structured])).contains("zone Zone is Structured"));
    assert!(refused(b"hello, this is text").contains("not a CGNS file"));
    assert!(refused(b"\xc0\xa8\xa3\xa9ADF Database Version A02011>\0").contains("older ADF format"));
    assert!(refused(&file(Vec::new())).contains("without zones"));
    assert!(refused(&Tree::file(Vec::new()).unwrap()).contains("without a node labelled CGNSBase_t"));
    let link = Tree::with_type("Elements", "", "LK");
    let error = with(vec![link]);
    assert!(error.contains("/Base/Zone/Elements: is a link"), "{error}");
}
