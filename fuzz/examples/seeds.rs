//! Fills `corpus/TARGET/` with small files of every format that can be written, and with bytes for the
//! targets of algorithms; called by `fuzz/run`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use hdf5_pure::{AttrValue, DatasetBuilder, FileBuilder, GroupBuilder, LibVer};
use motet::Mesh;
use motet::base::{Csr, Threads, VertexId};
use motet::io::{self, Compression, Encoding, WriteOptions};
use motet::mesh::{Cells, Field, Values, shapes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut n_files = BTreeMap::new();
    for format in io::formats() {
        let (Some(_), Some(extension)) = (format.write, format.extensions.first()) else { continue };
        let target = extension.trim_start_matches('.').replace('.', "_");
        let folder = corpus.join(&target);
        fs::create_dir_all(&folder)?;
        for (name, mesh) in meshes() {
            for (k, options) in options().enumerate() {
                let Ok(written) = format.to_files(&mesh, &options, &Threads::single()) else { continue };
                fs::write(folder.join(format!("{name}_{k}")), &written.files[0].1)?;
                *n_files.entry(target.clone()).or_insert(0) += 1;
                if target == "vtu" {
                    fs::create_dir_all(corpus.join("vtu_tail"))?;
                    fs::write(corpus.join("vtu_tail").join(format!("{name}_{k}")), &written.files[0].1)?;
                }
            }
        }
    }
    for (target, text) in [("pvd", PVD), ("dolfin", DOLFIN), ("tetgen", TETGEN), ("opencarp", OPENCARP), ("glb", GLTF)] {
        let folder = corpus.join(target);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("two"), text)?;
        n_files.insert(target.into(), 1);
    }
    let folder = corpus.join("cas_h5");
    fs::create_dir_all(&folder)?;
    for (name, is_compressed) in [("plain", false), ("zlib", true)] {
        fs::write(folder.join(name), cas_h5(is_compressed)?)?;
    }
    n_files.insert("cas_h5".into(), 2);
    for target in ["fill", "repair", "embed", "steps"] {
        let folder = corpus.join(target);
        fs::create_dir_all(&folder)?;
        for k in 0..N_SCRIPTS {
            fs::write(folder.join(format!("bytes_{k}")), bytes(k))?;
        }
        n_files.insert(target.into(), N_SCRIPTS as usize);
    }
    n_files.iter().for_each(|(target, n)| println!("{target}: {n} files"));
    Ok(())
}

/// Number of byte files for each target of an algorithm.
const N_SCRIPTS: u64 = 32;

/// 256 pseudorandom bytes, the same for each `k` (Marsaglia's xorshift).
fn bytes(k: u64) -> Vec<u8> {
    let mut state = 0x9e37_79b9_7f4a_7c15 ^ (k + 1);
    let next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u8
    };
    std::iter::repeat_with(next).take(256).collect()
}

const PVD: &str = r#"<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">
  <Collection>
    <DataSet timestep="0.5" part="0" file="a_0000.vtu"/>
    <DataSet timestep="1e-3" group="" part="0" file="b &lt;1&gt;.vtu"/>
  </Collection>
</VTKFile>
"#;

const DOLFIN: &str = r#"<?xml version="1.0"?>
<dolfin xmlns:dolfin="http://fenicsproject.org">
  <mesh celltype="tetrahedron" dim="3">
    <vertices size="5">
      <vertex index="0" x="0" y="0" z="0"/><vertex index="1" x="1" y="0" z="0"/>
      <vertex index="2" x="0" y="1" z="0"/><vertex index="3" x="0" y="0" z="1"/>
      <vertex index="4" x="1e0" y="1.0" z="1"/>
    </vertices>
    <cells size="2">
      <tetrahedron index="0" v0="0" v1="1" v2="2" v3="3"/>
      <tetrahedron index="1" v0="1" v1="2" v2="3" v3="4"/>
    </cells>
    <data><mesh_function type="uint" dim="3" size="2"><entity index="0" value="7"/><entity index="1" value="8"/></mesh_function></data>
  </mesh>
</dolfin>
"#;

/// The .node, .ele and .face files, separated by zero bytes.
const TETGEN: &str = "5 3 1 1\n0 0 0 0 2 -1\n1 1 0 0 2 -1\n2 0 1 0 2 -1\n3 0 0 1 2 -1\n4 1 1 1 2 -1 # a comment\n\
    \02 4 1\n0 0 1 2 3 7\n1 1 2 3 4 8\n\02 1\n0 0 1 2 -1\n1 2 3 4 -2\n";

/// The .pts, .elem and .lon files, separated by zero bytes.
const OPENCARP: &str = "5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n\02\nTt 0 1 2 3 7\nPy 0 1 2 3 4\n\02\n1 0 0 0 1 0\n0 0 1 0.5 0 0\n";

/// A glTF scene with its buffer inside: a tetrahedron twice, scaled and moved.
const GLTF: &str = r#"{"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,2,2],"children":[1]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,0,0,1],"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12,"byteStride":1}],"buffers":[{"byteLength":60,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAIBAAEDAAMCAQID"}]}"#;

