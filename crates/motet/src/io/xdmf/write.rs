//! Writes a grid, or one for each kind of cells, with the numbers in an HDF5 file or as text.

use std::fmt::Write as _;

use super::kinds::Topology;
use super::parts::{Part, arrays_of, parts, places};
use crate::base::{Result, Threads};
use crate::io::format::{Compression, Encoding, WriteOptions, Written};
use crate::io::hdf::{Node, Storage};
use crate::io::labels::label_fields;
use crate::io::output::{Output, write_all};
use crate::io::scalar::write_text;
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::vtkxml::escape_attribute;
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Values};

/// Writes a file that refers to `STEM.h5`, which holds the numbers; for text encoding, or without a name that
/// it can refer to, one file with the numbers as text.
pub(super) fn write(mesh: &Mesh, options: &WriteOptions, threads: &Threads, stem: &str) -> Result<Written> {
    let mut bytes = Vec::new();
    // Readers take a colon as the end of the name, and some do not resolve entities.
    let is_plain = !stem.is_empty() && !stem.contains(['&', '<', '>', ':']);
    let is_text = options.encoding == Encoding::Ascii || cfg!(not(feature = "hdf5")) || !is_plain;
    let storage = match options.compression {
        Compression::None => Storage::Plain,
        _ => Storage::Zlib,
    };
    let heavy = Heavy { file: format!("{stem}.h5"), storage, root: Node::new(""), n_arrays: 0 };
    let output = &mut Output::to_memory(&mut bytes, threads);
    let mut sink = Sink { output, heavy: (!is_text).then_some(heavy) };
    let lost = write_grid(mesh, &mut sink)?;
    let heavy = sink.heavy.map(|heavy| heavy.root.into_file()).transpose()?;
    let mut files = vec![(String::new(), bytes)];
    files.extend(heavy.map(|bytes| (".h5".to_owned(), bytes)));
    Ok(Written { files, lost })
}

/// Where the XML goes, and where the numbers go if not into it.
struct Sink<'s, 'o> {
    output: &'s mut Output<'o>,
    heavy: Option<Heavy>,
}

/// An HDF5 file to be written.
struct Heavy {
    file: String,
    storage: Storage,
    root: Node,
    n_arrays: usize,
}

impl Sink<'_, '_> {
    fn put(&mut self, xml: &str) -> Result<()> {
        write_all(self.output, xml.as_bytes())
    }

    /// Writes a data item of numbers of the given shape.
    fn item(&mut self, values: &Values, shape: &[usize]) -> Result<()> {
        let [kind, bytes] = number_type(values).unwrap_or_default();
        let dimensions = shape.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        let format = if self.heavy.is_some() { "HDF" } else { "XML" };
        self.put(&format!(
            "<DataItem Dimensions=\"{dimensions}\" NumberType=\"{kind}\" Precision=\"{bytes}\" Format=\"{format}\">"
        ))?;
        match &mut self.heavy {
            None => {
                self.put("\n")?;
                write_text(self.output, values)?;
            }
            Some(heavy) => {
                let name = format!("data{}", heavy.n_arrays);
                heavy.n_arrays += 1;
                // Chunks cannot be empty.
                let storage = if values.is_empty() { Storage::Plain } else { heavy.storage };
                heavy.root.array(&name, values.clone(), shape, storage);
                let place = format!("{}:/{name}", heavy.file);
                self.put(&place)?;
            }
        }
        self.put("</DataItem>\n")
    }
}

fn write_grid(mesh: &Mesh, sink: &mut Sink<'_, '_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, "XDMF", |kind| Topology::of(kind).is_some());
    let parts = parts(&mesh.cells);
    let (labels, _) = label_fields(&mesh);
    let places = parts.as_ref().and_then(|parts| places(parts, mesh.cells.len()));
    let cell_fields: Vec<&Field> = mesh.cell_data.iter().chain(&labels).chain(&places).collect();
    let (first, further) = match &parts {
        None => (cell_fields.into_iter().cloned().collect(), Vec::new()),
        Some(parts) => {
            let mut arrays = arrays_of(parts, &cell_fields).into_iter();
            (arrays.next().unwrap_or_default(), parts.iter().skip(1).zip(arrays).collect())
        }
    };
    sink.put("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"")?;
    sink.put(if further.is_empty() { ">\n" } else { " xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n" })?;
    sink.put("<Domain>\n<Grid Name=\"mesh\" GridType=\"Uniform\">\n")?;
    names(sink, &mesh.label_names, &mut lost)?;
    sink.put("<Geometry GeometryType=\"XYZ\">\n")?;
    sink.item(&Values::F64(mesh.points.as_flattened().to_vec()), &[mesh.points.len(), 3])?;
    sink.put("</Geometry>\n")?;
    match parts.as_deref() {
        Some([part, ..]) => uniform(sink, &mesh.cells, part)?,
        _ => topology(sink, &mesh.cells)?,
    }
    // The first array is the one that dolfinx takes for tags of the cells.
    arrays(sink, "Cell", first.iter(), &mut lost)?;
    arrays(sink, "Node", mesh.point_data.iter(), &mut lost)?;
    arrays(sink, "Grid", mesh.field_data.iter(), &mut lost)?;
    sink.put("</Grid>\n")?;
    for (part, fields) in further {
        sink.put(&format!("<Grid Name=\"{}\" GridType=\"Uniform\">\n", part.name))?;
        sink.put("<xi:include xpointer=\"xpointer(/Xdmf/Domain/Grid[@Name='mesh']/Geometry)\"/>\n")?;
        uniform(sink, &mesh.cells, part)?;
        arrays(sink, "Cell", fields.iter(), &mut lost)?;
        sink.put("</Grid>\n")?;
    }
    sink.put("</Domain>\n</Xdmf>\n")?;
    lost.dedup();
    Ok(lost)
}

