//! Meshes in several files or pieces, cells in several groups, trailing bytes after triangles, and
//! decompression without end.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use motet::Mesh;
use motet::base::VertexId;
use motet::io::{Compression, WriteOptions, formats, read_noted, write};
use motet::mesh::{CellKind, Cells, Field, Summary, shapes};

/// A folder that is removed after the test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.at(name), bytes).expect("the file is written");
        self.at(name)
    }

    fn mesh(&self, name: &str, mesh: &Mesh) {
        write(self.at(name), mesh, &WriteOptions::default()).expect("the mesh is written");
    }
}

fn read(path: impl AsRef<Path>) -> (Mesh, String) {
    let (mesh, notes) = read_noted(path).expect("it is read");
    (mesh, notes.join("\n"))
}

fn refused(path: impl AsRef<Path>) -> String {
    read_noted(path).expect_err("it is refused").to_string()
}

/// The cells of a cube between two planes across x, with a layer of ghosts on either side on request.
fn part(whole: &Mesh, [low, high]: [f64; 2], ghosts: f64) -> Mesh {
    let (mut cells, mut flags) = (Cells::new(), Vec::new());
    let mut new = vec![None; whole.points.len()];
    let mut used = Vec::new();
    for (_, kind, vertices) in whole.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        let middle = vertices.iter().map(|v| whole.points[v.index()][0]).sum::<f64>() / vertices.len() as f64;
        if (low - ghosts..high + ghosts).contains(&middle) {
            flags.push(u8::from(!(low..high).contains(&middle)));
            let ids: Vec<VertexId> = vertices
                .iter()
                .map(|v| {
                    *new[v.index()].get_or_insert_with(|| {
                        used.push(v.index());
                        VertexId::new(used.len() - 1)
                    })
                })
                .collect();
            cells.push(kind, ids);
        }
    }
    let mut mesh = Mesh::new(used.iter().map(|&v| whole.points[v]).collect(), cells);
    mesh.set_point_field(Field::scalars("global", used.iter().map(|&v| v as i64).collect::<Vec<_>>()));
    if ghosts > 0.0 {
        mesh.set_cell_field(Field::scalars("vtkGhostType", flags));
    }
    mesh
}

const THIRDS: [[f64; 2]; 3] = [[-1.0, 0.34], [0.34, 0.67], [0.67, 2.0]];

fn cube() -> Mesh {
    shapes::box_grid([6, 2, 2], [[0.0; 3], [1.0; 3]])
}

fn is_whole(mesh: &Mesh, whole: &Mesh) {
    let (ours, theirs) = (Summary::of(mesh), Summary::of(whole));
    assert!((ours.volume - 1.0).abs() < 1e-12, "volume {}", ours.volume);
    assert_eq!(mesh.points.len(), whole.points.len());
    assert!(ours.conforming && ours.defects.is_empty(), "{:?}", ours.defects);
    assert_eq!(ours.boundary.map(|b| b.facets), theirs.boundary.map(|b| b.facets));
    let ids = mesh.point_field("global").and_then(|f| f.values.to_i64()).expect("ids of points");
    assert!(mesh.points.iter().zip(ids).all(|(p, id)| *p == whole.points[id as usize]));
}

#[test]
fn the_parts_of_a_parallel_run_form_one_mesh() {
    let (folder, whole) = (Folder::new(), cube());
    for ghosts in [0.0, 0.2] {
        for (i, third) in THIRDS.iter().enumerate() {
            folder.mesh(&format!("part_{i}.vtu"), &part(&whole, *third, ghosts));
        }
        let pieces: String = (0..3).map(|i| format!("<Piece Source=\"part_{i}.vtu\"/>")).collect();
        let text = format!(
            "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"1\">{pieces}</PUnstructuredGrid></VTKFile>"
        );
        let (mesh, notes) = read(folder.write("all.pvtu", text));
        is_whole(&mesh, &whole);
        assert_eq!(notes.contains("ghost cells"), ghosts > 0.0, "{notes}");
        assert!(notes.contains("pieces are joined"), "{notes}");
    }
}

