//! Cells of further grids on the same points, such as those of facets with their tags.

use std::collections::HashMap;

use super::grid::{Center, to_labels};
use super::parts::PLACE;
use crate::base::{VertexId, rising_list};
use crate::io::format::Notes;
use crate::io::scalar::{append, select_rows};
use crate::mesh::{Cells, Field, Mesh, Values};

/// Adds the cells of the further grid `name` with their arrays. Those that the mesh has get the values;
/// others are appended. The array with the name of the grid is dolfinx's tags, and becomes `region` or
/// `patch`.
pub(super) fn add_cells(
    mesh: &mut Mesh,
    name: &str,
    cells: &Cells,
    fields: Vec<(Center, Field)>,
    notes: &Notes,
) {
    let n_old = mesh.cells.len();
    let sources = push_cells(mesh, cells);
    let n = mesh.cells.len();
    for (center, mut field) in fields {
        match center {
            Center::Node => {
                mesh.set_point_field(field);
                continue;
            }
            Center::Grid => {
                mesh.field_data.push(field);
                continue;
            }
            Center::Cell => {}
        }
        if field.name == name && field.components == 1 {
            to_label_array(&mut field, cells.dim());
        }
        let own = mesh.cell_data.iter().position(|f| f.name == field.name);
        let mut all = match own {
            Some(own) => mesh.cell_data[own].clone(),
            None => Field { values: zeros(&field.values, 0), ..field.clone() },
        };
        // An array that the grid has twice is already extended.
        let is_alike = all.components == field.components && all.values.len() <= n_old * all.components;
        if is_alike {
            extend(&mut all, n_old);
        }
        if !is_alike || !append(&mut all.values, field.values) {
            notes.add(format!(
                "array {} of grid {name} is skipped: there is another of this name",
                field.name
            ));
            continue;
        }
        all.values = select_rows(&all.values, all.components, &sources);
        mesh.set_cell_field(all);
    }
    mesh.cell_data.iter_mut().for_each(|field| extend(field, n));
}

/// Appends cells that the mesh does not have. Returns for each cell of the mesh the row of its values in an
/// array of the old cells and then those added.
fn push_cells(mesh: &mut Mesh, cells: &Cells) -> Vec<usize> {
    let n_old = mesh.cells.len();
    let mut sources: Vec<usize> = (0..n_old).collect();
    let dims: Vec<_> = cells.counts().iter().map(|(kind, _)| kind.dim()).collect();
    let known = mesh.cells.iter().filter(|(_, kind, _)| dims.contains(&kind.dim()));
    let place_of: HashMap<(_, Vec<VertexId>), usize> =
        known.map(|(cell, kind, vertices)| ((kind.dim(), rising_list(vertices)), cell.index())).collect();
    for (i, (_, kind, vertices)) in cells.iter().enumerate() {
        match place_of.get(&(kind.dim(), rising_list(vertices))) {
            Some(&place) => sources[place] = n_old + i,
            None => {
                mesh.cells.push(kind, vertices.iter().copied());
                sources.push(n_old + i);
            }
        }
    }
    sources
}

/// Makes labels of tags, if they are whole numbers.
fn to_label_array(field: &mut Field, dim: Option<usize>) {
    let array = match dim {
        Some(3) => "region",
        Some(2) => "patch",
        _ => return,
    };
    if let Some(labels) = to_labels(&field.values) {
        *field = Field::scalars(array, labels);
    }
}

/// Puts cells back into the order that the file states, if it does.
pub(super) fn put_in_order(mesh: &mut Mesh) {
    let Some(own) = mesh.cell_data.iter().position(|f| f.name == PLACE && f.components == 1) else { return };
    let n = mesh.cells.len();
    let mut rows = vec![n; n];
    for (row, place) in mesh.cell_data[own].values.to_i64().unwrap_or_default().into_iter().enumerate() {
        match usize::try_from(place).ok().and_then(|place| rows.get_mut(place)) {
            Some(slot) if *slot == n => *slot = row,
            _ => return,
        }
    }
    if rows.contains(&n) {
        return;
    }
    let mut cells = Cells::new();
    for &row in &rows {
        cells.push(mesh.cells.kinds()[row], mesh.cells.connectivity().list(row).iter().copied());
    }
    mesh.cells = cells;
    mesh.cell_data.remove(own);
    mesh.cell_data.iter_mut().for_each(|field| *field = field.pick(rows.iter().copied()));
}

/// Fills an array up to `n` rows with zeros.
pub(super) fn extend(field: &mut Field, n: usize) {
    let missing = n * field.components - field.values.len();
    let zeros = zeros(&field.values, missing);
    append(&mut field.values, zeros);
}

/// `n` zeros of the type of `like`.
fn zeros(like: &Values, n: usize) -> Values {
    match like {
        Values::Text(_) => Values::Text(vec![String::new(); n]),
        Values::F32(_) => Values::F32(vec![0.0; n]),
        Values::F64(_) => Values::F64(vec![0.0; n]),
        Values::I8(_) => Values::I8(vec![0; n]),
        Values::U8(_) => Values::U8(vec![0; n]),
        Values::I16(_) => Values::I16(vec![0; n]),
        Values::U16(_) => Values::U16(vec![0; n]),
        Values::I32(_) => Values::I32(vec![0; n]),
        Values::U32(_) => Values::U32(vec![0; n]),
        Values::I64(_) => Values::I64(vec![0; n]),
        Values::U64(_) => Values::U64(vec![0; n]),
    }
}
