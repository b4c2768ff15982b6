//! VTU, VTP, legacy VTK and PVD files: written files are read back, and damaged files are refused with the
//! place and a remedy.

use std::path::Path;

use motet::base::{Csr, Threads, VertexId};
use motet::io::{self, Compression, Encoding, Format, Input, Notes, WriteOptions};
use motet::mesh::{CellKind, Cells, Field, Values, shapes};
use motet::{ErrorKind, Mesh};
use proptest::prelude::*;

fn format(extension: &str) -> &'static Format {
    io::formats().iter().find(|f| f.extensions.contains(&extension)).unwrap()
}

fn read(extension: &str, bytes: &[u8]) -> motet::Result<Mesh> {
    let name = format!("test{extension}");
    io::read_as(
        format(extension),
        &Input { path: Path::new(&name), bytes, threads: &Threads::single(), notes: &Notes::default() },
    )
}

fn write(extension: &str, mesh: &Mesh, options: &WriteOptions) -> (Vec<u8>, Vec<String>) {
    let mut written = format(extension).to_files(mesh, options, &Threads::single()).unwrap();
    assert_eq!(written.files.len(), 1);
    (written.files.remove(0).1, written.lost)
}

/// Every combination of options for a VTK file with this extension.
fn ways(extension: &str) -> Vec<WriteOptions> {
    let way = |encoding, compression, version: Option<&str>| WriteOptions {
        encoding,
        compression,
        version: version.map(str::to_owned),
    };
    if extension == ".vtk" {
        let of_version =
            |v| [way(Encoding::Ascii, Compression::None, v), way(Encoding::Binary, Compression::None, v)];
        return [of_version(None), of_version(Some("4.2"))].concat();
    }
    let mut ways = vec![way(Encoding::Ascii, Compression::None, None)];
    for compression in [Compression::None, Compression::Zlib, Compression::Lz4, Compression::Lzma] {
        ways.extend([Encoding::Base64, Encoding::Binary].map(|encoding| way(encoding, compression, None)));
    }
    ways
}

/// Asserts equality to the bit, where `==` would equate 0 and -0 and distinguish NaN from itself.
fn assert_same(ours: &Mesh, theirs: &Mesh) {
    let bits = |points: &[[f64; 3]]| points.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&ours.points), bits(&theirs.points));
    assert_eq!(ours.cells, theirs.cells);
    assert_eq!(ours.label_names, theirs.label_names);
    for (ours, theirs) in [
        (&ours.point_data, &theirs.point_data),
        (&ours.cell_data, &theirs.cell_data),
        (&ours.field_data, &theirs.field_data),
    ] {
        assert_eq!(ours.len(), theirs.len());
        for (ours, theirs) in ours.iter().zip(theirs) {
            assert_eq!((&ours.name, ours.components), (&theirs.name, theirs.components));
            match (&ours.values, &theirs.values) {
                (Values::F32(a), Values::F32(b)) => {
                    assert!(a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits())), "{}", ours.name);
                }
                (Values::F64(a), Values::F64(b)) => {
                    assert!(a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits())), "{}", ours.name);
                }
                (a, b) => assert_eq!(a, b, "{}", ours.name),
            }
        }
    }
}

// Random meshes.

fn any_values(n: usize) -> impl Strategy<Value = Values> {
    use prop::collection::vec;
    let float = prop_oneof![
        9 => any::<f64>().prop_filter("one NaN is enough", |x| !x.is_nan()),
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE, 5e-324]),
    ];
    prop_oneof![
        vec(any::<i8>(), n).prop_map(Values::I8),
        vec(any::<u8>(), n).prop_map(Values::U8),
        vec(any::<i16>(), n).prop_map(Values::I16),
        vec(any::<u16>(), n).prop_map(Values::U16),
        vec(any::<i32>(), n).prop_map(Values::I32),
        vec(any::<u32>(), n).prop_map(Values::U32),
        vec(any::<i64>(), n).prop_map(Values::I64),
        vec(any::<u64>(), n).prop_map(Values::U64),
        vec(any::<f32>().prop_filter("one NaN is enough", |x| !x.is_nan()), n).prop_map(Values::F32),
        vec(float, n).prop_map(Values::F64),
        vec("[ -~é\n\t]{0,80}", n).prop_map(Values::Text),
    ]
}