#[test]
fn blocks_form_one_mesh_and_name_its_regions() {
    let (folder, whole) = (Folder::new(), cube());
    for (i, third) in THIRDS.iter().enumerate() {
        let mut mesh = part(&whole, *third, 0.0);
        if i == 1 {
            mesh.set_point_field(Field::scalars("only here", vec![1.0; mesh.points.len()]));
        }
        folder.mesh(&format!("b{i}.vtu"), &mesh);
    }
    let text = r#"<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet><Block index="0" name="fluid"><DataSet index="0" file="b0.vtu"/></Block>
        <DataSet index="1" name="wall" file="b1.vtu"/><DataSet index="2" name="rest" file="b2.vtu"/></vtkMultiBlockDataSet></VTKFile>"#;
    let (mesh, notes) = read(folder.write("all.vtm", text));
    is_whole(&mesh, &whole);
    assert!(notes.contains("only here"), "{notes}");
    let regions = mesh.regions().expect("regions");
    let names: Vec<&str> = regions.names.values().map(String::as_str).collect();
    assert_eq!(names, ["fluid", "wall", "rest"]);
}

#[test]
fn nested_blocks_of_one_name_are_told_apart_and_parts_of_a_block_are_not() {
    let (folder, whole) = (Folder::new(), cube());
    for (i, third) in THIRDS.iter().enumerate() {
        folder.mesh(&format!("b{i}.vtu"), &part(&whole, *third, 0.0));
    }
    let names = |blocks: &str| {
        let text = format!(
            "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>{blocks}</vtkMultiBlockDataSet></VTKFile>"
        );
        let (mesh, _) = read(folder.write("all.vtm", text));
        is_whole(&mesh, &whole);
        mesh.regions().expect("regions").names.into_values().collect::<Vec<String>>()
    };
    let set = |name: &str, i: usize| format!("<DataSet name=\"{name}\" file=\"b{i}.vtu\"/>");
    let block = |name: &str, inner: &str| format!("<Block name=\"{name}\">{inner}</Block>");
    let nested =
        block("left", &set("wall", 0)) + &block("right", &block("deep", &set("wall", 1))) + &set("rest", 2);
    assert_eq!(names(&nested), ["left/wall", "right/deep/wall", "rest"]);
    let pieces = format!(
        "<VTKFile type=\"vtkMultiPieceDataSet\"><vtkMultiPieceDataSet>{}{}</vtkMultiPieceDataSet></VTKFile>",
        "<DataSet file=\"b0.vtu\"/>", "<DataSet file=\"b1.vtu\"/>"
    );
    folder.write("two.vtm", pieces);
    let two = "<DataSet name=\"blood\" file=\"two.vtm\"/>".to_owned() + &set("rest", 2);
    assert_eq!(names(&two), ["blood", "rest"]);
}

#[test]
fn files_that_refer_to_each_other_or_to_missing_files_are_refused() {
    let folder = Folder::new();
    let file = |to: &str| {
        format!(
            "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"{to}\"/></PUnstructuredGrid></VTKFile>"
        )
    };
    assert!(refused(folder.write("round.pvtu", file("round.pvtu"))).contains("deep"));
    assert!(refused(folder.write("lost.pvtu", file("nowhere.vtu"))).contains("nowhere.vtu"));
}

#[test]
fn an_element_of_two_groups_is_one_cell() {
    let folder = Folder::new();
    let mut nodes = String::new();
    for (i, p) in ["0 0 0", "1 0 0", "0 1 0", "0 0 1"].iter().enumerate() {
        nodes += &format!("{} {p}\n", i + 1);
    }
    let text = |elements: &str, data: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{nodes}$EndNodes\n$Elements\n{}\n{elements}$EndElements\n{data}",
            elements.lines().count()
        )
    };
    let data = "$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n4\n1 0.5\n2 0.5\n3 7\n4 7\n$EndElementData\n";
    let twice = "1 4 2 7 1 1 2 3 4\n2 4 2 9 1 1 2 3 4\n3 2 2 5 2 1 2 3\n4 2 2 6 2 1 2 3\n";
    let (mesh, notes) = read(folder.write("twice.msh", text(twice, data)));
    assert_eq!(mesh.cells.kinds(), [CellKind::TETRA, CellKind::TRIANGLE]);
    assert_eq!(mesh.cell_field("gmsh:physical").and_then(|f| f.values.to_i64()), Some(vec![7, 5]));
    assert_eq!(mesh.cell_field("e").and_then(|f| f.values.to_f64()), Some(vec![0.5, 7.0]));
    assert!(notes.contains("several physical groups"), "{notes}");
    // The same group twice, or another entity, is taken as the file says.
    for other in ["2 4 2 7 1 1 2 3 4\n", "2 4 2 9 2 1 2 3 4\n"] {
        let (mesh, _) = read(folder.write("other.msh", text(&format!("1 4 2 7 1 1 2 3 4\n{other}"), "")));
        assert_eq!(mesh.cells.len(), 2, "{other}");
    }
}

