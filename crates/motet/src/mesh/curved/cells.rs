//! The quadratic cells of a mesh, and which way round each kind of them is numbered.

use serde::Serialize;

use crate::base::{CellId, Csr, Point, VertexId};
use crate::geometry::vector::in_range;
use crate::mesh::curved::jacobian::{
    Jacobian, LeastJacobian, is_upright, least_of_straight_tet, straight_sign,
};
use crate::mesh::curved::tables::is_curved_kind;
use crate::mesh::{CellKind, Cells, Mesh};

/// The quadratic volume cells of a mesh.
#[derive(Clone, Debug, Default)]
pub struct CurvedCells {
    /// The cell of each, rising.
    pub cells: Vec<CellId>,
    kinds: Vec<CellKind>,
    nodes: Csr<VertexId>,
    /// Whether it is of a kind most of whose cells are numbered the other way round.
    is_reversed: Vec<bool>,
}

/// What the quadratic cells of a mesh come to.
#[derive(Clone, Debug, Serialize)]
pub struct CurvedSummary {
    /// How many there are.
    pub cells: usize,
    /// The least scaled Jacobian: see [`LeastJacobian::scaled`].
    pub min_scaled_jacobian: f64,
    /// The cell that has it.
    pub worst_cell: CellId,
    /// Where it has it.
    pub worst_at: Point,
}

impl CurvedCells {
    /// Those of `cells`, whose vertices are at `points`.
    ///
    /// Files do not agree on how to number cells: whatever most cells of a kind do counts as upright, as their straight cells show it.
    pub fn of(cells: &Cells, points: &[Point]) -> Self {
        let mut all = Self::default();
        let mut n_upright = [0i64; 256];
        for (cell, kind, nodes) in cells.iter().filter(|(_, kind, _)| is_curved_kind(*kind)) {
            all.cells.push(cell);
            all.kinds.push(kind);
            all.nodes.push(nodes.iter().copied());
            n_upright[kind.0 as usize] += straight_sign(kind, &places(nodes, points));
        }
        all.is_reversed = all.kinds.iter().map(|kind| n_upright[kind.0 as usize] < 0).collect();
        all
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Whether the `i`-th of them stands upright with the vertices of the mesh at `points`.
    pub fn is_upright(&self, i: usize, points: &[Point]) -> bool {
        is_upright(self.kinds[i], &places(self.nodes.list(i), points), self.is_reversed[i])
    }

    /// The least `det J` of the `i`-th of them, positive where it stands upright; `None` where a coordinate is not finite, and where its scaled Jacobian is surely not below
    /// `below`.
    pub fn least(&self, i: usize, points: &[Point], below: f64) -> Option<LeastJacobian> {
        let (kind, nodes) = (self.kinds[i], places(self.nodes.list(i), points));
        if !nodes.iter().all(|&p| in_range(p)) {
            return None;
        }
        if let Some(straight) = least_of_straight_tet(kind, &nodes, self.is_reversed[i]) {
            return Some(straight);
        }
        let jacobian = Jacobian::of(kind, &nodes)?;
        let jacobian = if self.is_reversed[i] { jacobian.reversed() } else { jacobian };
        // Most cells are far from the worst, and their coefficients say so.
        (jacobian.scaled_bound() < below).then(|| jacobian.least())
    }

    /// The one of `run` with the least scaled Jacobian, of equal ones the first: its cell, and what it has.
    pub fn worst(&self, run: std::ops::Range<usize>, points: &[Point]) -> Option<(CellId, LeastJacobian)> {
        let mut worst: Option<(CellId, LeastJacobian)> = None;
        for i in run {
            let below = worst.map_or(f64::INFINITY, |(_, worst)| worst.scaled);
            if let Some(least) = self.least(i, points, below).filter(|least| least.scaled < below) {
                worst = Some((self.cells[i], least));
            }
        }
        worst
    }
}

impl CurvedSummary {
    /// Of a mesh; `None` where it has no quadratic volume cell whose points are finite.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        let all = CurvedCells::of(&mesh.cells, &mesh.points);
        let (worst_cell, least) = all.worst(0..all.len(), &mesh.points)?;
        Some(Self { cells: all.len(), min_scaled_jacobian: least.scaled, worst_cell, worst_at: least.place })
    }
}

fn places(nodes: &[VertexId], points: &[Point]) -> Vec<Point> {
    nodes.iter().map(|v| points[v.index()]).collect()
}