/// Arrays with names `prefix0`, ... and characters that the formats must escape.
fn any_fields(prefix: &'static str, n_rows: usize) -> impl Strategy<Value = Vec<Field>> {
    let field = ("[ -~é]{0,6}", prop::sample::select(vec![1usize, 2, 3, 9])).prop_flat_map(
        move |(name, components)| (Just(name), Just(components), any_values(n_rows * components)),
    );
    prop::collection::vec(field, 0..4).prop_map(move |fields| {
        let named = |(i, (name, components, values)): (usize, (String, usize, Values))| Field {
            name: format!("{prefix}{i} {name}"),
            components,
            values,
        };
        fields.into_iter().enumerate().map(named).collect()
    })
}

/// Cells of kinds with a fixed number of vertices, and of others.
fn any_cell(n_points: u32) -> impl Strategy<Value = (CellKind, Vec<u32>)> {
    let fixed =
        prop::sample::select(vec![1u8, 3, 5, 8, 9, 10, 11, 12, 13, 14, 15, 16, 21, 22, 24, 25, 26, 29, 34])
            .prop_map(|k| (CellKind(k), CellKind(k).n_vertices().unwrap()));
    let free =
        (prop::sample::select(vec![2u8, 4, 6, 7, 36, 42]), 3usize..9).prop_map(|(k, n)| (CellKind(k), n));
    prop_oneof![3 => fixed, 1 => free]
        .prop_flat_map(move |(kind, n)| (Just(kind), prop::collection::vec(0..n_points, n)))
}

/// Adds a cell; a polyhedron gets consecutive triangles of the ids as faces. Its vertices are those of its
/// faces, sorted, as in legacy files.
fn push(cells: &mut Cells, kind: CellKind, ids: &[u32]) {
    if kind != CellKind::POLYHEDRON {
        return cells.push(kind, ids.iter().map(|&v| VertexId(v)));
    }
    let mut faces = Csr::default();
    ids.windows(3).for_each(|face| faces.push(face.iter().map(|&v| VertexId(v))));
    let mut vertices = faces.items().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    cells.push_polyhedron(vertices, faces);
}

