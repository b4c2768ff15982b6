use super::tests::{TWO, parse};
use super::{FORMAT, HDF5};
use crate::base::Threads;
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::in_memory::{parsed, survives_changed_bytes};
use crate::mesh::{CellKind, Values};

/// Parts of a file with the mesh of [`TWO`].
struct File {
    dimension: i64,
    n_meshes: usize,
    /// Numbers of points, cells and faces.
    counts: [i64; 3],
    coordinates: Values,
    last_point: i64,
    nnodes: Values,
    nodes: Values,
    c0: Values,
    c1: Values,
    /// Numbers, first and last cell of zones.
    zones_of_cells: [Vec<i64>; 3],
    /// Numbers, first and last face, and types of zones.
    zones_of_faces: [Vec<i64>; 4],
    names: Values,
    /// Further groups of cells and of faces.
    of_cells: Vec<Node>,
    of_faces: Vec<Node>,
}

impl Default for File {
    fn default() -> Self {
        Self {
            dimension: 3,
            n_meshes: 1,
            counts: [5, 2, 7],
            coordinates: vec![0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.5].into(),
            last_point: 9,
            nnodes: Values::I16(vec![3; 6]),
            nodes: Values::U32(vec![5, 6, 7, 5, 8, 6, 6, 8, 7, 5, 9, 7, 5, 9, 8, 8, 9, 7]),
            c0: Values::U32(vec![1, 1, 1, 1, 0, 2, 2]),
            c1: Values::U32(vec![2, 0, 0]),
            zones_of_cells: [vec![10, 11], vec![1, 2], vec![1, 2]],
            zones_of_faces: [vec![3, 4, 5], vec![1, 2, 5], vec![1, 4, 7], vec![3, 10, 36]],
            names: Values::Text(vec!["flap;in-let;".into()]),
            of_cells: Vec::new(),
            of_faces: Vec::new(),
        }
    }
}

fn node(name: &str, attributes: &[(&str, i64)], groups: Vec<Node>) -> Node {
    let mut node = Node::new(name);
    attributes.iter().for_each(|&(name, n)| node.attribute(name, Attribute::Int(n)));
    groups.into_iter().for_each(|group| node.group(group));
    node
}

fn add(node: &mut Node, name: &str, values: Values, width: usize, span: Option<[i64; 2]>) {
    let n = values.len() / width;
    let shape = if width == 1 { vec![n] } else { vec![n, width] };
    let array = node.array(name, values, &shape, Storage::Plain);
    for (name, number) in ["minId", "maxId"].into_iter().zip(span.into_iter().flatten()) {
        array.attribute(name, Attribute::Int(number));
    }
}

fn table(columns: &[(&str, &Vec<i64>)], names: Values) -> Node {
    let mut table = node("zoneTopology", &[("nZones", columns[0].1.len() as i64)], vec![]);
    columns.iter().for_each(|(name, column)| add(&mut table, name, (*column).clone().into(), 1, None));
    add(&mut table, "name", names, 1, None);
    table
}

/// A section of the points of faces.
fn points_of_faces(name: &str, nnodes: Values, nodes: Values, [first, last]: [i64; 2]) -> Node {
    let mut section = node(name, &[("minId", first), ("maxId", last)], vec![]);
    add(&mut section, "nnodes", nnodes, 1, None);
    add(&mut section, "nodes", nodes, 1, None);
    section
}

