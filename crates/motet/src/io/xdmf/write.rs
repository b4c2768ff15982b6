//! Writes a uniform grid with the numbers as text.

use std::fmt::Write as _;

use bytemuck::cast_slice;

use super::kinds::Topology;
use crate::base::Result;
use crate::io::format::WriteOptions;
use crate::io::labels::label_fields;
use crate::io::output::{Output, write_all};
use crate::io::scalar::{write_lines, write_text};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::vtkxml::escape_attribute;
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Values};

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, "XDMF", |kind| Topology::of(kind).is_some());
    write_all(output, b"<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"mesh\" GridType=\"Uniform\">\n")?;
    names(output, &mesh.label_names, &mut lost)?;
    write_all(output, b"<Geometry GeometryType=\"XYZ\">\n")?;
    item(output, ["Float", "8"], &[mesh.points.len(), 3])?;
    write_lines(output, mesh.points.as_flattened())?;
    write_all(output, b"</DataItem>\n</Geometry>\n")?;
    topology(output, &mesh.cells)?;
    let (labels, _) = label_fields(&mesh);
    arrays(output, "Node", mesh.point_data.iter(), &mut lost)?;
    arrays(output, "Cell", mesh.cell_data.iter().chain(&labels), &mut lost)?;
    arrays(output, "Grid", mesh.field_data.iter(), &mut lost)?;
    write_all(output, b"</Grid>\n</Domain>\n</Xdmf>\n")?;
    Ok(lost)
}

/// Writes the names of labels as meshio reads them.
fn names(output: &mut Output<'_>, names: &LabelNames, lost: &mut Vec<String>) -> Result<()> {
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
    let text = format!("<Information Name=\"Information\"><![CDATA[<main>{maps}</main>]]></Information>\n");
    write_all(output, text.as_bytes())
}

/// Begins a data item of numbers of a type and size, of the given shape.
fn item(output: &mut Output<'_>, [kind, bytes]: [&str; 2], shape: &[usize]) -> Result<()> {
    let shape: Vec<String> = shape.iter().map(usize::to_string).collect();
    let dimensions = shape.join(" ");
    let tag = format!(
        "<DataItem Dimensions=\"{dimensions}\" NumberType=\"{kind}\" Precision=\"{bytes}\" Format=\"XML\">\n"
    );
    write_all(output, tag.as_bytes())
}

/// Writes the cells: as rows of ids if all are of one kind with a fixed number of nodes, otherwise mixed.
fn topology(output: &mut Output<'_>, cells: &Cells) -> Result<()> {
    let n = cells.len();
    let first = cells.kinds().first().copied().unwrap_or(CellKind::TETRA);
    let uniform = Topology::of(first).filter(|_| cells.kinds().iter().all(|&kind| kind == first));
    match uniform.zip(first.n_vertices()) {
        Some((topology, n_nodes)) => {
            let name = topology.names[0];
            let tag = format!(
                "<Topology TopologyType=\"{name}\" NumberOfElements=\"{n}\" NodesPerElement=\"{n_nodes}\">\n"
            );
            write_all(output, tag.as_bytes())?;
            item(output, ["UInt", "4"], &[n, n_nodes])?;
            write_lines::<u32>(output, cast_slice(cells.connectivity().items()))?;
        }
        None => {
            write_all(
                output,
                format!("<Topology TopologyType=\"Mixed\" NumberOfElements=\"{n}\">\n").as_bytes(),
            )?;
            let numbers = mixed(cells);
            item(output, ["UInt", "4"], &[numbers.len()])?;
            write_lines(output, &numbers)?;
        }
    }
    write_all(output, b"</DataItem>\n</Topology>\n")
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
    output: &mut Output<'_>,
    center: &str,
    fields: impl Iterator<Item = &'f Field>,
    lost: &mut Vec<String>,
) -> Result<()> {
    let mut texts = Vec::new();
    for field in fields {
        let Some(number_type) = number_type(&field.values) else {
            texts.push(field);
            continue;
        };
        let shape = match field.components {
            1 => "Scalar",
            3 => "Vector",
            6 => "Tensor6",
            9 => "Tensor",
            _ => "Matrix",
        };
        let name = escape_attribute(&field.name, lost);
        let tag = format!("<Attribute Name=\"{name}\" AttributeType=\"{shape}\" Center=\"{center}\">\n");
        write_all(output, tag.as_bytes())?;
        match field.components {
            1 => item(output, number_type, &[field.n_rows()])?,
            n => item(output, number_type, &[field.n_rows(), n])?,
        }
        write_text(output, &field.values)?;
        write_all(output, b"</DataItem>\n</Attribute>\n")?;
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
