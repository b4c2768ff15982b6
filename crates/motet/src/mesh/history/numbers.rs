//! Arrays that number points and cells: a new one must not get the number of another.

use crate::base::{CellId, VertexId};
use crate::mesh::{CellKind, Field, Mesh, Values};

/// SimVascular's arrays that number points and cells.
const NODE_ID: &str = "GlobalNodeID";
const ELEMENT_ID: &str = "GlobalElementID";
/// The cell array that records which tets were refined from the same one; -1 where that is not known.
pub const REFINE_ROOT: &str = "refine_root";

/// Whether a cell array gives every cell a number of its own.
pub(crate) fn numbers_cells(array: &str) -> bool {
    array == ELEMENT_ID
}

/// Gives new points and new tets numbers of their own, after the largest in use, and sets the [`REFINE_ROOT`]
/// of new tets to -1. Both lists are in rising order.
pub fn number_anew(mesh: &mut Mesh, new_points: &[VertexId], new_cells: &[CellId]) {
    let is_named = |field: &&mut Field, name: &str| field.name == name && field.components == 1;
    let is_tet = |c: &usize| mesh.cells.kinds()[*c] == CellKind::TETRA;
    let new_tets: Vec<usize> = new_cells.iter().map(|cell| cell.index()).filter(is_tet).collect();
    if let Some(ids) = mesh.point_data.iter_mut().find(|f| is_named(f, NODE_ID)) {
        number(&mut ids.values, new_points.iter().map(|v| v.index()));
    }
    if let Some(ids) = mesh.cell_data.iter_mut().find(|f| is_named(f, ELEMENT_ID)) {
        number(&mut ids.values, new_tets.iter().copied());
    }
    if let Some(Values::I32(roots)) =
        mesh.cell_data.iter_mut().find(|f| is_named(f, REFINE_ROOT)).map(|field| &mut field.values)
    {
        new_tets.iter().for_each(|&c| roots[c] = -1);
    }
}

fn number(ids: &mut Values, rows: impl Iterator<Item = usize>) {
    macro_rules! number {
        ($($variant:ident)*) => {
            match ids {
                $(Values::$variant(ids) => {
                    let mut largest = ids.iter().copied().max().unwrap_or_default();
                    for row in rows {
                        largest = largest.saturating_add(1);
                        ids[row] = largest;
                    }
                })*
                _ => {}
            }
        };
    }
    number!(I32 U32 I64 U64);
}