/// Writes the names of labels as meshio reads them.
fn names(sink: &mut Sink<'_, '_>, names: &LabelNames, lost: &mut Vec<String>) -> Result<()> {
    let all = [(3, &names.regions), (2, &names.patches)];
    let mut maps = String::new();
    for (dim, (label, name)) in
        all.iter().flat_map(|(dim, names)| names.iter().map(move |entry| (dim, entry)))
    {
        let name = escape_attribute(name, lost);
        let _ = write!(maps, "<map key=\"{name}\" dim=\"{dim}\">{label}</map>");
    }
    if maps.is_empty() {
        return Ok(());
    }
    sink.put(&format!("<Information Name=\"Information\"><![CDATA[<main>{maps}</main>]]></Information>\n"))
}

/// Writes all cells: as rows of ids if they are of one kind with a fixed number of nodes, otherwise mixed.
fn topology(sink: &mut Sink<'_, '_>, cells: &Cells) -> Result<()> {
    let first = cells.kinds().first().copied().unwrap_or(CellKind::TETRA);
    if first.n_vertices().is_some() && cells.kinds().iter().all(|&kind| kind == first) {
        let part = Part { name: String::new(), kind: first, cells: (0..cells.len()).collect() };
        return uniform(sink, cells, &part);
    }
    sink.put(&format!("<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">\n", cells.len()))?;
    let numbers = mixed(cells);
    let n = numbers.len();
    sink.item(&Values::U32(numbers), &[n])?;
    sink.put("</Topology>\n")
}

/// Writes cells of one kind as rows of ids.
fn uniform(sink: &mut Sink<'_, '_>, cells: &Cells, part: &Part) -> Result<()> {
    let Some((topology, n_nodes)) = Topology::of(part.kind).zip(part.kind.n_vertices()) else {
        return Ok(());
    };
    let (name, n) = (topology.names[0], part.cells.len());
    sink.put(&format!(
        "<Topology TopologyType=\"{name}\" NumberOfElements=\"{n}\" NodesPerElement=\"{n_nodes}\">\n"
    ))?;
    let ids = part.cells.iter().flat_map(|&cell| cells.connectivity().list(cell)).map(|v| v.0);
    sink.item(&Values::U32(ids.collect()), &[n, n_nodes])?;
    sink.put("</Topology>\n")
}

/// For each cell the number of its topology, the number of its nodes if that varies, and its nodes.
fn mixed(cells: &Cells) -> Vec<u32> {
    let mut numbers = Vec::new();
    for (_, kind, vertices) in cells.iter() {
        let Some(topology) = Topology::of(kind) else { continue };
        numbers.push(topology.number);
        if topology.has_count() {
            numbers.push(vertices.len() as u32);
        }
        numbers.extend(vertices.iter().map(|v| v.0));
    }
    numbers
}

fn arrays<'f>(
    sink: &mut Sink<'_, '_>,
    center: &str,
    fields: impl Iterator<Item = &'f Field>,
    lost: &mut Vec<String>,
) -> Result<()> {
    let (fields, texts): (Vec<&Field>, Vec<&Field>) = fields.partition(|f| number_type(&f.values).is_some());
    for field in fields {
        let shape = match field.components {
            1 => "Scalar",
            3 => "Vector",
            6 => "Tensor6",
            9 => "Tensor",
            _ => "Matrix",
        };
        let name = escape_attribute(&field.name, lost);
        sink.put(&format!("<Attribute Name=\"{name}\" AttributeType=\"{shape}\" Center=\"{center}\">\n"))?;
        match field.components {
            1 => sink.item(&field.values, &[field.n_rows()])?,
            n => sink.item(&field.values, &[field.n_rows(), n])?,
        }
        sink.put("</Attribute>\n")?;
    }
    lost.extend(lost_arrays("XDMF", "text", texts));
    Ok(())
}

/// The name of a type of numbers and its size in bytes; `None` for texts.
fn number_type(values: &Values) -> Option<[&'static str; 2]> {
    Some(match values {
        Values::I8(_) => ["Int", "1"],
        Values::U8(_) => ["UInt", "1"],
        Values::I16(_) => ["Int", "2"],
        Values::U16(_) => ["UInt", "2"],
        Values::I32(_) => ["Int", "4"],
        Values::U32(_) => ["UInt", "4"],
        Values::I64(_) => ["Int", "8"],
        Values::U64(_) => ["UInt", "8"],
        Values::F32(_) => ["Float", "4"],
        Values::F64(_) => ["Float", "8"],
        Values::Text(_) => return None,
    })
}
