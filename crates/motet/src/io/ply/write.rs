//! A mesh as a PLY file.

use std::io::Write as _;

use super::{NORMAL, NORMAL_ARRAY};
use crate::base::Result;
use crate::io::format::{Encoding, WriteOptions, Written};
use crate::io::select::{keep_cells, lost_arrays, surface_of};
use crate::mesh::{CellKind, Field, Mesh, Values};

const FITS: &str = "writing into memory does not fail";

pub(super) fn write(mesh: &Mesh, options: &WriteOptions) -> Result<Written> {
    let (surface, boundary_only) = surface_of(mesh, "PLY");
    let holds = |kind| matches!(kind, CellKind::TRIANGLE | CellKind::QUAD | CellKind::POLYGON);
    let (mesh, mut lost) = keep_cells(&surface, "PLY", holds);
    lost.extend(boundary_only);
    let unheld = |fields: &[Field]| {
        fields.iter().filter(|f| type_of(&f.values).is_none()).cloned().collect::<Vec<_>>()
    };
    lost.extend(lost_arrays("PLY", "point", &unheld(&mesh.point_data)).map(of_64_bits));
    lost.extend(lost_arrays("PLY", "cell", &unheld(&mesh.cell_data)).map(of_64_bits));
    lost.extend(lost_arrays("PLY", "field", &mesh.field_data));
    let regions: Vec<&str> = mesh.label_names.regions.values().map(String::as_str).collect();
    if !regions.is_empty() {
        lost.push(format!("PLY has no names of regions: {}", regions.join(", ")));
    }
    let held = |fields: &'_ [Field]| {
        fields.iter().filter(|f| type_of(&f.values).is_some()).cloned().collect::<Vec<_>>()
    };
    let (of_points, of_cells) = (held(&mesh.point_data), held(&mesh.cell_data));
    let is_text = options.encoding == Encoding::Ascii;
    let mut out = head(&mesh, [&of_points, &of_cells], is_text);
    let mut row = Row { out: &mut out, is_text, is_first: true };
    for (i, point) in mesh.points.iter().enumerate() {
        point.iter().for_each(|&x| row.f64(x));
        of_points.iter().for_each(|field| row.field(field, i));
        row.end();
    }
    for (cell, kind, vertices) in mesh.cells.iter() {
        debug_assert!(holds(kind));
        row.u32(vertices.len() as u32);
        vertices.iter().for_each(|v| row.u32(v.0));
        of_cells.iter().for_each(|field| row.field(field, cell.index()));
        row.end();
    }
    Ok(Written { files: vec![(String::new(), out)], lost })
}

fn of_64_bits(lost: String) -> String {
    format!("{lost} (of 64-bit whole numbers, or texts)")
}

/// The name of a type; `None` where PLY has none.
fn type_of(values: &Values) -> Option<&'static str> {
    Some(match values {
        Values::I8(_) => "char",
        Values::U8(_) => "uchar",
        Values::I16(_) => "short",
        Values::U16(_) => "ushort",
        Values::I32(_) => "int",
        Values::U32(_) => "uint",
        Values::F32(_) => "float",
        Values::F64(_) => "double",
        Values::I64(_) | Values::U64(_) | Values::Text(_) => return None,
    })
}

fn head(mesh: &Mesh, [of_points, of_cells]: [&[Field]; 2], is_text: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let order = if is_text { "ascii" } else { "binary_little_endian" };
    writeln!(out, "ply\nformat {order} 1.0").expect(FITS);
    for (id, name) in &mesh.label_names.patches {
        writeln!(out, "comment patch {id} {}", name.replace(['\n', '\r'], " ")).expect(FITS);
    }
    writeln!(out, "element vertex {}", mesh.points.len()).expect(FITS);
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}").expect(FITS);
    }
    of_points.iter().for_each(|field| property(&mut out, field));
    writeln!(out, "element face {}\nproperty list uint uint vertex_indices", mesh.cells.len()).expect(FITS);
    of_cells.iter().for_each(|field| property(&mut out, field));
    out.extend(b"end_header\n");
    out
}

/// A line for each component of an array.
fn property(out: &mut Vec<u8>, field: &Field) {
    let kind = type_of(&field.values).unwrap_or("double");
    let name = field.name.replace(|c: char| c.is_whitespace(), "_");
    let names: Vec<String> = match (field.components, name.as_str()) {
        (1, _) => vec![name],
        (3, NORMAL_ARRAY) => NORMAL.map(str::to_owned).into(),
        (n, _) => (0..n).map(|k| format!("{name}_{k}")).collect(),
    };
    names.iter().for_each(|name| writeln!(out, "property {kind} {name}").expect(FITS));
}

/// Numbers of a row, as text or as bytes.
struct Row<'a> {
    out: &'a mut Vec<u8>,
    is_text: bool,
    is_first: bool,
}

macro_rules! numbers {
    ($($name:ident($t:ty);)*) => {
        $(fn $name(&mut self, x: $t) {
            match self.is_text {
                true => {
                    let blank = if self.is_first { "" } else { " " };
                    write!(self.out, "{blank}{x:?}").expect(FITS);
                }
                false => self.out.extend(x.to_le_bytes()),
            }
            self.is_first = false;
        })*
    };
}

impl Row<'_> {
    numbers! {
        i8(i8);
        u8(u8);
        i16(i16);
        u16(u16);
        i32(i32);
        u32(u32);
        f32(f32);
        f64(f64);
    }

    fn field(&mut self, field: &Field, i: usize) {
        for k in i * field.components..(i + 1) * field.components {
            match &field.values {
                Values::I8(v) => self.i8(v[k]),
                Values::U8(v) => self.u8(v[k]),
                Values::I16(v) => self.i16(v[k]),
                Values::U16(v) => self.u16(v[k]),
                Values::I32(v) => self.i32(v[k]),
                Values::U32(v) => self.u32(v[k]),
                Values::F32(v) => self.f32(v[k]),
                Values::F64(v) => self.f64(v[k]),
                Values::I64(_) | Values::U64(_) | Values::Text(_) => {}
            }
        }
    }

    fn end(&mut self) {
        if self.is_text {
            self.out.push(b'\n');
        }
        self.is_first = true;
    }
}
