//! Writes a mesh as a VTKHDF file.

use crate::base::{Csr, Error, Result, VertexId};
use crate::io::format::{Compression, WriteOptions};
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::labels::label_fields;
use crate::io::output::{Output, write_all};
use crate::io::polygonal::{kind_in_section, section_of};
use crate::io::vtkhdf::SECTIONS;
use crate::mesh::{CellKind, Cells, Field, Mesh, Values, unused_name};

/// The version that every reader of VTKHDF supports, and the first with polyhedra.
const VERSIONS: [[i64; 2]; 2] = [[2, 0], [2, 5]];

pub(super) fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let storage = storage(options)?;
    let mut lost = Vec::new();
    let mut root = Node::new("VTKHDF");
    let sections = sections_of(&mesh.cells);
    let has_polyhedra = !mesh.cells.polyhedron_faces().is_empty();
    root.attribute("Version", Attribute::Ints(VERSIONS[usize::from(has_polyhedra)].to_vec()));
    root.attribute(
        "Type",
        Attribute::Text(if sections.is_some() { "PolyData" } else { "UnstructuredGrid" }.into()),
    );
    let points = Values::F64(mesh.points.as_flattened().to_vec());
    root.array("Points", points, &[mesh.points.len(), 3], storage);
    count(&mut root, "NumberOfPoints", mesh.points.len());
    match sections {
        Some(sections) => {
            SECTIONS
                .iter()
                .zip(&sections)
                .for_each(|(name, lists)| root.group(section(name, lists, storage)));
        }
        None => grid(&mut root, &mesh.cells, storage),
    }
    let (label_cells, label_names) = label_fields(mesh);
    for (name, own, labels) in [
        ("PointData", &mesh.point_data, Vec::new()),
        ("CellData", &mesh.cell_data, label_cells),
        ("FieldData", &mesh.field_data, label_names),
    ] {
        root.group(arrays(name, own.iter().chain(&labels), storage, &mut lost));
    }
    let mut file = Node::new("");
    file.group(root);
    write_all(output, &file.into_file()?)?;
    Ok(lost)
}

pub(super) fn storage(options: &WriteOptions) -> Result<Storage> {
    match options.compression {
        Compression::None => Ok(Storage::Growing),
        Compression::Zlib => Ok(Storage::Zlib),
        Compression::Lz4 | Compression::Lzma => Err(Error::options(
            "VTKHDF cannot be compressed with lz4 or lzma: readers would need an HDF5 plugin",
        )
        .remedy("choose zlib or none")),
    }
}

fn count(group: &mut Node, name: &str, n: usize) {
    group.array(name, Values::I64(vec![n as i64]), &[1], Storage::Plain);
}

/// Writes ids as 64-bit numbers, as VTK does.
fn ids(group: &mut Node, name: &str, ids: impl Iterator<Item = u32>, storage: Storage) {
    let ids: Vec<i64> = ids.map(i64::from).collect();
    let n = ids.len();
    group.array(name, Values::I64(ids), &[n], storage);
}

/// The lists of polygonal data if they preserve all cells and their order; otherwise `None`, and the mesh is
/// written as a grid.
fn sections_of(cells: &Cells) -> Option<[Csr<VertexId>; 4]> {
    let mut lists: [Csr<VertexId>; 4] = Default::default();
    let mut last = 0;
    for (_, kind, vertices) in cells.iter() {
        let section =
            section_of(kind).filter(|&s| s >= last && kind_in_section(s, vertices.len()) == kind)?;
        lists[section].push(vertices.iter().copied());
        last = section;
    }
    cells.kinds().iter().any(|kind| kind.dim() == Some(2)).then_some(lists)
}

fn section(name: &str, lists: &Csr<VertexId>, storage: Storage) -> Node {
    let mut group = Node::new(name);
    connectivity(&mut group, lists, storage);
    group
}

/// Writes the number of cells, their offsets and their vertices.
fn connectivity(group: &mut Node, lists: &Csr<VertexId>, storage: Storage) {
    count(group, "NumberOfCells", lists.len());
    count(group, "NumberOfConnectivityIds", lists.items().len());
    starts(group, "Offsets", lists, storage);
    ids(group, "Connectivity", lists.items().iter().map(|v| v.0), storage);
}

/// Writes the start of each list, and the end of the last.
fn starts<T>(group: &mut Node, name: &str, lists: &Csr<T>, storage: Storage) {
    let ends = lists.iter().scan(0, |end, list| {
        *end += list.len() as u32;
        Some(*end)
    });
    ids(group, name, std::iter::once(0).chain(ends), storage);
}

fn grid(root: &mut Node, cells: &Cells, storage: Storage) {
    connectivity(root, cells.connectivity(), storage);
    let kinds: Vec<u8> = cells.kinds().iter().map(|kind| kind.0).collect();
    root.array("Types", Values::U8(kinds), &[cells.len()], storage);
    if cells.polyhedron_faces().is_empty() {
        return;
    }
    let (mut corners, mut of_cells) = (Csr::<u32>::default(), Csr::<u32>::default());
    let mut polyhedra = cells.polyhedron_faces().iter();
    for kind in cells.kinds() {
        let first = corners.len() as u32;
        let faces = if *kind == CellKind::POLYHEDRON { polyhedra.next() } else { None };
        faces.into_iter().flat_map(Csr::iter).for_each(|face| corners.push(face.iter().map(|v| v.0)));
        of_cells.push(first..corners.len() as u32);
    }
    count(root, "NumberOfFaces", corners.len());
    count(root, "NumberOfFaceConnectivityIds", corners.items().len());
    count(root, "NumberOfPolyhedronToFaceIds", of_cells.items().len());
    starts(root, "FaceOffsets", &corners, storage);
    ids(root, "FaceConnectivity", corners.items().iter().copied(), storage);
    starts(root, "PolyhedronOffsets", &of_cells, storage);
    ids(root, "PolyhedronToFaces", of_cells.items().iter().copied(), storage);
}

fn arrays<'f>(
    name: &str,
    fields: impl Iterator<Item = &'f Field>,
    storage: Storage,
    lost: &mut Vec<String>,
) -> Node {
    let mut group = Node::new(name);
    let mut taken: Vec<String> = Vec::new();
    for field in fields {
        let name = valid_name(&field.name, &taken);
        if name != field.name {
            lost.push(format!("array `{}` is written as `{name}`: HDF5 cannot hold its name", field.name));
        }
        let shape = [field.n_rows(), field.components];
        let shape = if field.components == 1 { &shape[..1] } else { &shape };
        group.array(&name, field.values.clone(), shape, storage);
        taken.push(name);
    }
    group
}

/// The name, or a similar one that VTKHDF can hold: without slashes and dots, and unique.
pub(super) fn valid_name(name: &str, taken: &[String]) -> String {
    let clean: String = name.chars().map(|c| if matches!(c, '/' | '.' | '\0') { '_' } else { c }).collect();
    let clean = if clean.is_empty() { "unnamed".to_owned() } else { clean };
    unused_name(&clean, |name| taken.iter().any(|t| t == name))
}
