//! Cells of further grids on the same points, which dolfinx writes for tags of cells and of facets.

use std::collections::HashMap;

use super::grid::{Center, to_labels};
use crate::base::{VertexId, rising_list};
use crate::io::format::Notes;
use crate::io::scalar::append;
use crate::mesh::{Cells, Field, Mesh, Values};

/// Adds the cells of a further grid. Those that the mesh has get labels; others are appended with theirs.
pub(super) fn add_tags(mesh: &mut Mesh, cells: &Cells, fields: Vec<(Center, Field)>, notes: &Notes) {
    let Some(dim) = cells.dim() else { return };
    let is_tag = |(center, field): &(Center, Field)| *center == Center::Cell && field.components == 1;
    let tags = fields.into_iter().find(is_tag);
    let tags = tags.and_then(|(_, field)| Some((to_labels(&field.values)?, field.name)));
    let Some((tags, name)) = tags else {
        notes.add("cells of a further grid without an array of whole numbers are skipped");
        return;
    };
    let place_of: HashMap<Vec<VertexId>, usize> =
        mesh.cells.iter().map(|(cell, _, vertices)| (rising_list(vertices), cell.index())).collect();
    let array = match dim {
        3 => "region",
        2 => "patch",
        _ => name.as_str(),
    };
    let mut labels: Vec<i32> = mesh
        .cell_field(array)
        .and_then(|f| to_labels(&f.values))
        .unwrap_or_else(|| vec![0; mesh.cells.len()]);
    for ((_, kind, vertices), tag) in cells.iter().zip(tags) {
        match place_of.get(&rising_list(vertices)) {
            Some(&place) => labels[place] = tag,
            None => {
                mesh.cells.push(kind, vertices.iter().copied());
                labels.push(tag);
            }
        }
    }
    let n = mesh.cells.len();
    mesh.cell_data.iter_mut().for_each(|field| extend(field, n));
    mesh.set_cell_field(Field::scalars(array, labels));
}

/// Fills an array up to `n` rows with zeros.
pub(super) fn extend(field: &mut Field, n: usize) {
    let missing = n * field.components - field.values.len();
    let zeros = match &field.values {
        Values::Text(_) => Values::Text(vec![String::new(); missing]),
        Values::F32(_) => Values::F32(vec![0.0; missing]),
        Values::F64(_) => Values::F64(vec![0.0; missing]),
        Values::I8(_) => Values::I8(vec![0; missing]),
        Values::U8(_) => Values::U8(vec![0; missing]),
        Values::I16(_) => Values::I16(vec![0; missing]),
        Values::U16(_) => Values::U16(vec![0; missing]),
        Values::I32(_) => Values::I32(vec![0; missing]),
        Values::U32(_) => Values::U32(vec![0; missing]),
        Values::I64(_) => Values::I64(vec![0; missing]),
        Values::U64(_) => Values::U64(vec![0; missing]),
    };
    append(&mut field.values, zeros);
}
