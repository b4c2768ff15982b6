//! Which cells a motion has inverted, relative to the reference: linear ones by exact signs at their corners,
//! quadratic ones by bounds of the determinant of their Jacobian.

use std::sync::Arc;

use crate::base::{CellId, Point, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::volume_6;
use crate::mesh::curved::CurvedCells;
use crate::mesh::{Mesh, OrientedTets};
use crate::motion::corners::CornerTets;

/// The corners of the cells, the quadratic cells, and which of both were inverted or flat from the start.
///
/// A mesh may have inverted cells from the start. They are counted and reported, but do not stop a motion,
/// which has to keep upright only what was upright.
#[derive(Debug, Default)]
pub(crate) struct Check {
    pub(crate) corners: CornerTets,
    /// The linear tets, which identify layers among those of low quality.
    pub(crate) tets: Arc<OrientedTets>,
    pub(crate) curved: CurvedCells,
    /// What was inverted or flat in the reference.
    before: Inverted,
}

/// Inverted or flat corners and cells, in rising order.
#[derive(Debug, Default)]
struct Inverted {
    /// Corners of linear cells.
    corners: Vec<u32>,
    /// Quadratic cells, as indices into the list of those.
    curved: Vec<u32>,
}

/// Corners per chunk.
const CHUNK: usize = 1 << 14;

impl Check {
    pub(crate) fn new(mesh: &Mesh, tets: Arc<OrientedTets>, threads: &Threads) -> Self {
        let (cells, points) = (&mesh.cells, &mesh.points);
        let mut corners = CornerTets::of(cells, &tets);
        let signs = threads.map(corners.len(), |i| orientation(corners.tets[i], points));
        let mut before = corners.orient_upright(cells, &signs);
        before.retain(|&i| !corners.is_curved[i as usize]);
        let curved = CurvedCells::of(cells, points);
        let mut check = Self { corners, tets, curved, before: Inverted::default() };
        check.before = Inverted { corners: before, curved: check.curved_not_upright(points, threads) };
        check
    }

    /// All that is inverted or flat.
    fn not_upright(&self, points: &[Point], threads: &Threads) -> Inverted {
        let is_curved = &self.corners.is_curved;
        Inverted {
            corners: self.collect(threads, |i, tet| !is_curved[i as usize] && !is_upright(tet, points)),
            curved: self.curved_not_upright(points, threads),
        }
    }

    fn curved_not_upright(&self, points: &[Point], threads: &Threads) -> Vec<u32> {
        let is_upright = threads.map(self.curved.len(), |i| self.curved.is_upright(i, points));
        (0..).zip(is_upright).filter(|(_, is_upright)| !is_upright).map(|(i, _)| i).collect()
    }

    /// Cells, in rising order, that have an inverted or flat part which was upright in the reference.
    pub(crate) fn newly_inverted(&self, points: &[Point], threads: &Threads) -> Vec<CellId> {
        let mut inverted = self.not_upright(points, threads);
        inverted.corners.retain(|i| self.before.corners.binary_search(i).is_err());
        inverted.curved.retain(|i| self.before.curved.binary_search(i).is_err());
        self.cells_of(&inverted)
    }

    /// Whether all that was upright in the reference still is, and what was upright in `start` has kept
    /// `share` of its volume there (of a quadratic cell: of the least determinant of its Jacobian).
    pub(crate) fn stays_upright(
        &self,
        points: &[Point],
        start: &[Point],
        share: f64,
        threads: &Threads,
    ) -> bool {
        let has_lost = |i: u32, tet: [VertexId; 4]| {
            if self.corners.is_curved[i as usize] {
                return false;
            }
            if !is_upright(tet, points) {
                return self.before.corners.binary_search(&i).is_err();
            }
            let volume = |points: &[Point]| volume_6(tet.map(|v| points[v.index()]));
            share > 0.0 && volume(points) < share * volume(start)
        };
        !self.any(threads, has_lost) && self.curved_stay_upright(points, start, share, threads)
    }

    fn curved_stay_upright(&self, points: &[Point], start: &[Point], share: f64, threads: &Threads) -> bool {
        let least = |i: usize, points: &[Point]| {
            self.curved.least(i, points, f64::INFINITY).map_or(0.0, |least| least.determinant)
        };
        let stays_upright = |i: usize| {
            if !self.curved.is_upright(i, points) {
                return self.before.curved.binary_search(&(i as u32)).is_ok();
            }
            share == 0.0 || least(i, points) >= share * least(i, start)
        };
        !threads.any((0..self.curved.len()).collect(), |i| !stays_upright(i))
    }

    /// The number of cells with an inverted or flat part, now and in the reference.
    pub(crate) fn count(&self, points: &[Point], threads: &Threads) -> [usize; 2] {
        let now = self.not_upright(points, threads);
        [self.cells_of(&now).len(), self.cells_of(&self.before).len()]
    }

    /// The cells with inverted or flat parts, each once, in rising order.
    fn cells_of(&self, inverted: &Inverted) -> Vec<CellId> {
        let of_corners = inverted.corners.iter().map(|&i| self.corners.cells[i as usize]);
        let curved = inverted.curved.iter().map(|&i| self.curved.cells[i as usize]);
        let mut cells: Vec<CellId> = of_corners.chain(curved).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    fn collect(&self, threads: &Threads, pick: impl Fn(u32, [VertexId; 4]) -> bool + Sync) -> Vec<u32> {
        let chunk = |(i, tets): (usize, &[[VertexId; 4]])| -> Vec<u32> {
            let first = (i * CHUNK) as u32;
            (first..).zip(tets).filter(|&(i, tet)| pick(i, *tet)).map(|(i, _)| i).collect()
        };
        let chunks = self.corners.tets.chunks(CHUNK).enumerate().collect();
        threads.each(chunks, chunk).into_iter().flatten().collect()
    }

    fn any(&self, threads: &Threads, pick: impl Fn(u32, [VertexId; 4]) -> bool + Sync) -> bool {
        let chunk = |(i, tets): (usize, &[[VertexId; 4]])| {
            ((i * CHUNK) as u32..).zip(tets).any(|(i, tet)| pick(i, *tet))
        };
        threads.any(self.corners.tets.chunks(CHUNK).enumerate().collect(), chunk)
    }
}

fn is_upright(tet: [VertexId; 4], points: &[Point]) -> bool {
    orientation(tet, points) > 0
}

#[inline]
fn orientation([a, b, c, d]: [VertexId; 4], points: &[Point]) -> i8 {
    orient3d(points[a.index()], points[b.index()], points[c.index()], points[d.index()])
}
