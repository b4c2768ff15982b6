//! Writes points, elements, and directions if there are any.

use std::io::Write as _;

use super::{DIRECTIONS, TYPES};
use crate::base::{Result, Threads, VertexId};
use crate::io::cell_labels::{cell_labels, labels_cover, lost_names};
use crate::io::format::{WriteOptions, Written};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::{push_float, push_floats};
use crate::mesh::{CellKind, Field, Mesh, Values};

const NAME: &str = "openCARP";

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, threads: &Threads) -> Result<Written> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| TYPES.iter().any(|(_, known, _)| *known == kind));
    let labels = cell_labels(&mesh, None);
    let directions = directions(&mesh);
    let mut files = vec![(".pts".to_owned(), points_file(&mesh, threads)?)];
    files.push((".elem".to_owned(), elements_file(&mesh, &labels, threads)?));
    if !directions.is_empty() {
        files.push((".lon".to_owned(), directions_file(&mesh, &directions, threads)?));
    }
    let is_direction = |f: &Field| directions.iter().any(|d| d.name == f.name);
    let other = mesh.cell_data.iter().filter(|f| !is_direction(f) && !labels_cover(&labels, &mesh, f));
    lost.extend(lost_arrays(NAME, "cell", other));
    lost.extend(lost_arrays(NAME, "point", &mesh.point_data));
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
    lost.extend(lost_names(NAME, &mesh));
    if directions.iter().any(|f| matches!(f.values, Values::F32(_))) {
        lost.push("directions are converted to double precision".into());
    }
    Ok(Written { files, lost })
}

/// The arrays of directions: `fiber`, and `sheet` if there is `fiber`.
fn directions(mesh: &Mesh) -> Vec<&Field> {
    let real = |f: &&Field| f.components == 3 && matches!(f.values, Values::F32(_) | Values::F64(_));
    DIRECTIONS.iter().map_while(|name| mesh.cell_field(name).filter(real)).collect()
}

fn points_file(mesh: &Mesh, threads: &Threads) -> Result<Vec<u8>> {
    in_memory(threads, &mesh.points.len().to_string(), mesh.points.len(), |out, i| {
        push_floats(out, &mesh.points[i]);
    })
}

fn elements_file(mesh: &Mesh, labels: &[i32], threads: &Threads) -> Result<Vec<u8>> {
    in_memory(threads, &mesh.cells.len().to_string(), mesh.cells.len(), |out, i| {
        let (name, order) = type_of(mesh.cells.kinds()[i]);
        let mut theirs = [VertexId::default(); 8];
        order.iter().zip(mesh.cells.connectivity().list(i)).for_each(|(&place, &v)| theirs[place] = v);
        out.extend(name.as_bytes());
        theirs[..order.len()].iter().for_each(|v| {
            let _ = write!(out, " {v}");
        });
        let _ = write!(out, " {}", labels[i]);
    })
}

fn type_of(kind: CellKind) -> (&'static str, &'static [usize]) {
    TYPES.iter().find(|(_, known, _)| *known == kind).map_or(("", &[]), |&(name, _, order)| (name, order))
}

fn directions_file(mesh: &Mesh, directions: &[&Field], threads: &Threads) -> Result<Vec<u8>> {
    in_memory(threads, &directions.len().to_string(), mesh.cells.len(), |out, i| {
        for (k, field) in directions.iter().enumerate() {
            for axis in 0..3 {
                if k + axis > 0 {
                    out.push(b' ');
                }
                push_float(out, field.values.get_f64(3 * i + axis).unwrap_or(f64::NAN));
            }
        }
    })
}

/// A first line, then `n` lines that `line` appends.
fn in_memory(
    threads: &Threads,
    first: &str,
    n: usize,
    line: impl Fn(&mut Vec<u8>, usize) + Sync + Send,
) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut output = Output::to_memory(&mut bytes, threads);
    write_all(&mut output, format!("{first}\n").as_bytes())?;
    output.rows(n, |rows, mut out| {
        for i in rows {
            line(&mut out, i);
            out.push(b'\n');
        }
        out
    })?;
    Ok(bytes)
}
