//! Which cells a motion has turned over: by exact signs, and against how the mesh began.

use rayon::prelude::*;

use crate::base::{CellId, Point, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::volume_6;
use crate::mesh::{Mesh, OrientedTets};
use crate::motion::corners::Corners;

/// The corners of the cells, and those that were inverted or flat from the start.
///
/// A mesh may come with inverted cells. They are counted and told, but do not stop a
/// motion: what it has to keep upright is what was upright.
#[derive(Debug, Default)]
pub(crate) struct Check {
    pub(crate) corners: Corners,
    /// The linear tets, which tell the layers among those of low quality.
    pub(crate) tets: OrientedTets,
    /// Corners, in rising order, that were not upright in the reference.
    before: Vec<u32>,
}

/// Corners that one thread looks at in one go.
const CHUNK: usize = 1 << 14;

impl Check {
    pub(crate) fn new(mesh: &Mesh, threads: &Threads) -> Self {
        let (cells, points) = (&mesh.cells, &mesh.points);
        let tets = OrientedTets::of_linear(mesh);
        let mut corners = Corners::of(cells, &tets);
        let signs = threads.map(corners.len(), |i| orientation(corners.tets[i], points));
        let before = corners.stand_up(cells, &signs);
        Self { corners, tets, before }
    }

    /// Corners, in rising order, that are inverted or flat.
    fn not_upright(&self, points: &[Point], threads: &Threads) -> Vec<u32> {
        self.collect(threads, |_, tet| !is_upright(tet, points))
    }

    /// Corners, in rising order, that are inverted or flat and were not in the reference.
    pub(crate) fn turned_over(&self, points: &[Point], threads: &Threads) -> Vec<u32> {
        let mut turned = self.not_upright(points, threads);
        turned.retain(|i| self.before.binary_search(i).is_err());
        turned
    }

    /// Whether every corner that was upright in the reference still is, and has kept
    /// `share` of its volume in `start` if it was upright there.
    pub(crate) fn holds(&self, points: &[Point], start: &[Point], share: f64, threads: &Threads) -> bool {
        let lost = self.any(threads, |i, tet| {
            if !is_upright(tet, points) {
                return self.before.binary_search(&i).is_err();
            }
            let volume = |points: &[Point]| volume_6(tet.map(|v| points[v.index()]));
            share > 0.0 && volume(points) < share * volume(start)
        });
        !lost
    }

    /// Cells of which a corner is not upright: all of them, and those that were from the start.
    pub(crate) fn count(&self, points: &[Point], threads: &Threads) -> [usize; 2] {
        let now = self.not_upright(points, threads);
        [self.cells_of(&now).len(), self.cells_of(&self.before).len()]
    }

    /// The cells of some corners, each once.
    pub(crate) fn cells_of(&self, corners: &[u32]) -> Vec<CellId> {
        let mut cells: Vec<CellId> = corners.iter().map(|&i| self.corners.cells[i as usize]).collect();
        cells.dedup();
        cells
    }

    fn collect(&self, threads: &Threads, pick: impl Fn(u32, [VertexId; 4]) -> bool + Sync) -> Vec<u32> {
        let chunk = |(i, tets): (usize, &[[VertexId; 4]])| -> Vec<u32> {
            let first = (i * CHUNK) as u32;
            (first..).zip(tets).filter(|&(i, tet)| pick(i, *tet)).map(|(i, _)| i).collect()
        };
        let found: Vec<Vec<u32>> = match threads.pool() {
            None => self.corners.tets.chunks(CHUNK).enumerate().map(chunk).collect(),
            Some(pool) => {
                pool.install(|| self.corners.tets.par_chunks(CHUNK).enumerate().map(chunk).collect())
            }
        };
        found.into_iter().flatten().collect()
    }

    fn any(&self, threads: &Threads, pick: impl Fn(u32, [VertexId; 4]) -> bool + Sync) -> bool {
        let chunk = |(i, tets): (usize, &[[VertexId; 4]])| {
            ((i * CHUNK) as u32..).zip(tets).any(|(i, tet)| pick(i, *tet))
        };
        match threads.pool() {
            None => self.corners.tets.chunks(CHUNK).enumerate().any(chunk),
            Some(pool) => pool.install(|| self.corners.tets.par_chunks(CHUNK).enumerate().any(chunk)),
        }
    }
}

fn is_upright(tet: [VertexId; 4], points: &[Point]) -> bool {
    orientation(tet, points) > 0
}

#[inline]
fn orientation([a, b, c, d]: [VertexId; 4], points: &[Point]) -> i8 {
    orient3d(points[a.index()], points[b.index()], points[c.index()], points[d.index()])
}