fn any_mesh() -> impl Strategy<Value = Mesh> {
    (1usize..30, 0usize..12)
        .prop_flat_map(|(n_points, n_cells)| {
            (
                prop::collection::vec(
                    prop::array::uniform3(any::<f64>().prop_filter("finite", |x| !x.is_nan())),
                    n_points,
                ),
                prop::collection::vec(any_cell(n_points as u32), n_cells),
                any_fields("p", n_points),
                any_fields("c", n_cells),
                prop::collection::vec(("[a-z]{1,4}", any_values(3)), 0..3),
                prop::collection::btree_map(1..100i32, "[a-zA-Z <&>%]{1,9}", 0..3),
            )
        })
        .prop_map(|(points, list, point_data, cell_data, field_data, regions)| {
            let mut cells = Cells::new();
            list.iter().for_each(|(kind, ids)| push(&mut cells, *kind, ids));
            let mut mesh = Mesh { point_data, cell_data, ..Mesh::new(points, cells) };
            mesh.field_data = field_data
                .into_iter()
                .enumerate()
                .map(|(i, (name, v))| Field::scalars(format!("{i}{name}"), v))
                .collect();
            mesh.label_names.regions = regions;
            mesh
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_mesh_comes_back_from_every_way_of_writing(mesh in any_mesh()) {
        for extension in [".vtu", ".vtk"] {
            for way in ways(extension) {
                let (bytes, lost) = write(extension, &mesh, &way);
                assert_eq!(lost, [""; 0]);
                assert_same(&read(extension, &bytes).unwrap(), &mesh);
                // Same mesh, same bytes.
                assert_eq!(write(extension, &mesh, &way).0, bytes);
            }
        }
    }

    #[test]
    fn a_file_cut_or_changed_anywhere_is_read_or_refused(
        mesh in any_mesh(),
        cut in 0.0..1.0f64,
        changes in prop::collection::vec((0.0..1.0f64, any::<u8>()), 1..8),
        extension in prop::sample::select(vec![".vtu", ".vtk"]),
        way in 0usize..4,
    ) {
        let (bytes, _) = write(extension, &mesh, &ways(extension)[way]);
        let at = |share: f64| ((bytes.len() - 1) as f64 * share) as usize;
        // Neither may panic; what is read has been validated.
        if let Err(error) = read(extension, &bytes[..at(cut)]) {
            // An empty file has no place.
            assert!(error.place().is_some() || at(cut) == 0, "{error}");
            assert!(error.remedy_text().is_some(), "{error}");
        }
        let mut changed = bytes.clone();
        changes.iter().for_each(|&(share, byte)| changed[at(share)] = byte);
        if let Ok(mesh) = read(extension, &changed) {
            mesh.validate().unwrap();
        }
    }
}

#[test]
fn polygonal_data_round_trip_in_vtks_order_of_cells() {
    let mut mesh = shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    let ids = |list: &[u32]| list.iter().map(|&v| VertexId(v)).collect::<Vec<_>>();
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE_STRIP, ids(&[0, 1, 2, 3, 4]));
    cells.push(CellKind::TRIANGLE, ids(&[0, 1, 2]));
    cells.push(CellKind::PIXEL, ids(&[0, 1, 2, 3]));
    cells.push(CellKind::LINE, ids(&[4, 5]));
    cells.push(CellKind::TETRA, ids(&[0, 1, 2, 3]));
    cells.push(CellKind::VERTEX, ids(&[7]));
    mesh.cells = cells;
    mesh.cell_data = vec![Field { name: "x".into(), components: 2, values: Values::U8((0..12).collect()) }];
    for way in ways(".vtp") {
        let (bytes, lost) = write(".vtp", &mesh, &way);
        assert_eq!(lost.len(), 2, "{lost:?}");
        let back = read(".vtp", &bytes).unwrap();
        let kinds =
            [CellKind::VERTEX, CellKind::LINE, CellKind::TRIANGLE, CellKind::QUAD, CellKind::TRIANGLE_STRIP];
        assert_eq!(back.cells.kinds(), kinds);
        assert_eq!(back.cells.connectivity().list(3), ids(&[0, 1, 3, 2]));
        assert_eq!(back.cell_data[0].values, Values::U8(vec![10, 11, 6, 7, 2, 3, 4, 5, 0, 1]));
        // The second time, nothing is left to change.
        let (again, lost) = write(".vtp", &back, &way);
        assert!(lost.is_empty());
        assert_same(&read(".vtp", &again).unwrap(), &back);
    }
}

#[test]
fn a_mesh_without_surface_cells_is_no_polygonal_data() {
    let mut mesh = shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    mesh.cells = Cells::uniform(CellKind::TETRA, [0, 1, 2, 4].map(VertexId).to_vec()).unwrap();
    mesh.cell_data.clear();
    let error = format(".vtp").to_files(&mesh, &WriteOptions::default(), &Threads::single()).unwrap_err();
    assert!(error.to_string().contains("cannot hold cells of kind tetra"), "{error}");
}

#[test]
fn labels_of_other_programs_are_written_under_our_names() {
    let cells = [0, 1, 2, 3, 0, 1, 2].map(VertexId);
    let mut list = Cells::new();
    list.push(CellKind::TETRA, cells[..4].iter().copied());
    list.push(CellKind::TRIANGLE, cells[4..].iter().copied());
    let mut mesh = Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], list);
    mesh.set_cell_field(Field::scalars("gmsh:physical", vec![7i32, 9]));
    mesh.label_names.regions.insert(7, "lumen".into());
    mesh.label_names.patches.insert(9, "wall: <inner>".into());
    for extension in [".vtu", ".vtk"] {
        let back = read(extension, &write(extension, &mesh, &WriteOptions::default()).0).unwrap();
        assert_eq!(back.cell_field("region").unwrap().values, Values::I32(vec![7, 0]));
        assert_eq!(back.cell_field("patch").unwrap().values, Values::I32(vec![0, 9]));
        assert_eq!(back.label_names, mesh.label_names);
        assert!(back.field_data.is_empty());
    }
}

// Damaged files.

/// One tet with an array, as text that the tests modify.
const TET: &str = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <UnstructuredGrid>
    <Piece NumberOfPoints="4" NumberOfCells="1">
      <PointData>
        <DataArray type="Float32" Name="p" format="ascii">1 2 3 4</DataArray>
      </PointData>
      <Points>
        <DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>
      </Points>
      <Cells>
        <DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">10</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
