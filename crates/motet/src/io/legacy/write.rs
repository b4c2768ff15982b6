//! Writes a mesh as an unstructured grid to a legacy VTK file.

use std::io::Write as _;

use crate::base::{Error, Result};
use crate::io::format::{Encoding, WriteOptions, drain};
use crate::io::labels::label_fields;
use crate::io::legacy::arrays::{encode, encode_length};
use crate::io::polyhedra::face_stream;
use crate::io::scalar::{big_bytes, write_text};
use crate::mesh::{CellKind, Field, Mesh, Values};

pub(super) fn write(
    mesh: &Mesh,
    options: &WriteOptions,
    sink: &mut dyn std::io::Write,
) -> Result<Vec<String>> {
    let offsets = match options.version.as_deref() {
        None | Some("5.1") => true,
        Some("4.2") => false,
        Some(other) => {
            return Err(Error::options(format!("version {other} of legacy VTK cannot be written"))
                .remedy("choose 5.1 or 4.2"));
        }
    };
    let mut writer =
        Writer { out: Vec::new(), ascii: options.encoding == Encoding::Ascii, offsets, lost: Vec::new() };
    let version = if offsets { "5.1" } else { "4.2" };
    let encoding = if writer.ascii { "ASCII" } else { "BINARY" };
    writer.line(&format!(
        "# vtk DataFile Version {version}\nwritten by motet\n{encoding}\nDATASET UNSTRUCTURED_GRID"
    ));
    let (label_cells, label_names) = label_fields(mesh);
    writer.fields(&mesh.field_data.iter().chain(&label_names).collect::<Vec<_>>());
    writer.line(&format!("POINTS {} double", mesh.points.len()));
    writer.numbers(&Values::F64(mesh.points.as_flattened().to_vec()));
    drain(&mut writer.out, sink)?;
    if !mesh.cells.is_empty() {
        writer.cells(mesh)?;
    }
    drain(&mut writer.out, sink)?;
    writer.data(
        "CELL_DATA",
        mesh.cells.len(),
        &mesh.cell_data.iter().chain(&label_cells).collect::<Vec<_>>(),
    );
    writer.data("POINT_DATA", mesh.points.len(), &mesh.point_data.iter().collect::<Vec<_>>());
    drain(&mut writer.out, sink)?;
    Ok(writer.lost)
}

struct Writer {
    out: Vec<u8>,
    ascii: bool,
    /// Whether cells are written in the layout used since 5.0.
    offsets: bool,
    lost: Vec<String>,
}

impl Writer {
    fn line(&mut self, text: &str) {
        self.out.extend(text.as_bytes());
        self.out.push(b'\n');
    }

    fn numbers(&mut self, values: &Values) {
        match (values, self.ascii) {
            (Values::Text(texts), _) => texts.iter().for_each(|text| self.text(text)),
            (_, true) => write_text(&mut self.out, values),
            (_, false) => self.out.extend(&*big_bytes(values)),
        }
        self.out.push(b'\n');
    }

    fn text(&mut self, text: &str) {
        if self.ascii {
            self.line(&encode(text));
        } else {
            self.out.extend(encode_length(text.len()));
            self.out.extend(text.as_bytes());
        }
    }

    fn cells(&mut self, mesh: &Mesh) -> Result<()> {
        let lists = lists(mesh);
        let n_ids: usize = lists.iter().map(Vec::len).sum();
        if self.offsets {
            let mut ends = vec![0i64];
            ends.extend(lists.iter().scan(0, |end, list| {
                *end += list.len() as i64;
                Some(*end)
            }));
            self.line(&format!("CELLS {} {n_ids}\nOFFSETS vtktypeint64", ends.len()));
            self.numbers(&Values::I64(ends));
            self.line("CONNECTIVITY vtktypeint64");
            self.numbers(&Values::I64(lists.concat().into_iter().map(i64::from).collect()));
        } else {
            self.line(&format!("CELLS {} {}", lists.len(), n_ids + lists.len()));
            let counted =
                lists.iter().flat_map(|list| std::iter::once(list.len() as u32).chain(list.iter().copied()));
            let counted = counted.map(i32::try_from).collect::<Result<_, _>>();
            self.numbers(&Values::I32(counted.map_err(|_| {
                Error::options("ids above 2^31 - 1 do not fit in version 4.2").remedy("choose 5.1")
            })?));
        }
        self.line(&format!("CELL_TYPES {}", lists.len()));
        self.numbers(&Values::I32(mesh.cells.kinds().iter().map(|k| i32::from(k.0)).collect()));
        Ok(())
    }

    fn data(&mut self, section: &str, n: usize, fields: &[&Field]) {
        if !fields.is_empty() {
            self.line(&format!("{section} {n}"));
            self.fields(fields);
        }
    }

    fn fields(&mut self, fields: &[&Field]) {
        if fields.is_empty() {
            return;
        }
        self.line(&format!("FIELD FieldData {}", fields.len()));
        for field in fields {
            let kind = type_name(&field.values, self.offsets);
            let (mut name, components) = (encode(&field.name), field.components);
            if name.is_empty() {
                name += "unnamed";
                self.lost.push("an array without a name is written as `unnamed`".into());
            }
            writeln!(self.out, "{name} {components} {} {kind}", field.n_rows())
                .expect("writing into memory does not fail");
            self.numbers(&field.values);
        }
    }
}

/// The list of each cell: its vertices, or the face stream of a polyhedron.
fn lists(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut polyhedra = mesh.cells.polyhedron_faces().iter();
    let list = |(_, kind, vertices): (_, CellKind, &[crate::base::VertexId])| match kind {
        CellKind::POLYHEDRON => polyhedra.next().map(face_stream).unwrap_or_default(),
        _ => vertices.iter().map(|v| v.0).collect(),
    };
    mesh.cells.iter().map(list).collect()
}

/// VTK's name of a type. meshio accepts `long` only in files before 5.0, and `vtktypeint64` only in later
/// ones; VTK accepts both.
fn type_name(values: &Values, offsets: bool) -> &'static str {
    match values {
        Values::I64(_) if !offsets => "long",
        Values::U64(_) if !offsets => "unsigned_long",
        Values::I8(_) => "char",
        Values::U8(_) => "unsigned_char",
        Values::I16(_) => "short",
        Values::U16(_) => "unsigned_short",
        Values::I32(_) => "int",
        Values::U32(_) => "unsigned_int",
        Values::I64(_) => "vtktypeint64",
        Values::U64(_) => "vtktypeuint64",
        Values::F32(_) => "float",
        Values::F64(_) => "double",
        Values::Text(_) => "string",
    }
}
