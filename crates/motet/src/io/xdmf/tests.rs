use std::fs;

use super::*;
use crate::base::{Result, VertexId};
use crate::io::WriteOptions;
use crate::io::in_memory::{parsed, printed_text, refuses};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values, shapes};

fn parse_noted(text: &str) -> (Result<Mesh>, Vec<String>) {
    parsed(&FORMAT, "in.xdmf", text.as_bytes())
}

fn parse(text: &str) -> Mesh {
    parse_noted(text).0.unwrap()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

/// A mesh with tags of facets and of cells and a function over time, in dolfinx's layout with text.
const TAGGED: &str = r#"<?xml version="1.0"?>
<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>
<Xdmf Version="3.0" xmlns:xi="https://www.w3.org/2001/XInclude"><Domain>
<Grid Name="mesh" GridType="Uniform">
<Topology TopologyType="Tetrahedron" NumberOfElements="2" NodesPerElement="4">
<DataItem Dimensions="2 4" NumberType="Int" Format="XML">0 1 2 3
1 2 3 4</DataItem></Topology>
<Geometry GeometryType="XYZ"><DataItem Dimensions="5 3" Format="XML" Precision="8">
0 0 0 1 0 0 0 1 0 0 0 1 1 1 1e0</DataItem></Geometry>
<Attribute Name="rho" Center="Cell"><DataItem Dimensions="2 1" Format="XML">1.5 2.5</DataItem></Attribute>
</Grid>
<Grid Name="facets" GridType="Uniform"><xi:include xpointer="xpointer(/Xdmf/Domain/Grid/Geometry)"/>
<Topology TopologyType="Triangle" NumberOfElements="2" NodesPerElement="3">
<DataItem Dimensions="2 3" NumberType="Int" Format="XML">0 1 2 1 2 4</DataItem></Topology>
<Attribute Name="facets" AttributeType="Scalar" Center="Cell">
<DataItem Dimensions="2 1" NumberType="Int" Format="XML">7 9</DataItem></Attribute>
</Grid>
<Grid Name="cells" GridType="Uniform"><xi:include xpointer="xpointer(/Xdmf/Domain/Grid/Geometry)"/>
<Topology TopologyType="Tetrahedron" NumberOfElements="1" NodesPerElement="4">
<DataItem Dimensions="1 4" NumberType="Int" Format="XML">4 3 2 1</DataItem></Topology>
<Attribute Name="cells" Center="Cell"><DataItem Dimensions="1" NumberType="Int" Format="XML">5</DataItem></Attribute>
</Grid>
<Grid Name="u" GridType="Collection" CollectionType="Temporal">
<Grid Name="u"><xi:include xpointer="xpointer(/Xdmf/Domain/Grid/*)"/><Time Value="0"/>
<Attribute Name="u" AttributeType="Vector" Center="Node">
<DataItem Dimensions="5 3" Format="XML">1 2 3 4 5 6 7 8 9 10 11 12 13 14 15</DataItem></Attribute>
<Attribute Name="p0" Center="Cell"><DataItem Dimensions="2 1" NumberType="Float" Precision="8">3 4</DataItem></Attribute></Grid>
<Grid Name="u"><Time Value="1"/></Grid>
</Grid>
</Domain></Xdmf>
"#;

#[test]
fn grids_of_the_same_points_form_one_mesh() {
    let (mesh, notes) = parse_noted(TAGGED);
    let mesh = mesh.unwrap();
    assert_eq!(mesh.cells.kinds(), [10, 10, 5, 5].map(CellKind));
    assert_eq!(mesh.points[4], [1.0; 3]);
    assert_eq!(mesh.patches().unwrap().ids, [0, 0, 7, 9]);
    assert_eq!(mesh.regions().unwrap().ids, [0, 5, 0, 0]);
    assert_eq!(mesh.cell_field("rho").unwrap().values, vec![1.5f32, 2.5, 0.0, 0.0].into());
    assert_eq!(mesh.point_field("u").unwrap().to_vectors().unwrap()[4], [13.0, 14.0, 15.0]);
    assert_eq!(mesh.cell_field("p0").unwrap().values, vec![3.0, 4.0, 0.0, 0.0].into());
    assert_eq!(notes, ["`u` has 2 steps over time: the first is read"]);
}

#[test]
fn what_is_written_comes_back() {
    let mut mesh = shapes::mixed(2);
    mesh.label_names.regions.insert(1, "blood <&\"> é".into());
    mesh.label_names.patches.insert(7, "wall".into());
    let n = mesh.cells.len();
    mesh.set_cell_field(Field::scalars("region", vec![3i32; n]));
    mesh.set_cell_field(Field::scalars("patch", vec![3i32; n]));
    mesh.set_cell_field(Field { name: "t<".into(), components: 9, values: vec![0.1f64; 9 * n].into() });
    mesh.set_cell_field(Field::scalars("u8", vec![200u8; n]));
    mesh.set_point_field(Field::scalars("big", vec![u64::MAX; mesh.points.len()]));
    mesh.set_point_field(Field {
        name: "f".into(),
        components: 2,
        values: vec![-0.0f32; 2 * mesh.points.len()].into(),
    });
    mesh.field_data.push(Field::scalars("time", vec![0.25, 1.0 / 3.0]));
    let (text, lost) = print(&mesh);
    assert!(lost.is_empty(), "{lost:?}");
    assert_eq!(parse(&text), mesh);
    mesh.cells = Cells::uniform(CellKind::QUADRATIC_TETRA, (0..10).map(VertexId).collect()).unwrap();
    mesh.cell_data.clear();
    let (text, _) = print(&mesh);
    assert!(text.contains("TopologyType=\"Tetrahedron_10\""));
    assert_eq!(parse(&text), mesh);
}

/// The mesh with its cell arrays in the order of their names.
fn sorted(mut mesh: Mesh) -> Mesh {
    mesh.cell_data.sort_by(|a, b| a.name.cmp(&b.name));
    mesh
}

/// A tet between facets and a line, in no order, with labels and other arrays.
fn faceted() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::LINE, [0, 1].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::QUAD, [3, 2, 1, 0].map(VertexId));
    cells.push(CellKind::TETRA, [1, 2, 3, 0].map(VertexId));
    let mut mesh = Mesh::new(vec![[0.5; 3]; 4], cells);
    mesh.set_cell_field(Field::scalars("shear", vec![1.5f32, 0.0, 0.0, -0.0, 2.5, 0.0]));
    mesh.set_cell_field(Field::scalars("n", vec![0i64, 4, 5, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("none", vec![0u8; 6]));
    mesh.set_cell_field(Field::scalars("region", vec![0, 7, 0, 0, 0, 8]));
    mesh.set_cell_field(Field::scalars("patch", vec![3i64, 0, 0, 4, 5, 0]));
    mesh.set_point_field(Field::scalars("p", vec![1.0, 2.0, 3.0, 4.0]));
    mesh.label_names.patches.insert(3, "wall".into());
    mesh
}

#[test]
fn cells_and_facets_are_grids_of_their_own_and_come_back() {
    let mesh = faceted();
    let (text, lost) = print(&mesh);
    assert!(lost.is_empty(), "{lost:?}");
    let document = crate::io::vtkxml::Document::parse(text.as_bytes()).unwrap();
    let grids: Vec<_> = document.root.child("Domain").unwrap().children_named("Grid").collect();
    let of = |i: usize| {
        let arrays = grids[i].children_named("Attribute").map(|a| a.attribute("Name").unwrap());
        let topology = grids[i].child("Topology").unwrap().attribute("TopologyType").unwrap();
        (grids[i].attribute("Name").unwrap(), topology, arrays.collect::<Vec<_>>())
    };
    assert_eq!(of(0), ("mesh", "Tetrahedron", vec!["region", "n", "none", "motet:cell", "p"]));
    assert_eq!(of(1), ("facet_tags", "Triangle", vec!["patch", "shear", "motet:cell"]));
    assert_eq!(of(2), ("facet_tags_2", "Quadrilateral", vec!["patch", "shear", "motet:cell"]));
    assert_eq!(of(3), ("edge_tags", "Polyline", vec!["n", "motet:cell"]));
    assert_eq!(grids.len(), 4);
    assert_eq!(sorted(parse(&text)), sorted(mesh));
}

#[test]
fn grids_without_labels_or_with_arrays_of_other_types_are_read() {
    let (mesh, notes) = parse_noted(&TAGGED.replace("\"facets\" AttributeType", "\"rho\" AttributeType"));
    let mesh = mesh.unwrap();
    assert_eq!(mesh.cells.kinds(), [10, 10, 5, 5].map(CellKind));
    assert!(mesh.patches().is_none());
    assert_eq!(notes[0], "array rho of grid facets is skipped: there is another of this name");
    let twice = "<Attribute Name=\"patch\" Center=\"Cell\"><DataItem Dimensions=\"2\" NumberType=\"Int\" \
                 Format=\"XML\">1 1</DataItem></Attribute>";
    let text =
        TAGGED.replacen("7 9</DataItem></Attribute>", &format!("7 9</DataItem></Attribute>{twice}"), 1);
    let (mesh, notes) = parse_noted(&text);
    assert_eq!(mesh.unwrap().patches().unwrap().ids, [0, 0, 7, 9]);
    assert_eq!(notes[0], "array patch of grid facets is skipped: there is another of this name");
    // An order that is none is an array.
    let odd = print(&faceted()).0.replacen("\n1 5\n", "\n1 9\n", 1);
    assert!(parse(&odd).cell_field("motet:cell").is_some());
}

#[test]
fn lines_and_polygons_have_their_numbers_of_nodes() {
    let mut cells = Cells::new();
    cells.push(CellKind::POLYGON, [0, 1, 2, 3, 4].map(VertexId));
    cells.push(CellKind::LINE, [0, 1].map(VertexId));
    cells.push(CellKind::POLY_LINE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::VERTEX, [3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    let mesh = Mesh::new(vec![[0.5; 3]; 5], cells);
    assert_eq!(parse(&print(&mesh).0), mesh);
    for cells in [
        Cells::uniform(CellKind::LINE, [0, 1, 1, 2].map(VertexId).to_vec()),
        Cells::uniform(CellKind::VERTEX, [0, 1].map(VertexId).to_vec()),
        Ok(Cells::new()),
    ] {
        let mesh = Mesh::new(vec![[0.5; 3]; 5], cells.unwrap());
        assert_eq!(parse(&print(&mesh).0), mesh);
    }
}

#[test]
#[cfg(feature = "hdf5")]
fn numbers_in_hdf5_files_are_read() {
    use crate::io::hdf::{Node, Storage};
    let folder = tempfile::tempdir().unwrap();
    let mut root = Node::new("");
    let mut group = Node::new("Mesh");
    group.array("topology", vec![0i64, 1, 2, 3, 1, 2, 3, 4].into(), &[2, 4], Storage::Zlib);
    root.group(group);
    let points = Values::F64(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
    root.array("points", points, &[5, 3], Storage::Plain);
    fs::write(folder.path().join("a.h5"), root.into_file().unwrap()).unwrap();
    let text = TAGGED
        .replacen("Format=\"XML\">0 1 2 3\n1 2 3 4<", "Format=\"HDF\">a.h5:/Mesh/topology<", 1)
        .replacen(
            "Format=\"XML\" Precision=\"8\">\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1e0<",
            "Format=\"HDF\">\n a.h5:/points\n<",
            1,
        );
    let path = folder.path().join("a.xdmf");
    assert_eq!(parsed(&FORMAT, &path, text.as_bytes()).0.unwrap(), parse(TAGGED));
    for (from, to, expected) in [
        ("a.h5:/points", "b.h5:/points", "the file with its numbers does not exist"),
        ("a.h5:/points", "a.h5:/paints", "a.h5 has no array /paints: `paints` is missing"),
        ("/Mesh/topology", "/Mush/topology", "a.h5 has no array /Mush/topology: `Mush` is missing"),
        ("a.h5:/points", "points", "expected FILE:/GROUP/ARRAY, found `points`"),
    ] {
        let error = parsed(&FORMAT, &path, text.replacen(from, to, 1).as_bytes()).0.unwrap_err().to_string();
        assert!(error.contains(expected), "{to}: {error}");
    }
}

#[test]
#[cfg(feature = "hdf5")]
fn numbers_are_written_to_an_hdf5_file_of_the_same_name() {
    use crate::io::{Compression, Encoding, read, write};
    let folder = tempfile::tempdir().unwrap();
    let mut empty = Mesh::new(vec![[0.5; 3]; 2], Cells::new());
    empty.set_cell_field(Field::scalars("q", Vec::<f64>::new()));
    for (mesh, name) in [(shapes::mixed(2), "a.b.xdmf"), (parse(TAGGED), "<c>.xmf"), (empty, "d.xdmf")] {
        let path = folder.path().join(name);
        for (compression, encoding) in [
            (Compression::Zlib, Encoding::Binary),
            (Compression::None, Encoding::Binary),
            (Compression::None, Encoding::Ascii),
        ] {
            let options = WriteOptions { compression, encoding, ..WriteOptions::default() };
            assert!(write(&path, &mesh, &options).unwrap().is_empty());
            assert_eq!(path.with_extension("h5").is_file(), !name.contains('<'));
            assert_eq!(sorted(read(&path).unwrap()), sorted(mesh.clone()), "{name}");
        }
    }
}

#[test]
fn what_cannot_be_held_is_reported() {
    let mut mesh = Mesh::new(vec![[0.0; 3]; 20], Cells::new());
    mesh.cells.push(CellKind::QUADRATIC_HEXAHEDRON, (0..20).map(VertexId));
    mesh.set_point_field(Field::scalars("title", Values::Text(vec!["x".into(); 20])));
    let (_, lost) = print(&mesh);
    for expected in ["hexahedron20", "text arrays are not written (XDMF has none): title"] {
        assert!(lost.iter().any(|what| what.contains(expected)), "{expected}: {lost:?}");
    }
}

#[test]
fn damage_is_reported_with_its_line() {
    let damages = [
        ("\"5 3\" Format=\"XML\" P", "\"6 3\" Format=\"XML\" P", "expected 18 numbers, found 15"),
        (
            "\"5 3\" Format=\"XML\" P",
            "\"9999999999 3\" Format=\"XML\" P",
            "9999999999 3 numbers declared, but the text has",
        ),
        ("\"5 3\" Format=\"XML\" P", "\"4 3\" Format=\"XML\" P", "expected 12 numbers, found more"),
        ("\"5 3\" Format=\"XML\" P", "\"x\" Format=\"XML\" P", "expected Dimensions, such as"),
        ("1 1 1e0", "1 1 1f0", "line 8, DataItem: expected a number, found `1f0`"),
        ("0 1 2 3\n1 2", "0 1 2 3\n1 -2", "line 5, Topology: expected ids of points, found -2"),
        ("0 1 2 3\n1 2", "0 1 2 3\n1 9", "cell 1: refers to point 9, but there are 5 points"),
        (
            "Type=\"Tetrahedron\"",
            "Type=\"Hexahedron_64\"",
            "topologies of type `Hexahedron_64` are not supported",
        ),
        ("Type=\"Tetrahedron\"", "Type=\"Mixed\"", "cell 0: topology 0 is not supported"),
        (
            "Type=\"XYZ\"",
            "Type=\"X_Y_Z\"",
            "geometries of type `X_Y_Z` are not supported; write coordinates as XYZ",
        ),
        (
            "<DataItem Dim",
            "<DataItem ItemType=\"HyperSlab\" Dim",
            "data items of type `HyperSlab` are not supported",
        ),
        ("Format=\"XML\"", "Format=\"Binary\"", "data items of format `Binary` are not supported"),
        ("GridType=\"Uniform\"", "GridType=\"Tree\"", "grids of type `Tree` are not supported"),
    ];
    refuses(&FORMAT, "in.xdmf", TAGGED, &damages);
    // Elements that are not known do no harm.
    assert_eq!(parse(&TAGGED.replacen("<Geometry", "<Geo/><Geometry", 1)), parse(TAGGED));
    let wide = TAGGED.replacen("\"2 1\" Format", "\"0 99999999999 99999999999\" Format", 1);
    assert!(parse_noted(&wide).0.is_err());
    let error = parse_noted("<Xdmf><Domain/></Xdmf>").0.unwrap_err().to_string();
    assert!(error.contains("there is no grid"), "{error}");
    let error = parse_noted("<VTKFile/>").0.unwrap_err().to_string();
    assert!(error.contains("expected root element `Xdmf`, found `VTKFile`"), "{error}");
}