"#;

/// Modifies `TET` and asserts that the message has `place`, `what` and a remedy.
fn assert_refused(from: &str, to: &str, place: &str, what: &str) {
    assert!(TET.contains(from), "{from}");
    let error = read(".vtu", TET.replace(from, to).as_bytes()).expect_err(to);
    assert_eq!(error.kind(), ErrorKind::Input);
    let text = error.to_string();
    assert!(text.starts_with("test.vtu: "), "{text}");
    assert!(error.place().unwrap_or_default().contains(place), "{to}: {text}");
    assert!(text.contains(what), "{to}: {text}");
    assert!(error.remedy_text().is_some(), "{to}: {text}");
}

#[test]
fn the_undamaged_test_file_is_valid() {
    assert_eq!(read(".vtu", TET.as_bytes()).unwrap().cells.kinds(), [CellKind::TETRA]);
}

#[test]
fn wrong_counts_are_refused() {
    let huge = "NumberOfPoints=\"1152921504606846976\"";
    assert_refused("NumberOfPoints=\"4\"", huge, "line 4, Piece", "more than a mesh can hold");
    assert_refused(
        "NumberOfPoints=\"4\"",
        "NumberOfPoints=\"5\"",
        "line 9, array Points",
        "expected 15 values, found 12",
    );
    assert_refused("NumberOfPoints=\"4\"", "NumberOfPoints=\"-4\"", "line 4, Piece", "is not a valid count");
    assert_refused("NumberOfPoints=\"4\"", "", "line 4, Piece", "NumberOfPoints is missing");
    assert_refused(
        "NumberOfCells=\"1\"",
        "NumberOfCells=\"1152921504606846976\"",
        "line 14",
        "values, found 1",
    );
    let components = "Name=\"p\" NumberOfComponents=\"9223372036854775807\"";
    assert_refused("Name=\"p\"", components, "line 6, array p", "exceed the available memory");
    assert_refused(">1 2 3 4<", ">1 2 3<", "line 6, array p", "expected 4 values, found 3");
    assert_refused(">1 2 3 4<", ">1 2 x 4<", "line 6, array p", "`x` is not a number");
}

#[test]
fn cells_that_do_not_fit_are_refused() {
    assert_refused(">0 1 2 3<", ">0 1 2 4<", "cell 0", "refers to point 4");
    assert_refused(">0 1 2 3<", ">0 1 2 -3<", "line 12, array connectivity", "-3 is not a valid id");
    assert_refused(">0 1 2 3<", ">0 1 2<", "line 11, Cells", "do not ascend");
    assert_refused(">4<", ">-4<", "line 13, array offsets", "-4 is not a valid id");
    assert_refused(">4<", ">99999999999<", "line 13, array offsets", "not a whole number");
    assert_refused(">10<", ">12<", "cell 0", "a hexahedron has 8 vertices, but this one has 4");
    assert_refused(">10<", ">256<", "line 14, array types", "not a whole number");
    assert_refused(">10<", ">42<", "line 11, Cells", "faces is missing");
}

#[test]
fn descending_offsets_are_refused() {
    let two = TET
        .replace("NumberOfCells=\"1\"", "NumberOfCells=\"3\"")
        .replace(">4<", ">4 2 4<")
        .replace(">10<", ">10 3 3<");
    let error = read(".vtu", two.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("do not ascend"), "{error}");
}

