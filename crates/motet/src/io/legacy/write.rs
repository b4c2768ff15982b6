//! Writes a mesh as an unstructured grid to a legacy VTK file.

use std::borrow::Cow;

use crate::base::{Error, Result};
use crate::io::format::{Encoding, WriteOptions};
use crate::io::labels::label_fields;
use crate::io::legacy::arrays::{encode, encode_length};
use crate::io::output::{Output, write_all};
use crate::io::polyhedra::face_stream;
use crate::io::scalar::{write_big, write_big_values, write_lines, write_text};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

pub(super) fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let offsets = match options.version.as_deref() {
        None | Some("5.1") => true,
        Some("4.2") => false,
        Some(other) => {
            return Err(Error::options(format!("version {other} of legacy VTK cannot be written"))
                .remedy("choose 5.1 or 4.2"));
        }
    };
    let mut writer = Writer { output, ascii: options.encoding == Encoding::Ascii, offsets, lost: Vec::new() };
    let version = if offsets { "5.1" } else { "4.2" };
    let encoding = if writer.ascii { "ASCII" } else { "BINARY" };
    writer.line(&format!(
        "# vtk DataFile Version {version}\nwritten by motet\n{encoding}\nDATASET UNSTRUCTURED_GRID"
    ))?;
    let (label_cells, label_names) = label_fields(mesh);
    writer.fields(&mesh.field_data.iter().chain(&label_names).collect::<Vec<_>>())?;
    writer.line(&format!("POINTS {} double", mesh.points.len()))?;
    writer.each(mesh.points.as_flattened(), |x| x.to_be_bytes())?;
    if !mesh.cells.is_empty() {
        writer.cells(mesh)?;
    }
    writer.data(
        "CELL_DATA",
        mesh.cells.len(),
        &mesh.cell_data.iter().chain(&label_cells).collect::<Vec<_>>(),
    )?;
    writer.data("POINT_DATA", mesh.points.len(), &mesh.point_data.iter().collect::<Vec<_>>())?;
    Ok(writer.lost)
}

struct Writer<'a, 'o> {
    output: &'a mut Output<'o>,
    ascii: bool,
    /// Whether cells are written in the layout used since 5.0.
    offsets: bool,
    lost: Vec<String>,
}

impl Writer<'_, '_> {
    fn line(&mut self, text: &str) -> Result<()> {
        write_all(self.output, text.as_bytes())?;
        write_all(self.output, b"\n")
    }

    fn numbers(&mut self, values: &Values) -> Result<()> {
        match (values, self.ascii) {
            (Values::Text(texts), _) => texts.iter().try_for_each(|text| self.text(text))?,
            (_, true) => write_text(self.output, values)?,
            (_, false) => write_big_values(self.output, values)?,
        }
        write_all(self.output, b"\n")
    }

    /// Writes numbers as text, or the `bytes` of each.
    fn each<T: Copy + std::fmt::Debug + Sync, const N: usize>(
        &mut self,
        numbers: &[T],
        bytes: impl Fn(T) -> [u8; N] + Sync + Send,
    ) -> Result<()> {
        match self.ascii {
            true => write_lines(self.output, numbers)?,
            false => write_big(self.output, numbers, bytes)?,
        }
        write_all(self.output, b"\n")
    }

    fn text(&mut self, text: &str) -> Result<()> {
        if self.ascii {
            return self.line(&encode(text));
        }
        write_all(self.output, &encode_length(text.len()))?;
        write_all(self.output, text.as_bytes())
    }

    fn cells(&mut self, mesh: &Mesh) -> Result<()> {
        let [offsets, ids] = lists(&mesh.cells)?;
        let long = |id| i64::from(id).to_be_bytes();
        if self.offsets {
            self.line(&format!("CELLS {} {}\nOFFSETS vtktypeint64", offsets.len(), ids.len()))?;
            self.each::<u32, 8>(&offsets, long)?;
            self.line("CONNECTIVITY vtktypeint64")?;
            self.each::<u32, 8>(&ids, long)?;
        } else {
            let n = mesh.cells.len();
            self.line(&format!("CELLS {n} {}", ids.len() + n))?;
            let mut counted = Vec::with_capacity(ids.len() + n);
            for ends in offsets.windows(2) {
                counted.push(ends[1] - ends[0]);
                counted.extend(&ids[ends[0] as usize..ends[1] as usize]);
            }
            if counted.iter().any(|&id| i32::try_from(id).is_err()) {
                return Err(
                    Error::options("ids above 2^31 - 1 do not fit in version 4.2").remedy("choose 5.1")
                );
            }
            self.each(&counted, u32::to_be_bytes)?;
        }
        self.line(&format!("CELL_TYPES {}", mesh.cells.len()))?;
        let kinds: &[u8] = bytemuck::cast_slice(mesh.cells.kinds());
        self.each(kinds, |kind| i32::from(kind).to_be_bytes())
    }

    fn data(&mut self, section: &str, n: usize, fields: &[&Field]) -> Result<()> {
        if fields.is_empty() {
            return Ok(());
        }
        self.line(&format!("{section} {n}"))?;
        self.fields(fields)
    }

    fn fields(&mut self, fields: &[&Field]) -> Result<()> {
        if fields.is_empty() {
            return Ok(());
        }
        self.line(&format!("FIELD FieldData {}", fields.len()))?;
        for field in fields {
            let kind = type_name(&field.values, self.offsets);
            let (mut name, components) = (encode(&field.name), field.components);
            if name.is_empty() {
                name += "unnamed";
                self.lost.push("an array without a name is written as `unnamed`".into());
            }
            self.line(&format!("{name} {components} {} {kind}", field.n_rows()))?;
            self.numbers(&field.values)?;
        }
        Ok(())
    }
}

/// Where the list of each cell starts and the last ends, and all lists: vertices, or the face stream of a
/// polyhedron.
fn lists(cells: &Cells) -> Result<[Cow<'_, [u32]>; 2]> {
    let vertices = cells.connectivity();
    if cells.polyhedron_faces().is_empty() {
        let ids: &[u32] = bytemuck::cast_slice(vertices.items());
        return Ok([Cow::Borrowed(vertices.offsets()), Cow::Borrowed(ids)]);
    }
    let mut polyhedra = cells.polyhedron_faces().iter();
    let (mut offsets, mut ids) = (vec![0], Vec::new());
    for (_, kind, vertices) in cells.iter() {
        match kind {
            CellKind::POLYHEDRON => ids.extend(polyhedra.next().map(face_stream).unwrap_or_default()),
            _ => ids.extend(vertices.iter().map(|v| v.0)),
        }
        let end = u32::try_from(ids.len());
        offsets.push(end.map_err(|_| Error::input("the polyhedra have more faces than can be written"))?);
    }
    Ok([Cow::Owned(offsets), Cow::Owned(ids)])
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
