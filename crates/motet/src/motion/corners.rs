//! The corners of every cell as tets: a cell is upright where all of these are.
//!
//! A tet is its own corner. In a cell of another kind, each corner at which three facets meet spans a tet
//! with its three neighbours, and the sign of its volume is that of the cell's Jacobian there. Corners where
//! more facets meet, such as a pyramid's tip, have no such tet; the corners around them cover for them.
//! Corners of a quadratic cell are those of the linear cell with the same corners: they do not decide whether
//! it is upright, which [`mesh::curved`](crate::mesh::curved) does.

use crate::base::{CellId, VertexId};
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::curved::is_curved_kind;
use crate::mesh::{CellKind, Cells, OrientedTets};

/// The corner tets of all volume cells, in the order of the cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct CornerTets {
    /// Positive where the cell is upright.
    pub(crate) tets: Vec<[VertexId; 4]>,
    /// The cell of each corner.
    pub(crate) cells: Vec<CellId>,
    /// Whether the corner tet is the cell itself.
    pub(crate) is_cell: Vec<bool>,
    /// Whether the cell is quadratic.
    pub(crate) is_curved: Vec<bool>,
}

impl CornerTets {
    /// The corners of the volume cells of `cells`: linear tets as oriented in `tets`, others as they are
    /// numbered. [`Self::orient_upright`] has to follow.
    pub(crate) fn of(cells: &Cells, tets: &OrientedTets) -> Self {
        let mut oriented = tets.tets.iter();
        let mut corners = Self::with_capacity(cells.len());
        let facets = Facets::of(cells);
        for (cell, kind, _) in cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
            if kind == CellKind::TETRA {
                corners.tets.extend(oriented.next());
                corners.cells.push(cell);
                corners.is_cell.push(true);
                corners.is_curved.push(false);
            } else {
                corner_tets(&facets, cell, &mut corners.tets);
                corners.cells.resize(corners.tets.len(), cell);
                corners.is_cell.resize(corners.tets.len(), false);
                corners.is_curved.resize(corners.tets.len(), is_curved_kind(kind));
            }
        }
        corners
    }

    /// Turns corners so that positive means upright, given the sign of the volume of each; returns the
    /// indices of those that are not upright, in rising order.
    ///
    /// Tets are already oriented. Files do not agree on how to number a wedge: among cells of another kind,
    /// the orientation of the majority counts as upright. Faces of a polyhedron may run either way around:
    /// there each corner is judged by itself.
    pub(crate) fn orient_upright(&mut self, cells: &Cells, signs: &[i8]) -> Vec<u32> {
        let mut n_upright = [0i64; 256];
        for (cell, &sign) in self.cells.iter().zip(signs) {
            n_upright[cells.kind(*cell).0 as usize] += i64::from(sign);
        }
        let mut not_upright = Vec::new();
        for (i, (tet, (cell, &sign))) in (0..).zip(self.tets.iter_mut().zip(self.cells.iter().zip(signs))) {
            let kind = cells.kind(*cell);
            let side = match kind {
                CellKind::TETRA => 1,
                CellKind::POLYHEDRON => i64::from(sign),
                _ => n_upright[kind.0 as usize],
            };
            if side < 0 {
                tet.swap(2, 3);
            }
            let is_upright = if side < 0 { sign < 0 } else { sign > 0 };
            if !is_upright {
                not_upright.push(i);
            }
        }
        not_upright
    }

    fn with_capacity(n: usize) -> Self {
        let (tets, cells) = (Vec::with_capacity(n), Vec::with_capacity(n));
        Self { tets, cells, is_cell: Vec::with_capacity(n), is_curved: Vec::with_capacity(n) }
    }

    pub(crate) fn len(&self) -> usize {
        self.tets.len()
    }
}

/// The tets at the corners of one cell where exactly three facets meet.
fn corner_tets(facets: &Facets, cell: CellId, tets: &mut Vec<[VertexId; 4]>) {
    // (corner, the one before it in a facet's ring, the one after it)
    let mut wedges: Vec<[VertexId; 3]> = Vec::new();
    for local in 0..facets.count(cell) as u32 {
        let ring: Vec<VertexId> = facets.corners(FacetUse { cell, local }).collect();
        for i in 0..ring.len() {
            wedges.push([ring[i], ring[(i + ring.len() - 1) % ring.len()], ring[(i + 1) % ring.len()]]);
        }
    }
    wedges.sort_unstable();
    for around in wedges.chunk_by(|a, b| a[0] == b[0]) {
        if let [[corner, before, after], rest @ ..] = around
            && rest.len() == 2
            && let Some(third) = rest.iter().flat_map(|w| [w[1], w[2]]).find(|v| v != before && v != after)
        {
            tets.push([*corner, *before, *after, third]);
        }
    }
}