#[test]
fn missing_and_unknown_items_are_reported() {
    assert_refused("<VTKFile", "<Mesh><!--", "line", "XML");
    assert_refused("\"Int64\"", "\"Int128\"", "line 12, array connectivity", "Int128");
    assert_refused("LittleEndian", "MiddleEndian", "line 2, VTKFile", "MiddleEndian");
    assert_refused("UInt64", "UInt16", "line 2, VTKFile", "UInt16");
    assert_refused("version=", "compressor=\"zip\" version=", "VTKFile", "unknown compressor zip");
    assert_refused("Name=\"connectivity\"", "Name=\"c\"", "line 11, Cells", "connectivity is missing");
    assert_refused("Name=\"p\" format=\"ascii\"", "Name=\"p\" format=\"hex\"", "line 6, array p", "hex");
    assert_refused(
        "Name=\"p\" format=\"ascii\"",
        "Name=\"p\" format=\"appended\"",
        "line 6, array p",
        "no AppendedData",
    );
    assert_refused(
        "Name=\"p\" format=\"ascii\"",
        "Name=\"p\" format=\"binary\"",
        "line 6, array p",
        "end inside their header",
    );
    assert_refused(
        "NumberOfComponents=\"3\"",
        "NumberOfComponents=\"2\"",
        "line 9, array Points",
        "components per point, found 2",
    );
    assert_refused("</Cells>", "</Cell>", "line 15", "XML");
    assert_refused("  <UnstructuredGrid>", "  <Grid/><UnstructuredGrid><!--", "line", "XML");
}

#[test]
fn other_kinds_of_vtk_files_are_refused_with_advice() {
    for kind in ["PUnstructuredGrid", "ImageData", "vtkMultiBlockDataSet", "Collection", "Nonsense"] {
        let error = read(".vtu", format!("<VTKFile type=\"{kind}\"></VTKFile>").as_bytes()).unwrap_err();
        assert!(error.to_string().contains(kind) && error.remedy_text().is_some(), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    for extension in ["vti", "pvtu", "vtm"] {
        let path = folder.path().join(format!("a.{extension}"));
        std::fs::write(&path, "<VTKFile type=\"ImageData\"></VTKFile>").unwrap();
        assert!(io::read(&path).unwrap_err().to_string().contains("ImageData"));
    }
}

/// A file with one appended array of points, whose bytes the tests choose.
fn appended(compressor: &str, data: &[u8]) -> Vec<u8> {
    let mut file = format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\"{compressor}><UnstructuredGrid>\
         <Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points>\n\
         <DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/>\
         </Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_"
    )
    .into_bytes();
    file.extend(data);
    file
}

fn words(words: &[u64]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

#[test]
fn inconsistent_appended_data_are_refused() {
    let zlib = " compressor=\"vtkZLibDataCompressor\"";
    assert!(read(".vtu", &appended("", &words(&[24, 0, 0, 0]))).is_ok());
    for (compressor, data, what) in [
        ("", vec![], "end inside their header"),
        ("", words(&[24, 0, 0]), "declares 24 bytes, but 16 are available"),
        ("", words(&[1 << 60]), "declares 1152921504606846976 bytes"),
        ("", words(&[16, 0, 0]), "expected 3 values, found 2"),
        (zlib, words(&[1 << 60]), "declares 1152921504606846976 blocks"),
        (zlib, words(&[u64::MAX]), "blocks"),
        (zlib, words(&[1, 24, 0, 1000]), "block 0 of 1 has 1000 bytes"),
        (zlib, words(&[1, 1 << 40, 0, 8, 0]), "8 bytes cannot decompress to 1099511627776"),
        (zlib, words(&[2, 24, 48, 8, 8, 0, 0]), "the last block has 48 bytes"),
        (zlib, words(&[1, 24, 0, 8, 0]), "block 0 of 1"),
        (zlib, words(&[0, 0, 0]), "expected 3 values, found 0"),
    ] {
        let error = read(".vtu", &appended(compressor, &data)).unwrap_err();
        assert!(error.to_string().contains(what), "{what}: {error}");
        assert_eq!(error.place(), Some("line 2, array Points"));
        assert!(error.remedy_text().is_some());
    }
}

/// Large files with raw appended data are read array by array, small ones whole: both refuse the same.
#[test]
fn a_block_that_reaches_into_the_next_array_is_refused_either_way() {
    let options = WriteOptions { compression: Compression::Zlib, ..WriteOptions::default() };
    let (mut file, _) = write(".vtu", &shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]), &options);
    let head = b"<AppendedData encoding=\"raw\">";
    let end = file.windows(head.len()).position(|w| w == head).expect("appended data") + head.len();
    let start = end + file[end..].iter().position(|&b| b == b'_').expect("an underscore") + 1;
    let packed = u64::from_le_bytes(file[start + 24..start + 32].try_into().unwrap());
    file[start + 24..start + 32].copy_from_slice(&(packed + 9).to_le_bytes());
    let whole = read(".vtu", &file).unwrap_err();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.vtu");
    file.resize(300 << 10, 0);
    std::fs::write(&path, &file).unwrap();
    let by_array = io::read(&path).unwrap_err();
    assert!(whole.to_string().contains("block 0 of 1 has"), "{whole}");
    assert_eq!(whole.place(), by_array.place());
    assert!(by_array.to_string().contains("block 0 of 1 has"), "{by_array}");
}

