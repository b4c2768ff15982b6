//! Writes points and elements, and names of properties.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::kinds::{Element, order};
use super::names::comment;
use super::number::real;
use crate::base::Result;
use crate::io::cell_labels::{cell_labels, lost_cell_arrays};
use crate::io::format::WriteOptions;
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{LabelNames, Mesh};

const NAME: &str = "Nastran";

/// The largest number in a field of 8 characters.
const MAX_SHORT: usize = 99_999_999;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| Element::written_as(kind).is_some());
    let labels = cell_labels(&mesh, None);
    let properties = properties(&mesh, &labels, &mut lost);
    write_all(output, b"$ Mesh written by motet\nSOL 101\nCEND\nBEGIN BULK\n")?;
    write_all(output, names(&properties, &mesh.label_names, &mut lost).as_bytes())?;
    let n_rounded = AtomicUsize::new(0);
    output.rows(mesh.points.len(), |rows, mut out| {
        for i in rows {
            let [x, y, z] = mesh.points[i].map(|x| {
                let (text, is_same) = real(x);
                n_rounded.fetch_add(usize::from(!is_same), Ordering::Relaxed);
                text
            });
            let _ = writeln!(out, "GRID*   {:>16}{:16}{x:>16}{y:>16}*", i + 1, "");
            let _ = writeln!(out, "*       {z:>16}");
        }
        out
    })?;
    let is_short = mesh.points.len().max(mesh.cells.len()) <= MAX_SHORT
        && properties.values().all(|&property| property as usize <= MAX_SHORT);
    output.rows(mesh.cells.len(), |rows, mut out| {
        for i in rows {
            let dim = mesh.cells.kinds()[i].dim().unwrap_or(0);
            element(&mut out, &mesh, i, properties.get(&(dim, labels[i])).copied().unwrap_or(1), is_short);
        }
        out
    })?;
    write_all(output, b"ENDDATA\n")?;
    let n_rounded = n_rounded.into_inner();
    if n_rounded > 0 {
        lost.push(format!("{n_rounded} coordinates are rounded to the 16 characters of a field"));
    }
    lost.extend(lost_cell_arrays(NAME, &mesh, &labels));
    lost.extend(lost_arrays(NAME, "point", &mesh.point_data));
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
    Ok(lost)
}

/// The number of a property for each dimension and label.
type Properties = BTreeMap<(usize, i32), i32>;

/// Numbers of properties: positive, and each of cells of one dimension. Regions keep theirs first.
fn properties(mesh: &Mesh, labels: &[i32], lost: &mut Vec<String>) -> Properties {
    let all: BTreeSet<(Reverse<usize>, i32)> = mesh
        .cells
        .kinds()
        .iter()
        .zip(labels)
        .map(|(kind, &label)| (Reverse(kind.dim().unwrap_or(0)), label))
        .collect();
    let mut used: BTreeSet<i32> = BTreeSet::new();
    let mut properties = Properties::new();
    for &(Reverse(dim), label) in &all {
        if label > 0 && used.insert(label) {
            properties.insert((dim, label), label);
        }
    }
    for &(Reverse(dim), label) in &all {
        if properties.contains_key(&(dim, label)) {
            continue;
        }
        let free = (1..).find(|number| !used.contains(number)).unwrap_or_default();
        used.insert(free);
        properties.insert((dim, label), free);
        let what = match (dim, label) {
            (3, 0) => "volume cells without a region are".to_owned(),
            (2, 0) => "surface cells without a patch are".to_owned(),
            (_, 0) => "curves without a label are".to_owned(),
            (3, label) => format!("region {label} is"),
            (2, label) => format!("patch {label} is"),
            (_, label) => format!("label {label} of curves is"),
        };
        lost.push(format!("{what} written with property {free}"));
    }
    properties
}

fn names(properties: &Properties, names: &LabelNames, lost: &mut Vec<String>) -> String {
    let mut text = String::new();
    for (&(dim, label), &property) in properties {
        let name = match dim {
            3 => names.regions.get(&label),
            2 => names.patches.get(&label),
            _ => None,
        };
        if let Some(name) = name {
            text.push_str(&comment(property, name, lost));
        }
    }
    text
}

/// Writes a card: its name, number, property and nodes, in lines of 8 short or 4 long fields.
fn element(out: &mut Vec<u8>, mesh: &Mesh, cell: usize, property: i32, is_short: bool) {
    let kind = mesh.cells.kinds()[cell];
    let Some(element) = Element::written_as(kind) else { return };
    let vertices = mesh.cells.connectivity().list(cell);
    let node = |i: usize| vertices[order(kind).map_or(i, |order| order[i])].index() + 1;
    let fields: Vec<usize> =
        [cell + 1, property as usize].into_iter().chain((0..vertices.len()).map(node)).collect();
    let (star, n_fields) = if is_short { ("", 8) } else { ("*", 4) };
    for (i, line) in fields.chunks(n_fields).enumerate() {
        let name = match i {
            0 => format!("{}{star}", element.names[0]),
            _ if is_short => "+".to_owned(),
            _ => "*".to_owned(),
        };
        let _ = write!(out, "{name:<8}");
        line.iter().for_each(|field| {
            let _ = if is_short { write!(out, "{field:8}") } else { write!(out, "{field:16}") };
        });
        if (i + 1) * n_fields < fields.len() {
            out.push(if is_short { b'+' } else { b'*' });
        }
        out.push(b'\n');
    }
}
