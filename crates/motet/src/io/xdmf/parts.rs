//! Division of a mesh into grids of one kind of cells each, as dolfinx reads them.

use crate::io::scalar::native_bytes;
use crate::mesh::{CellKind, Cells, Field};

/// The cell array with the place of each cell in the mesh, where grids have the cells in another order.
pub(super) const PLACE: &str = "motet:cell";

/// The cells of one grid.
#[derive(Debug)]
pub(super) struct Part {
    /// The name of the grid.
    pub(super) name: String,
    /// The kind of all its cells.
    pub(super) kind: CellKind,
    /// The cells, by their places in the mesh.
    pub(super) cells: Vec<usize>,
}

/// One grid for the cells of the highest dimension, and one for each other kind; `None` if all cells are one
/// grid: where they are of one kind, those of the highest dimension are of several, or the number of nodes
/// varies.
pub(super) fn parts(cells: &Cells) -> Option<Vec<Part>> {
    let mut kinds: Vec<(CellKind, usize)> = Vec::new();
    for &kind in cells.kinds() {
        kind.n_vertices()?;
        if kinds.iter().all(|(known, _)| *known != kind) {
            kinds.push((kind, kind.dim()?));
        }
    }
    kinds.sort_by_key(|&(_, dim)| std::cmp::Reverse(dim));
    let [(_, most), (_, next), ..] = kinds[..] else { return None };
    if most == next {
        return None;
    }
    let mut parts: Vec<Part> = Vec::new();
    for (kind, dim) in kinds {
        let name = match dim {
            dim if dim == most => "mesh",
            dim if dim + 1 == most => "facet_tags",
            1 => "edge_tags",
            _ => "vertex_tags",
        };
        let n_alike = parts.iter().filter(|part| part.name.starts_with(name)).count();
        let name = if n_alike == 0 { name.to_owned() } else { format!("{name}_{}", n_alike + 1) };
        let of_kind = |&cell: &usize| cells.kinds()[cell] == kind;
        parts.push(Part { name, kind, cells: (0..cells.len()).filter(of_kind).collect() });
    }
    Some(parts)
}

/// The places of the cells, if the grids have them in another order than the mesh.
pub(super) fn places(parts: &[Part], n_cells: usize) -> Option<Field> {
    let order = parts.iter().flat_map(|part| part.cells.iter().copied());
    (!order.eq(0..n_cells)).then(|| Field::scalars(PLACE, (0..n_cells as u32).collect::<Vec<_>>()))
}

/// For each grid the rows of the arrays that it needs: all that are not zero there, and with the first those
/// that are zero everywhere. Labels come first, as dolfinx takes the first array for the tags.
pub(super) fn arrays_of(parts: &[Part], fields: &[&Field]) -> Vec<Vec<Field>> {
    let mut all: Vec<Vec<Field>> = parts.iter().map(|_| Vec::new()).collect();
    for field in fields {
        let rows: Vec<Field> = parts.iter().map(|part| field.pick(part.cells.iter().copied())).collect();
        let is_zero = |field: &Field| native_bytes(&field.values).iter().all(|&byte| byte == 0);
        let is_needed: Vec<bool> = rows.iter().map(|rows| !is_zero(rows)).collect();
        let none = !is_needed.contains(&true);
        for (i, rows) in rows.into_iter().enumerate() {
            if is_needed[i] || none && i == 0 {
                all[i].push(rows);
            }
        }
    }
    for (part, arrays) in parts.iter().zip(&mut all) {
        let labels = if part.kind.dim() == Some(3) { "region" } else { "patch" };
        arrays.sort_by_key(|f| match f.name.as_str() {
            name if name == labels => 0,
            PLACE => 3,
            _ if f.components == 1 && f.values.is_integer() => 1,
            _ => 2,
        });
    }
    all
}