#[test]
fn pieces_are_joined_and_must_have_the_same_arrays() {
    let (start, end) = (TET.find("    <Piece").unwrap(), TET.find("  </UnstructuredGrid>").unwrap());
    let piece = &TET[start..end];
    let twice = |second: &str| format!("{}{}{}", &TET[..end], second, &TET[end..]);
    // Points at the same place are merged into those of the first piece; all others stay.
    let joined = read(".vtu", twice(piece).as_bytes()).unwrap();
    assert_eq!((joined.points.len(), joined.cells.len()), (4, 2));
    assert_eq!(joined.cells.connectivity().list(1), [0, 1, 2, 3].map(VertexId));
    let beside = piece.replace(">0 0 0 1 0 0 0 1 0 0 0 1<", ">5 0 0 6 0 0 5 1 0 5 0 1<");
    let mesh = read(".vtu", twice(&beside).as_bytes()).unwrap();
    assert_eq!((mesh.points.len(), mesh.cells.len()), (8, 2));
    assert_eq!(mesh.cells.connectivity().list(1), [4, 5, 6, 7].map(VertexId));
    assert_eq!(mesh.point_data[0].values, Values::F32(vec![1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0, 4.0]));
    let empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
    assert_eq!(read(".vtu", twice(empty).as_bytes()).unwrap().points.len(), 4);
    for (from, to) in [("Name=\"p\"", "Name=\"q\""), ("\"Float32\"", "\"Float64\"")] {
        let error = read(".vtu", twice(&piece.replace(from, to)).as_bytes()).unwrap_err();
        assert!(error.to_string().contains("differ from those of the previous pieces"), "{error}");
        assert!(error.remedy_text().is_some());
    }
    // An id beyond the points of its own piece must not be found among those of another.
    assert!(read(".vtu", twice(piece).replacen(">0 1 2 3<", ">0 1 2 7<", 1).as_bytes()).is_err());
}

#[test]
fn both_layouts_of_polyhedra_mean_the_same() {
    let old = "<DataArray type=\"Int64\" Name=\"faces\">4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3</DataArray>\
               <DataArray type=\"Int64\" Name=\"faceoffsets\">17</DataArray></Cells>";
    let new = "<DataArray type=\"Int64\" Name=\"face_connectivity\">0 2 1 0 1 3 1 2 3 2 0 3</DataArray>\
               <DataArray type=\"Int64\" Name=\"face_offsets\">3 6 9 12</DataArray>\
               <DataArray type=\"Int64\" Name=\"polyhedron_to_faces\">0 1 2 3</DataArray>\
               <DataArray type=\"Int64\" Name=\"polyhedron_offsets\">4</DataArray></Cells>";
    let with = |arrays: &str| TET.replace(">10<", ">42<").replace("</Cells>", arrays);
    let mesh = read(".vtu", with(old).as_bytes()).unwrap();
    assert_eq!(mesh.cells.polyhedron_faces()[0].list(2), [1, 2, 3].map(VertexId));
    assert_same(&read(".vtu", with(new).as_bytes()).unwrap(), &mesh);
    for (arrays, from, to) in [
        (old, ">17<", ">16<"),
        (old, ">4 3 0", ">5 3 0"),
        (old, ">4 3 0", ">9999999 3 0"),
        (new, ">0 1 2 3<", ">0 1 2 4<"),
        (new, ">3 6 9 12<", ">3 6 9 13<"),
        (new, ">3 6 9 12<", ">3 2 9 12<"),
        (new, "\"polyhedron_offsets\">4<", "\"polyhedron_offsets\">5<"),
    ] {
        let error = read(".vtu", with(&arrays.replace(from, to)).as_bytes()).unwrap_err();
        assert!(error.to_string().contains("face arrays are inconsistent"), "{to}: {error}");
    }
}