impl File {
    fn tree(self) -> Node {
        let mut coords = Node::new("coords");
        add(&mut coords, "7", self.coordinates, 3, Some([7, self.last_point]));
        add(&mut coords, "8", Values::F32(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0]), 3, Some([5, 6]));
        let nodes = node("nodes", &[], vec![coords]);
        let [id, first, last] = &self.zones_of_cells;
        // Names as single bytes.
        let names = Values::I8(b"blood;tissue\0".iter().map(|&byte| byte as i8).collect());
        let mut of_cells = self.of_cells;
        of_cells.push(table(&[("id", id), ("minId", first), ("maxId", last)], names));
        let cells = node("cells", &[], of_cells);
        let [id, first, last, kinds] = &self.zones_of_faces;
        let mut of_faces = self.of_faces;
        of_faces
            .push(table(&[("id", id), ("minId", first), ("maxId", last), ("zoneType", kinds)], self.names));
        let one = points_of_faces("2", Values::I16(vec![3]), Values::U32(vec![5, 7, 8]), [1, 1]);
        of_faces.push(node("nodes", &[], vec![one, points_of_faces("1", self.nnodes, self.nodes, [2, 7])]));
        let mut c0 = Node::new("c0");
        add(&mut c0, "1", self.c0, 1, Some([1, 7]));
        let mut c1 = Node::new("c1");
        add(&mut c1, "1", self.c1, 1, Some([5, 7]));
        add(&mut c1, "2", Values::U32(vec![2]), 1, Some([1, 1]));
        of_faces.extend([c0, c1]);
        let faces = node("faces", &[], of_faces);
        let [points, n_cells, n_faces] = self.counts;
        let counts = [
            ("dimension", self.dimension),
            ("nodeCount", points),
            ("cellCount", n_cells),
            ("faceCount", n_faces),
        ];
        let mut meshes = vec![node("1", &counts, vec![nodes, cells, faces]), Node::new("2"), Node::new("3")];
        meshes.truncate(self.n_meshes);
        node("", &[], vec![node("meshes", &[], meshes), Node::new("settings")])
    }

    fn bytes(self) -> Vec<u8> {
        self.tree().into_file_v1_8().unwrap()
    }
}

fn error(bytes: &[u8]) -> String {
    parsed(&HDF5, "in.cas.h5", bytes).0.unwrap_err().to_string()
}

#[test]
fn hdf5_has_the_mesh_that_text_has() {
    assert_eq!(parsed(&HDF5, "in.cas.h5", &File::default().bytes()).0.unwrap(), parse(TWO));
}

#[test]
fn zones_of_faces_between_cells_are_no_patches() {
    let file = File {
        // A zone without faces ends before it begins.
        zones_of_faces: [vec![9, 4, 5, 6], vec![1, 2, 5, 8], vec![1, 4, 7, 7], vec![2, 10, 2, 3]],
        ..File::default()
    };
    let mesh = parsed(&HDF5, "in.cas.h5", &file.bytes()).0.unwrap();
    assert_eq!(mesh.cells.kinds(), [10, 10, 5, 5, 5].map(CellKind));
    assert_eq!(mesh.patches().unwrap().ids, [0, 0, 4, 4, 4]);
}

#[test]
fn each_beginning_is_refused() {
    let bytes = File::default().bytes();
    for end in 0..bytes.len() {
        assert!(parsed(&HDF5, "in.cas.h5", &bytes[..end]).0.is_err(), "{end} of {}", bytes.len());
    }
}

#[test]
fn changed_bytes_of_hdf5_are_survived() {
    survives_changed_bytes(&HDF5, "in.cas.h5", &File::default().bytes(), b"\0\xff");
}

