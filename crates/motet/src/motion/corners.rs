//! The corners of every cell as tets: a cell is upright where all of them are.
//!
//! A tet is its own corner. In a cell of another kind each corner at which three
//! facets meet spans a tet with its three neighbours, and the sign of its volume is
//! that of the cell's Jacobian there (for a quadratic cell: of the linear cell
//! between its corners). Corners where more facets meet, such as a pyramid's tip,
//! have no such tet; they are left to the corners around them.

use crate::base::{CellId, Point, VertexId};
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Cells};

/// The corner tets of all volume cells, in the order of the cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct Corners {
    /// Positive where the cell stands upright.
    pub(crate) tets: Vec<[VertexId; 4]>,
    /// The cell of each.
    pub(crate) cells: Vec<CellId>,
    /// Whether the cell itself is that tet.
    pub(crate) is_cell: Vec<bool>,
}

impl Corners {
    /// The corners of the volume cells of `cells`.
    ///
    /// Files do not agree on how to number a wedge, and some number every tet the
    /// other way round: whatever most cells of a kind do counts as upright.
    pub(crate) fn of(cells: &Cells, points: &[Point]) -> Self {
        let mut corners = Self::with_capacity(cells.len());
        let facets = Facets::of(cells);
        let mut n_upright = [0i64; 256];
        for (cell, kind, vertices) in cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
            let first = corners.tets.len();
            if kind == CellKind::TETRA {
                corners.tets.push([vertices[0], vertices[1], vertices[2], vertices[3]]);
            } else {
                three_valent(&facets, cell, &mut corners.tets);
            }
            corners.cells.resize(corners.tets.len(), cell);
            corners.is_cell.resize(corners.tets.len(), kind == CellKind::TETRA);
            for tet in &mut corners.tets[first..] {
                let volume = crate::geometry::tet::volume_6(tet.map(|v| points[v.index()]));
                // Faces of a polyhedron may run either way round: each corner for itself.
                if kind == CellKind::POLYHEDRON && volume < 0.0 {
                    tet.swap(2, 3);
                }
                n_upright[kind.0 as usize] += i64::from(volume > 0.0) - i64::from(volume < 0.0);
            }
        }
        for (tet, cell) in corners.tets.iter_mut().zip(&corners.cells) {
            let kind = cells.kind(*cell);
            if kind != CellKind::POLYHEDRON && n_upright[kind.0 as usize] < 0 {
                tet.swap(2, 3);
            }
        }
        corners
    }

    fn with_capacity(n: usize) -> Self {
        let (tets, cells) = (Vec::with_capacity(n), Vec::with_capacity(n));
        Self { tets, cells, is_cell: Vec::with_capacity(n) }
    }

    pub(crate) fn len(&self) -> usize {
        self.tets.len()
    }
}

/// The tets at the corners of one cell where exactly three facets meet.
fn three_valent(facets: &Facets, cell: CellId, tets: &mut Vec<[VertexId; 4]>) {
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