#[test]
fn data_after_triangles_are_skipped() {
    let (folder, surface) = (
        Folder::new(),
        shapes::Coil { centre: [0.0; 3], radius: 1.0, pitch: 1.0, turns: 1.0, wire_radius: 0.1 }
            .mesh(8, 5)
            .unwrap(),
    );
    folder.mesh("plain.stl", &surface);
    let plain = std::fs::read(folder.at("plain.stl")).unwrap();
    let mut bytes = plain[..84].to_vec();
    for (i, triangle) in plain[84..].chunks_exact(50).enumerate() {
        let size = i % 7;
        bytes.extend(&triangle[..48]);
        bytes.extend((size as u16).to_le_bytes());
        bytes.extend(std::iter::repeat_n(0xee, size));
    }
    let (mesh, notes) = read(folder.write("payload.stl", &bytes));
    assert_eq!(
        (&mesh.points, &mesh.cells),
        (&read(folder.at("plain.stl")).0.points, &read(folder.at("plain.stl")).0.cells)
    );
    assert!(mesh.cell_data.is_empty() && notes.contains("are skipped"), "{notes}");
    bytes.truncate(bytes.len() - 3);
    assert!(refused(folder.write("cut.stl", &bytes)).contains("bytes"));
}

/// A grid of points that are all 0, as one block repeated many times.
fn zeros(n_blocks: usize) -> Vec<u8> {
    let block = 3 << 19;
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    packer.write_all(&vec![0; block]).unwrap();
    let packed = packer.finish().unwrap();
    let mut bytes = format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_",
        n_blocks * block / 24
    )
    .into_bytes();
    let head = [n_blocks, block, 0].into_iter().chain(std::iter::repeat_n(packed.len(), n_blocks));
    head.for_each(|word| bytes.extend((word as u64).to_le_bytes()));
    (0..n_blocks).for_each(|_| bytes.extend(&packed));
    bytes.extend(b"</AppendedData></VTKFile>");
    bytes
}

#[test]
fn decompression_bombs_are_refused_before_decompression() {
    let folder = Folder::new();
    assert_eq!(read(folder.write("some.vtu", zeros(4))).0.points.len(), 4 << 16);
    let message = refused(folder.write("bomb.vtu", zeros(800)));
    assert!(message.contains("1258291200 bytes") && message.contains("MOTET_READ_LIMIT"), "{message}");

    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packer.write_all(&vec![b' '; 1 << 22]).unwrap();
    let packed = packer.finish().unwrap();
    let message = refused(folder.write("bomb.xml.gz", packed.repeat(100)));
    assert!(message.contains("MOTET_READ_LIMIT"), "{message}");
}

#[test]
fn many_arrays_of_the_same_bytes_count_each() {
    let array = "<DataArray type=\"Float64\" Name=\"a\" format=\"appended\" offset=\"0\"/>";
    let mut bytes = format!("<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\"><UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/><FieldData>{}</FieldData></UnstructuredGrid><AppendedData encoding=\"raw\">_", array.repeat(3000)).into_bytes();
    bytes.extend((1u64 << 17).to_le_bytes());
    bytes.extend([0; 1 << 17]);
    bytes.extend(b"</AppendedData></VTKFile>");
    let message = refused(Folder::new().write("same.vtu", bytes));
    assert!(message.contains("MOTET_READ_LIMIT"), "{message}");
}

#[test]
fn writers_say_that_the_order_of_cells_changes() {
    let mut mesh = shapes::box_grid([2, 1, 1], [[0.0; 3], [1.0; 3]]);
    let alternating: Vec<i32> = (0..mesh.cells.len()).map(|i| 1 + (i % 2) as i32).collect();
    mesh.set_cell_field(Field::scalars("region", alternating));
    let lost = write(Folder::new().at("a.cgns"), &mesh, &WriteOptions::default()).unwrap();
    assert!(lost.iter().any(|what| what.contains("order of the cells")), "{lost:?}");
}

#[test]
fn all_compressions_round_trip() {
    let (folder, whole) = (Folder::new(), cube());
    for compression in [Compression::None, Compression::Zlib, Compression::Lz4, Compression::Lzma] {
        let options = WriteOptions { compression, ..WriteOptions::default() };
        write(folder.at("a.vtu"), &whole, &options).unwrap();
        assert_eq!(read(folder.at("a.vtu")).0.points, whole.points);
    }
    assert!(formats().iter().any(|f| f.extensions.contains(&".pvtu")));
}