/// A Fluent file in HDF5, which motet does not write: two tets in a zone each.
fn cas_h5(is_compressed: bool) -> Result<Vec<u8>, hdf5_pure::Error> {
    let storage = |array: &mut DatasetBuilder, shape: &[u64]| {
        array.with_shape(shape);
        if is_compressed {
            array.with_chunks(shape).with_shuffle().with_deflate(4);
        }
    };
    let table = |parent: &mut GroupBuilder, columns: &[(&str, &[i32])], names: &str| {
        let mut zones = parent.create_group("zoneTopology");
        for (name, column) in columns {
            storage(zones.create_dataset(name).with_i32_data(column), &[column.len() as u64]);
        }
        zones.create_dataset("name").with_vlen_strings(&[names]).with_shape(&[1]);
        parent.add_group(zones.finish());
    };
    let cells = |parent: &mut GroupBuilder, name: &str, cells: &[u32]| {
        let mut side = parent.create_group(name);
        let array = side.create_dataset("1").with_u32_data(cells);
        array.set_attr("minId", AttrValue::I64(1));
        array.set_attr("maxId", AttrValue::I64(cells.len() as i64));
        storage(array, &[cells.len() as u64]);
        parent.add_group(side.finish());
    };
    let mut file = FileBuilder::new();
    if !is_compressed {
        file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
    }
    let mut meshes = file.create_group("meshes");
    let mut mesh = meshes.create_group("1");
    for (name, n) in [("dimension", 3), ("nodeCount", 5), ("cellCount", 2), ("faceCount", 7)] {
        mesh.set_attr(name, AttrValue::I64(n));
    }
    let mut nodes = mesh.create_group("nodes");
    let mut coords = nodes.create_group("coords");
    let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.5];
    let array = coords.create_dataset("1").with_f64_data(&points);
    array.set_attr("minId", AttrValue::I64(1));
    array.set_attr("maxId", AttrValue::I64(5));
    storage(array, &[5, 3]);
    nodes.add_group(coords.finish());
    mesh.add_group(nodes.finish());
    let mut of_cells = mesh.create_group("cells");
    table(&mut of_cells, &[("id", &[10, 11]), ("minId", &[1, 2]), ("maxId", &[1, 2])], "blood;tissue");
    mesh.add_group(of_cells.finish());
    let mut faces = mesh.create_group("faces");
    let zones: [(&str, &[i32]); 4] =
        [("id", &[3, 4, 5]), ("minId", &[1, 2, 5]), ("maxId", &[1, 4, 7]), ("zoneType", &[2, 10, 36])];
    table(&mut faces, &zones, "inside;inlet;wall");
    let mut of_faces = faces.create_group("nodes");
    let mut section = of_faces.create_group("1");
    section.set_attr("minId", AttrValue::I64(1));
    section.set_attr("maxId", AttrValue::I64(7));
    storage(section.create_dataset("nnodes").with_i16_data(&[3; 7]), &[7]);
    let corners = [1, 3, 4, 1, 2, 3, 1, 4, 2, 2, 4, 3, 1, 5, 3, 1, 5, 4, 4, 5, 3];
    storage(section.create_dataset("nodes").with_u32_data(&corners), &[21]);
    of_faces.add_group(section.finish());
    faces.add_group(of_faces.finish());
    cells(&mut faces, "c0", &[1, 1, 1, 1, 0, 2, 2]);
    cells(&mut faces, "c1", &[2, 0, 0, 0, 2, 0, 0]);
    mesh.add_group(faces.finish());
    meshes.add_group(mesh.finish());
    file.add_group(meshes.finish());
    file.finish()
}

/// Small meshes with everything that a file may contain.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let mut tets = shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
    let (n_points, n_cells) = (tets.points.len(), tets.cells.len());
    tets.set_point_field(Field::vectors("velocity", &vec![[0.5, -0.0, 1e-300]; n_points]));
    tets.set_point_field(Field::scalars("f32", vec![1.5f32; n_points]));
    tets.set_cell_field(Field::scalars("i8", vec![-1i8; n_cells]));
    tets.set_cell_field(Field::scalars("u64", vec![u64::MAX; n_cells]));
    tets.set_cell_field(Field::scalars("text", Values::Text(vec!["a \u{e9}".into(); n_cells])));
    tets.field_data.push(Field::scalars("TimeValue", vec![0.25]));
    vec![
        ("tets", tets),
        ("mixed", shapes::mixed(1)),
        ("polyhedron", polyhedron()),
        ("empty", Mesh::default()),
    ]
}

/// A tet as a polyhedron.
fn polyhedron() -> Mesh {
    let ids = |list: &[u32]| list.iter().map(|&v| VertexId(v)).collect::<Vec<_>>();
    let mut faces = Csr::default();
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].iter().for_each(|face| faces.push(ids(face)));
    let mut cells = Cells::new();
    cells.push_polyhedron(ids(&[0, 1, 2, 3]), faces);
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Mesh::new(points, cells)
}

/// Every combination of write options; formats refuse versions that they do not know.
fn options() -> impl Iterator<Item = WriteOptions> {
    let compressions = [Compression::None, Compression::Zlib, Compression::Lz4, Compression::Lzma];
    let encodings = [Encoding::Ascii, Encoding::Base64, Encoding::Binary];
    let versions = [None, Some("2.2"), Some("4.1"), Some("4.2")];
    versions.into_iter().flat_map(move |version| {
        encodings.into_iter().flat_map(move |encoding| {
            let compressions = if version.is_none() { &compressions[..] } else { &compressions[..1] };
            compressions.to_vec().into_iter().map(move |compression| WriteOptions {
                encoding,
                compression,
                version: version.map(str::to_owned),
            })
        })
    })
}
