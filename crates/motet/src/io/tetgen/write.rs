//! Writes TetGen's files: nodes, elements, and the triangles and edges with labels of their own.

use std::io::Write as _;

use super::EDGE_NODES;
use crate::base::{Result, Threads, VertexId};
use crate::io::cell_labels::{cell_labels, labels_cover, lost_names};
use crate::io::format::{WriteOptions, Written};
use crate::io::node_order::vtk_to_other;
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::push_float;
use crate::mesh::{CellKind, Field, Mesh, Values};

/// Writes `.node`, `.ele` and `.face`, and `.edge` if there are edges.
pub(super) fn write(mesh: &Mesh, _: &WriteOptions, _: &Threads) -> Result<Written> {
    let n_tets = |kind| mesh.cells.kinds().iter().filter(|k| **k == kind).count();
    let quadratic = n_tets(CellKind::TETRA) == 0 && n_tets(CellKind::QUADRATIC_TETRA) > 0;
    let tetra = if quadratic { CellKind::QUADRATIC_TETRA } else { CellKind::TETRA };
    let (mesh, mut lost) = keep_cells(mesh, "TetGen", |kind| {
        kind == tetra || kind == CellKind::TRIANGLE || kind == CellKind::LINE
    });
    let labels = cell_labels(&mesh, None);
    lost.extend(lost_names("TetGen", &mesh));
    lost.extend(lost_arrays("TetGen", "field", &mesh.field_data));
    let rank = |kind: &CellKind| [tetra, CellKind::TRIANGLE, CellKind::LINE].iter().position(|k| k == kind);
    if !mesh.cells.kinds().is_sorted_by_key(rank) {
        lost.push("the order of the cells is not kept: TetGen groups cells by kind".into());
    }
    let mut files = vec![(".node".to_owned(), node_file(&mesh, &mut lost))];
    files.push((".ele".to_owned(), ele_file(&mesh, tetra, &labels, &mut lost)));
    files.push((".face".to_owned(), side_file(&mesh, CellKind::TRIANGLE, &labels)));
    if mesh.cells.kinds().contains(&CellKind::LINE) {
        files.push((".edge".to_owned(), side_file(&mesh, CellKind::LINE, &labels)));
    }
    Ok(Written { files, lost })
}

fn node_file(mesh: &Mesh, lost: &mut Vec<String>) -> Vec<u8> {
    let markers = ["tetgen:ref", "medit:ref"].iter().find_map(|name| mesh.point_field(name));
    let markers = markers.filter(|f| f.components == 1 && f.values.to_i64().is_some());
    let (kept, other): (Vec<&Field>, Vec<&Field>) = mesh
        .point_data
        .iter()
        .filter(|f| markers.is_none_or(|m| m.name != f.name))
        .partition(|f| !matches!(f.values, Values::Text(_)));
    lost.extend(lost_arrays("TetGen", "text", other));
    lost.extend(renamed_arrays("point", &kept, |f| f.name.starts_with("tetgen:")));
    let n_attributes: usize = kept.iter().map(|f| f.components).sum();
    let mut out = Vec::new();
    line(&mut out, format_args!("{} 3 {n_attributes} {}", mesh.points.len(), usize::from(markers.is_some())));
    for (i, point) in mesh.points.iter().enumerate() {
        put(&mut out, i);
        point.iter().for_each(|&x| put_float(&mut out, x));
        for field in &kept {
            (0..field.components).for_each(|k| put_value(&mut out, field, i * field.components + k));
        }
        if let Some(markers) = markers {
            put_value(&mut out, markers, i);
        }
        out.push(b'\n');
    }
    out
}

/// The element file; the first attribute is the region, integer arrays follow.
fn ele_file(mesh: &Mesh, tetra: CellKind, labels: &[i32], lost: &mut Vec<String>) -> Vec<u8> {
    let (kept, other): (Vec<&Field>, Vec<&Field>) = mesh
        .cell_data
        .iter()
        .filter(|f| !labels_cover(labels, mesh, f))
        .partition(|f| f.values.is_integer() && mesh.cells.kinds().contains(&tetra));
    lost.extend(lost_arrays("TetGen", "cell", other));
    lost.extend(renamed_arrays("cell", &kept, |f| f.name.starts_with("tetgen:")));
    let places = places_of(mesh, tetra);
    let labelled = !kept.is_empty() || places.iter().any(|&i| labels[i] != 0);
    let n_attributes = usize::from(labelled) + kept.iter().map(|f| f.components).sum::<usize>();
    let n_nodes = tetra.n_vertices().unwrap_or(4);
    let order = vtk_to_other(tetra, n_nodes, EDGE_NODES);
    let mut out = Vec::new();
    line(&mut out, format_args!("{} {n_nodes} {n_attributes}", places.len()));
    let mut theirs = vec![VertexId::default(); n_nodes];
    for (number, &i) in places.iter().enumerate() {
        put(&mut out, number);
        order.iter().zip(mesh.cells.connectivity().list(i)).for_each(|(&place, &v)| theirs[place] = v);
        theirs.iter().for_each(|v| put(&mut out, v));
        if labelled {
            put(&mut out, labels[i]);
        }
        for field in &kept {
            (0..field.components).for_each(|k| put_value(&mut out, field, i * field.components + k));
        }
        out.push(b'\n');
    }
    out
}

fn side_file(mesh: &Mesh, kind: CellKind, labels: &[i32]) -> Vec<u8> {
    let places = places_of(mesh, kind);
    let marked = places.iter().any(|&i| labels[i] != 0);
    let mut out = Vec::new();
    line(&mut out, format_args!("{} {}", places.len(), usize::from(marked)));
    for (number, &i) in places.iter().enumerate() {
        put(&mut out, number);
        mesh.cells.connectivity().list(i).iter().for_each(|v| put(&mut out, v));
        if marked {
            put(&mut out, labels[i]);
        }
        out.push(b'\n');
    }
    out
}

fn places_of(mesh: &Mesh, kind: CellKind) -> Vec<usize> {
    (0..mesh.cells.len()).filter(|&i| mesh.cells.kinds()[i] == kind).collect()
}

/// A message about arrays that keep their values but not their names.
fn renamed_arrays(what: &str, fields: &[&Field], keeps_name: impl Fn(&Field) -> bool) -> Option<String> {
    let names: Vec<&str> = fields.iter().filter(|f| !keeps_name(f)).map(|f| f.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "{what} arrays are written as numbered attributes (TetGen has no array names): {}",
            names.join(", ")
        )
    })
}

fn line(out: &mut Vec<u8>, content: impl std::fmt::Display) {
    writeln!(out, "{content}").expect("writing into memory does not fail");
}

fn put(out: &mut Vec<u8>, content: impl std::fmt::Display) {
    if out.last().is_some_and(|b| *b != b'\n') {
        out.push(b' ');
    }
    write!(out, "{content}").expect("writing into memory does not fail");
}

fn put_float(out: &mut Vec<u8>, x: f64) {
    out.push(b' ');
    push_float(out, x);
}

fn put_value(out: &mut Vec<u8>, field: &Field, i: usize) {
    match &field.values {
        Values::I64(v) => put(out, v[i]),
        Values::U64(v) => put(out, v[i]),
        values if values.is_integer() => put(out, values.get_f64(i).unwrap_or_default()),
        values => put_float(out, values.get_f64(i).unwrap_or(f64::NAN)),
    }
}