#[test]
fn faults_are_reported_with_their_place() {
    let refused = |file: File, expected: &str| {
        let error = error(&file.bytes());
        assert!(error.starts_with("in.cas.h5: ") && error.contains(expected), "{error}");
    };
    let file = File::default;
    let zones = |first: Vec<i64>, last: Vec<i64>| File {
        zones_of_faces: [vec![3, 4, 5], first, last, vec![3, 10, 36]],
        ..file()
    };
    refused(
        File { dimension: 2, ..file() },
        "/meshes/1: the mesh has two dimensions, which are not supported; open it in ParaView",
    );
    refused(File { dimension: 4, ..file() }, "/meshes/1: expected dimension 3, found 4");
    refused(File { n_meshes: 0, ..file() }, "/meshes: there is no mesh");
    refused(
        File { n_meshes: 3, ..file() },
        "/meshes: there are 3 meshes (1, 2, ...), of which one can be read; write each mesh to a file of its own",
    );
    let tree = || vec![node("tree", &[], vec![Node::new("1")])];
    let hanging =
        "tree: the mesh was refined and has hanging nodes, which are not supported; convert it to polyhedra";
    refused(File { of_cells: tree(), ..file() }, &format!("/meshes/1/cells/{hanging}"));
    refused(File { of_faces: tree(), ..file() }, &format!("/meshes/1/faces/{hanging}"));
    let interface = node("interface", &[], vec![Node::new("8")]);
    refused(
        File { of_faces: vec![interface], ..file() },
        "/meshes/1/faces/interface: faces of zones overlap without common points",
    );
    refused(File { counts: [6, 2, 7], ..file() }, "6 points declared, but the file has 5");
    refused(
        File { counts: [5, 2, i64::MAX], ..file() },
        "9223372036854775807 faces declared, but the file has 7",
    );
    refused(
        File { last_point: i64::MAX, ..file() },
        "/meshes/1/nodes/coords/7: has numbers 7 to 9223372036854775807",
    );
    refused(File { last_point: 10, ..file() }, "has numbers 7 to 10, but 3 rows");
    refused(File { coordinates: Values::Text(vec!["x".into(); 9]), ..file() }, "coords/7: expected numbers");
    refused(
        File { nnodes: vec![3; 5].into(), ..file() },
        "nodes/1/nodes: faces have 15 points (nnodes), found 18",
    );
    refused(
        File { nnodes: vec![3, 3, 3, 3, 3, -3].into(), ..file() },
        "nnodes: expected whole numbers from 0 to",
    );
    refused(
        File { nnodes: Values::U32(vec![u32::MAX; 6]), ..file() },
        "nnodes: faces have more than 4294967295 points",
    );
    refused(
        File { nnodes: vec![2, 4, 3, 3, 3, 3].into(), ..file() },
        "zone 4: face 2: a face has two points",
    );
    refused(
        File { nodes: vec![4; 18].into(), ..file() },
        "face 1: refers to point 4, but there are 5 points, numbered from 5",
    );
    refused(File { c0: vec![1; 6].into(), ..file() }, "/meshes/1/faces/c0/1: has numbers 1 to 7, but 6 rows");
    refused(File { c0: vec![0.5; 7].into(), ..file() }, "/meshes/1/faces/c0/1: expected whole numbers");
    refused(
        File { c1: vec![2, 0, 77].into(), ..file() },
        "refers to cell 76, but cell numbers must be below",
    );
    refused(
        zones(vec![1, 2, 4], vec![1, 4, 7]),
        "/meshes/1/faces/zoneTopology: zones 4 and 5 both have number 4",
    );
    refused(zones(vec![1, 2, 5], vec![1, 4, 8]), "/meshes/1/faces: zone 5: face 8 has no points");
    refused(zones(vec![1, 2, 5], vec![1, 4, 6]), "/meshes/1/faces: 1 faces are in no zone");
    let empty = File { counts: [5, 2, 6], ..zones(vec![0, 2, 5], vec![0, 4, 7]) };
    refused(empty, "/meshes/1/faces: 1 faces are in no zone");
    refused(zones(vec![1, 2, -5], vec![1, 4, 7]), "zone 5 has negative numbers: -5 to 7");
    refused(zones(vec![1, 2], vec![1, 4, 7]), "zoneTopology/minId: 3 zones have 2 numbers here");
    refused(
        File { zones_of_cells: [vec![10, 1 << 40], vec![1, 2], vec![1, 2]], ..file() },
        "/meshes/1/cells/zoneTopology: zone 1099511627776 needs more than 32 bits",
    );
    refused(
        File { zones_of_cells: [vec![10, 11], vec![1, 2], vec![1, 9]], ..file() },
        "zones have more than the 2 cells that faces refer to",
    );
}

#[test]
fn other_files_are_told_apart() {
    let results = node("", &[], vec![Node::new("results")]).into_file_v1_8().unwrap();
    let what = error(&results);
    assert!(
        what.contains("the file has a solution, but no mesh; give the case that belongs to it"),
        "{what}"
    );
    let other = node("", &[], vec![Node::new("VTKHDF")]).into_file_v1_8().unwrap();
    assert!(error(&other).contains("is an HDF5 file without the group meshes of Fluent"));
    assert!(error(TWO.as_bytes()).contains("is not an HDF5 file"));
    let misnamed = parsed(&FORMAT, "in.cas", &other).0.unwrap_err().to_string();
    assert!(
        misnamed.contains("give it the extension of its format") && misnamed.contains(".cas.h5"),
        "{misnamed}"
    );
    let error = HDF5.to_files(&parse(TWO), &Default::default(), &Threads::single()).unwrap_err().to_string();
    assert!(error.contains("Fluent (HDF5) files can only be read"), "{error}");
}
