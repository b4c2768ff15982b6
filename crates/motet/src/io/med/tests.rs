use super::*;
use crate::base::{Csr, Result, VertexId};
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::in_memory::{parsed, printed};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

fn parse_noted(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.med", bytes)
}

fn print(mesh: &Mesh) -> (Vec<u8>, Vec<String>) {
    printed(&FORMAT, mesh, &Default::default())
}

fn node(name: &str, attributes: &[(&str, i64)], groups: Vec<Node>) -> Node {
    let mut node = Node::new(name);
    attributes.iter().for_each(|&(name, n)| node.attribute(name, Attribute::Int(n)));
    groups.into_iter().for_each(|group| node.group(group));
    node
}

fn with(mut node: Node, arrays: Vec<(&str, Values)>) -> Node {
    arrays.into_iter().for_each(|(name, values)| {
        let n = values.len();
        node.array(name, values, &[n], Storage::Plain);
    });
    node
}

/// A family with its groups.
fn family(name: &str, number: i64, groups: &[&str]) -> Node {
    let mut of = Node::new("GRO");
    of.records("NOM", groups.iter().map(|name| format!("{name:<80}")).collect(), GROUP_NAME);
    node(name, &[("NUM", number)], vec![of])
}

/// Parts of the file of two tets and two triangles.
struct File {
    coordinates: Values,
    tets: Values,
    families_of_tets: Values,
    numbers_of_tets: Values,
    families: Vec<Node>,
    description: &'static str,
    kind: i64,
    n_meshes: usize,
}

impl Default for File {
    fn default() -> Self {
        Self {
            coordinates: vec![0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0]
                .into(),
            tets: vec![1, 2, 3, 4, 2, 3, 4, 5].into(),
            families_of_tets: vec![-4i64, -7].into(),
            numbers_of_tets: vec![3, 9].into(),
            families: vec![
                family("FAM_-4_left", -4, &["left half"]),
                family("FAM_-7_right", -7, &["right"]),
                family("FAM_-8", -8, &["lid", "both"]),
                family("FAM_-9", -9, &["both"]),
            ],
            description: "",
            kind: 0,
            n_meshes: 1,
        }
    }
}

impl File {
    fn bytes(self) -> Vec<u8> {
        let tets = with(
            Node::new("TE4"),
            vec![("NOD", self.tets), ("FAM", self.families_of_tets), ("NUM", self.numbers_of_tets)],
        );
        let triangles = with(
            Node::new("TR3"),
            vec![
                ("NOD", vec![1, 2, 2, 3, 3, 5].into()),
                ("FAM", vec![-8, -9].into()),
                ("NUM", vec![4, 1].into()),
            ],
        );
        let points =
            with(Node::new("NOE"), vec![("COO", self.coordinates), ("FAM", vec![0i64, 2, 0, 2, 0].into())]);
        let cells = node("MAI", &[], vec![tets, triangles, Node::new("PO2")]);
        let step = node("-1", &[("NDT", -1)], vec![points, cells]);
        let later = node("0001", &[], vec![]);
        let mut mesh = node("mesh", &[("ESP", 3), ("TYP", self.kind)], vec![step, later]);
        mesh.attribute("DES", Attribute::Text(self.description.to_owned()));
        let mut meshes = vec![mesh];
        meshes.truncate(self.n_meshes);
        let elements = node("ELEME", &[], self.families);
        let nodes = node("NOEUD", &[], vec![family("FAM_2", 2, &["ends"])]);
        let zero = node("FAMILLE_ZERO", &[("NUM", 0)], vec![]);
        let families = node("FAS", &[], vec![node("mesh", &[], vec![zero, elements, nodes])]);
        let profile =
            |values: Vec<f64>| with(node(WHOLE, &[("NGA", 1)], vec![]), vec![("CO", values.into())]);
        let field = |name: &str, support: &str, profiles: Vec<Node>| {
            let mut field = node(name, &[], vec![node("2", &[], vec![node(support, &[], profiles)])]);
            field.attribute("MAI", Attribute::Text("mesh".into()));
            field
        };
        let fields = node(
            "CHA",
            &[],
            vec![
                field("u", "NOE", vec![profile((0..10).map(f64::from).collect())]),
                field("q", "MAI.TE4", vec![profile(vec![5.0, 6.0])]),
                field("part", "NOE", vec![Node::new("some")]),
                field("corners", "NOE.TE4", vec![profile(vec![0.0; 8])]),
                field("short", "NOE", vec![profile(vec![0.0; 3])]),
            ],
        );
        let meshes = node("ENS_MAA", &[], meshes);
        node("", &[], vec![meshes, families, fields]).into_file_v1_8().unwrap()
    }
}