/// A tet in a legacy file, which the tests modify.
const LEGACY: &str = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n\
    0 0 0 1 0 0\n0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n\
    SCALARS a%20b int 1\nLOOKUP_TABLE default\n1 2 3 4\nVECTORS v double\n0 0 0 1 1 1 2 2 2 3 3 3\n";

#[test]
fn a_legacy_file_is_read() {
    let mesh = read(".vtk", LEGACY.as_bytes()).unwrap();
    assert_eq!(mesh.points[3], [0.0, 0.0, 1.0]);
    assert_eq!(mesh.point_field("a b").unwrap().values, Values::I32(vec![1, 2, 3, 4]));
    assert_eq!(mesh.point_field("v").unwrap().components, 3);
    // Windows line ends, lower-case keywords, no line for a lookup table.
    let other =
        LEGACY.replace("LOOKUP_TABLE default\n", "").replace("DATASET", "dataset").replace('\n', "\r\n");
    assert_same(&read(".vtk", other.as_bytes()).unwrap(), &mesh);
}

#[test]
fn damaged_legacy_files_are_refused() {
    for (from, to, place, what) in [
        ("# vtk", "# stl", "line 1", "vtk DataFile"),
        ("ASCII", "EBCDIC", "line 3", "EBCDIC"),
        ("DATASET", "DATA", "line 4", "expected DATASET, found"),
        ("UNSTRUCTURED_GRID", "STRUCTURED_POINTS", "line 4", "STRUCTURED_POINTS"),
        ("POINTS 4", "POINTS 1152921504606846976", "line 5", "more than a mesh can hold"),
        ("POINTS 4", "POINTS 400000000", "line 5", "numbers, but only"),
        ("POINTS 4", "POINTS x", "line 5", "expected a count, found"),
        ("POINTS 4 float", "POINTS 4 quaternion", "line 5", "quaternion"),
        ("0 1 0 0 0 1", "0 1 0 0 0 z", "line 7", "`z` is not a number"),
        ("CELLS 1 5", "CELLS 1 4", "line", ""),
        ("CELLS 1 5", "CELLS 2 5", "line 9", "5 numbers do not form the lists of 2 cells"),
        ("4 0 1 2 3", "5 0 1 2 3", "line 9", "do not form the lists"),
        ("4 0 1 2 3", "4 0 1 2 4", "cell 0", "refers to point 4"),
        ("4 0 1 2 3", "4 0 1 2 -3", "line 9", "-3 is not a valid id"),
        ("CELL_TYPES 1\n10", "CELL_TYPES 2\n10 10", "CELLS", "2 cell types for 1 cells"),
        ("\n10\n", "\n12\n", "cell 0", "hexahedron"),
        ("POINT_DATA 4", "POINT_DATA 5", "line 12", "expected 4 rows, found 5"),
        ("SCALARS", "SCALAR", "line 13", "unknown section `SCALAR`"),
        ("VECTORS v double", "VECTORS v", "line", ""),
        ("3 3 3\n", "3\n", "line 16", "expected 12 numbers"),
    ] {
        assert!(LEGACY.contains(from), "{from}");
        let error = read(".vtk", LEGACY.replace(from, to).as_bytes()).expect_err(to);
        assert!(error.place().unwrap_or_default().contains(place), "{to}: {error}");
        assert!(error.to_string().contains(what), "{to}: {error}");
        assert!(error.remedy_text().is_some(), "{to}: {error}");
    }
}

#[test]
fn an_xml_file_with_the_extension_of_a_legacy_one_is_reported() {
    let error = read(".vtk", TET.as_bytes()).unwrap_err().to_string();
    assert!(error.contains(".vtu or .vtp"), "{error}");
}

#[test]
fn a_series_is_whole_after_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    let mut series = io::SeriesWriter::new(&path, WriteOptions::default());
    let mut mesh = shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    for k in 0..3 {
        mesh.points[0][0] = -0.1 * f64::from(k);
        series.add(0.1 * f64::from(k), &mesh).unwrap();
        let frames = io::read_series(&path).unwrap();
        assert_eq!(frames.len(), k as usize + 1);
        let (time, file) = frames.last().unwrap();
        assert_eq!(*time, 0.1 * f64::from(k));
        assert_eq!(io::read(file).unwrap().points, mesh.points);
    }
}
