//! The quadratic volume cells of a mesh, and the way each kind of them is numbered.

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
    /// Their cell ids, in rising order.
    pub cells: Vec<CellId>,
    kinds: Vec<CellKind>,
    nodes: Csr<VertexId>,
    /// For each, whether most cells of its kind are numbered opposite to VTK's convention.
    is_reversed: Vec<bool>,
}

/// The summary of the quadratic volume cells of a mesh.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CurvedSummary {
    /// Number of quadratic volume cells.
    pub cells: usize,
    /// The least scaled Jacobian: see [`LeastJacobian::scaled`].
    pub min_scaled_jacobian: f64,
    /// The cell with the least scaled Jacobian.
    pub worst_cell: CellId,
    /// The place of the least Jacobian in that cell.
    pub worst_at: Point,
}

impl CurvedCells {
    /// The quadratic volume cells among `cells`, with vertices at `points`.
    ///
    /// Files differ in how they number cells: the numbering of most cells of a kind, judged with straight
    /// edges, counts as upright.
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

    /// Number of quadratic volume cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are no quadratic volume cells.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Whether the `i`-th quadratic cell is upright, with the vertices of the mesh at `points`.
    pub fn is_upright(&self, i: usize, points: &[Point]) -> bool {
        is_upright(self.kinds[i], &places(self.nodes.list(i), points), self.is_reversed[i])
    }

    /// The least `det J` of the `i`-th quadratic cell, positive if it is upright; `None` if a coordinate is
    /// not finite, or if its scaled Jacobian is certainly not below `below`.
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
        // For most cells, the bound from their coefficients already shows that they are not the worst.
        (jacobian.scaled_bound() < below).then(|| jacobian.least())
    }

    /// The cell with the least scaled Jacobian among those of `run`, the first if there are several, and its
    /// least Jacobian.
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
    /// Summarises a mesh; `None` if it has no quadratic volume cell whose points are finite.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        let all = CurvedCells::of(&mesh.cells, &mesh.points);
        let (worst_cell, least) = all.worst(0..all.len(), &mesh.points)?;
        Some(Self { cells: all.len(), min_scaled_jacobian: least.scaled, worst_cell, worst_at: least.place })
    }
}

fn places(nodes: &[VertexId], points: &[Point]) -> Vec<Point> {
    nodes.iter().map(|v| points[v.index()]).collect()
}