#[test]
fn cells_groups_and_fields_are_read() {
    let (mesh, notes) = parse_noted(&File::default().bytes());
    let mesh = mesh.unwrap();
    // In the order of their numbers: 1, 3, 4, 9.
    assert_eq!(mesh.cells.kinds(), [5, 10, 5, 10].map(CellKind));
    // The nodes are those at even places and at odd places, of which the second and third are exchanged.
    let list = |cell: usize| mesh.cells.connectivity().list(cell).iter().map(|v| v.0).collect::<Vec<_>>();
    assert_eq!((list(0), list(1), list(3)), (vec![1, 2, 4], vec![0, 1, 2, 3], vec![1, 2, 3, 4]));
    assert_eq!(mesh.points[4], [1.0, 1.0, 1.0]);
    let (regions, patches) = (mesh.regions().unwrap(), mesh.patches().unwrap());
    assert_eq!(regions.ids, [0, 4, 0, 7]);
    assert_eq!((regions.name(4), regions.name(7)), ("left half".into(), "right".into()));
    assert_eq!((patches.ids, patches.names[&1].as_str()), (vec![1, 0, 1, 0], "both"));
    assert_eq!(mesh.cell_field("elset:lid").unwrap().values, vec![0u8, 0, 1, 0].into());
    assert_eq!(mesh.point_field("nset:ends").unwrap().values, vec![0u8, 1, 0, 1, 0].into());
    let u = mesh.point_field("u").unwrap();
    assert_eq!(
        (u.components, &u.values),
        (2, &vec![0.0, 5.0, 1.0, 6.0, 2.0, 7.0, 3.0, 8.0, 4.0, 9.0].into())
    );
    assert_eq!(mesh.cell_field("q").unwrap().values, vec![0.0, 5.0, 0.0, 6.0].into());
    assert_eq!(
        notes,
        [
            "of 2 steps of the mesh the first is read",
            "cells of type PO2 are skipped",
            "field corners on NOE.TE4 is skipped",
            "field part on parts of cells (NOE) is skipped",
            "field short is skipped: it does not have 5 rows",
        ]
    );
}

#[test]
fn what_is_read_comes_back() {
    let mesh = parse_noted(&File::default().bytes()).0.unwrap();
    let (bytes, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    assert_eq!(parse_noted(&bytes).0.unwrap(), mesh);
}

#[test]
fn cells_of_meshio_run_as_those_of_vtk() {
    let file = File { description: "Mesh created with meshio", ..File::default() };
    let mesh = parse_noted(&file.bytes()).0.unwrap();
    assert_eq!(mesh.cells.connectivity().list(1), [0, 2, 1, 3].map(VertexId));
}

#[test]
fn without_groups_families_are_labels_and_equal_numbers_leave_the_order() {
    let file = File { families: Vec::new(), numbers_of_tets: vec![1, 2].into(), ..File::default() };
    let mesh = parse_noted(&file.bytes()).0.unwrap();
    assert_eq!(mesh.cells.kinds(), [10, 10, 5, 5].map(CellKind));
    assert_eq!(mesh.regions().unwrap().ids, [4, 7, 0, 0]);
    assert_eq!(mesh.patches().unwrap().ids, [0, 0, 8, 9]);
    assert!(mesh.label_names == Default::default() && mesh.point_field("nset:ends").is_some());
}

#[test]
fn polygons_and_polyhedra_come_back() {
    let ids = |list: &[u32]| list.iter().map(|&v| VertexId(v)).collect::<Vec<_>>();
    let mut cells = Cells::new();
    let mut faces = Csr::default();
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].iter().for_each(|face| faces.push(ids(face)));
    cells.push_polyhedron(ids(&[0, 1, 2, 3]), faces);
    cells.push(CellKind::POLYGON, ids(&[0, 1, 4, 3, 2]));
    cells.push(CellKind::POLYGON, ids(&[0, 1, 4]));
    cells.push(CellKind::TETRA, ids(&[1, 2, 3, 4]));
    let mut mesh = Mesh::new(vec![[0.0; 3], [1.0; 3], [2.0; 3], [0.1, -0.0, 5e-324], [3.0; 3]], cells);
    mesh.set_cell_field(Field::scalars("n", vec![1i32, 2, 3, 4]));
    mesh.set_cell_field(Field {
        name: "v".into(),
        components: 2,
        values: (0..8).map(f64::from).collect::<Vec<_>>().into(),
    });
    let (bytes, lost) = print(&mesh);
    assert_eq!(lost, Vec::<String>::new());
    assert_eq!(parse_noted(&bytes).0.unwrap(), mesh);
}

