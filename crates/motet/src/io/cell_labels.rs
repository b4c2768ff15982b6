//! One label per cell, for formats with a single label column.

use crate::io::select::lost_arrays;
use crate::mesh::{CellKind, Field, Labels, Mesh};

/// Arrays that may hold labels of curves and points.
const LOW_DIM_LABEL_ARRAYS: &[&str] =
    &["gmsh:physical", "medit:ref", "tetgen:ref", "su2:tag", "netgen:index", "nastran:ref", "elemTag"];

/// The label of each cell: its region or patch, or for curves and points the value of `gmsh:physical` or a
/// similar array; 0 where there is none, and where the label could only come from the array `except`.
pub(super) fn cell_labels(mesh: &Mesh, except: Option<&str>) -> Vec<i32> {
    let mut labels = vec![0; mesh.cells.len()];
    let low = LOW_DIM_LABEL_ARRAYS.iter().find_map(|name| int_column(mesh, name));
    let ids = |labels: Option<Labels>| labels.filter(|l| except != Some(l.array.as_str())).map(|l| l.ids);
    let sources = [(ids(mesh.regions()), &[3][..]), (ids(mesh.patches()), &[2]), (low, &[0, 1])];
    for (ids, dims) in sources {
        for ((label, kind), id) in labels.iter_mut().zip(mesh.cells.kinds()).zip(ids.into_iter().flatten()) {
            if dims.contains(&kind.dim().unwrap_or(0)) {
                *label = id;
            }
        }
    }
    labels
}

/// A cell array of integers that fit `i32`, if there is one with this name.
pub(super) fn int_column(mesh: &Mesh, name: &str) -> Option<Vec<i32>> {
    let field = mesh.cell_field(name).filter(|f| f.components == 1)?;
    field.values.to_i64()?.into_iter().map(|v| i32::try_from(v).ok()).collect()
}

/// Whether `labels` hold everything that a cell array holds.
pub(super) fn labels_cover(labels: &[i32], mesh: &Mesh, field: &Field) -> bool {
    let dim = match field.name.as_str() {
        "region" => Some(3),
        "patch" => Some(2),
        name if LOW_DIM_LABEL_ARRAYS.contains(&name) => None,
        _ => return false,
    };
    let expressed = |(&label, kind): (&i32, &CellKind)| {
        if dim.is_none() || kind.dim() == dim { label } else { 0 }
    };
    int_column(mesh, &field.name)
        .is_some_and(|values| labels.iter().zip(mesh.cells.kinds()).map(expressed).eq(values))
}

/// A message that lists the cell arrays with more information than `labels`.
pub(super) fn lost_cell_arrays(format: &str, mesh: &Mesh, labels: &[i32]) -> Option<String> {
    lost_arrays(format, "cell", mesh.cell_data.iter().filter(|f| !labels_cover(labels, mesh, f)))
}

/// A message that lists the names of labels, for formats without such names.
pub(super) fn lost_names(format: &str, mesh: &Mesh) -> Option<String> {
    let names = mesh.label_names.regions.values().chain(mesh.label_names.patches.values());
    let names: Vec<&str> = names.map(String::as_str).collect();
    (!names.is_empty())
        .then(|| format!("label names are not written ({format} has none): {}", names.join(", ")))
}