#[test]
fn what_cannot_be_held_is_reported() {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::PIXEL, [0, 1, 2, 3].map(VertexId));
    let mut mesh = Mesh::new(vec![[0.0; 3]; 4], cells);
    mesh.set_cell_field(Field::scalars("region", vec![1, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 1, 0]));
    mesh.label_names.regions.insert(1, "blood".into());
    mesh.label_names.patches.insert(1, "wall".into());
    mesh.set_point_field(Field::scalars("a/b", vec![0.5f32; 4]));
    mesh.set_point_field(Field::scalars("t", Values::Text(vec!["x".into(); 4])));
    let (bytes, lost) = print(&mesh);
    assert_eq!(
        lost,
        [
            "1 cells of kind pixel are not written: MED has no such cells",
            "numbers of patches are not all kept: MED identifies groups by name",
            "the array a/b is written as a_b",
            "text arrays are not written (MED has none): t",
            "arrays are written in double precision: a/b",
        ]
    );
    let back = parse_noted(&bytes).0.unwrap();
    assert_eq!(
        (back.regions().unwrap().name(1), back.patches().unwrap().name(2)),
        ("blood".into(), "wall".into())
    );
}

#[test]
fn damage_is_reported_with_its_place() {
    let refused = |file: File, expected: &str| {
        let error = parse_noted(&file.bytes()).0.unwrap_err().to_string();
        assert!(error.starts_with("in.med: ") && error.contains(expected), "{error}");
    };
    let file = File::default;
    refused(
        File { tets: vec![1, 2, 3, 4, 2, 3, 4, 6].into(), ..file() },
        "/ENS_MAA/mesh/-1/MAI/TE4/NOD: refers to point 6, but there are 5",
    );
    refused(File { tets: vec![1, 2, 3, 4, 2, 3, 4].into(), ..file() }, "7 nodes of cells of 4 nodes");
    refused(File { tets: vec![0.5; 8].into(), ..file() }, "expected whole numbers");
    refused(File { coordinates: vec![0.0; 16].into(), ..file() }, "16 coordinates of points in 3 dimensions");
    refused(File { families_of_tets: vec![1].into(), ..file() }, "TE4/FAM: expected 2 numbers, found 1");
    refused(
        File { kind: 1, ..file() },
        "/ENS_MAA/mesh: the mesh is structured, which is not supported; convert it",
    );
    refused(File { n_meshes: 0, ..file() }, "the file has no mesh (ENS_MAA is empty)");
    let other = node("", &[], vec![Node::new("VTKHDF")]).into_file_v1_8().unwrap();
    let error = parse_noted(&other).0.unwrap_err().to_string();
    assert!(error.contains("is an HDF5 file without the group ENS_MAA of MED; give"), "{error}");
    assert!(parse_noted(b"hello").0.unwrap_err().to_string().contains("is not an HDF5 file"));
    let bytes = File::default().bytes();
    for end in (0..bytes.len()).step_by(97) {
        assert!(parse_noted(&bytes[..end]).0.is_err(), "{end} of {}", bytes.len());
    }
}
