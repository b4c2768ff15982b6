//! Points inside, for a uniform size: a body-centred cubic lattice, slightly away from the surface.
//!
//! The Delaunay tets of the lattice are all congruent and good (dihedral angles of 60 and 90 degrees), and no
//! five of its points lie on one empty sphere. Points outside cost time but do no harm: they are removed with
//! the tets there. So points are not tested for being inside; the surface only has to lie on both sides of
//! them along the shortest side of the box.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::mesh::bounds;
use crate::spatial::NearestTriangle;

/// The mean edge length of the lattice over the side of its cube: of 14 edges at a point 8 lead to the middle
/// of a cube.
pub(crate) const EDGE_OVER_SIDE: f64 = (8.0 * 0.866_025_403_784_438_6 + 6.0) / 14.0;

/// The smallest distance of points from the surface, relative to the edge length. A regular tet on a facet
/// has its apex at 0.82.
pub(super) const CLEARANCE: f64 = 0.6;

/// The largest expected number of points.
const MAX_POINTS: f64 = 2e8;

/// Rejects sizes that require too many points.
///
/// # Errors
/// When they do; the error gives the number.
pub(super) fn check(points: &[Point], size: f64) -> Result<()> {
    let [low, high] = bounds(points).unwrap_or_default();
    let expected = (0..3).map(|i| (high[i] - low[i]) / (size / EDGE_OVER_SIDE) + 1.0).product::<f64>() * 2.0;
    if expected > MAX_POINTS {
        let what = format!(
            "a size of {size} requires about {expected:.1e} points inside; at most {MAX_POINTS:.0e} are \
             allowed"
        );
        return Err(Error::options(what).remedy("give a larger size"));
    }
    Ok(())
}

/// Returns lattice points between the surfaces, with edges of about `size`, in lattice order.
///
/// # Errors
/// When there would be too many.
pub(super) fn lattice(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    size: f64,
    threads: &Threads,
) -> Result<Vec<Point>> {
    check(points, size)?;
    let side = size / EDGE_OVER_SIDE;
    let [low, high] = bounds(points).unwrap_or_default();
    let sides = [0, 1, 2].map(|i| high[i] - low[i]);
    let along = (0..3).min_by(|&i, &j| sides[i].total_cmp(&sides[j])).unwrap_or(0);
    let tree = NearestTriangle::new(points, triangles, threads);
    let mut found = Vec::new();
    // The two cubic lattices that make up a body-centred one.
    for shift in [0.0, 0.5] {
        let columns = Columns { low, side, shift, across: [(along + 1) % 3, (along + 2) % 3], along };
        found.extend(columns.points(sides, &columns.spans(points, triangles, sides)));
    }
    let is_away = threads.map(found.len(), |i| tree.closest_within(found[i], CLEARANCE * size).is_none());
    Ok(found.into_iter().zip(is_away).filter(|(_, away)| *away).map(|(p, _)| p).collect())
}

/// The columns of a cubic lattice along one axis.
struct Columns {
    low: Point,
    side: f64,
    shift: f64,
    across: [usize; 2],
    along: usize,
}

impl Columns {
    fn counts(&self, sides: Point) -> [usize; 2] {
        self.across.map(|axis| (sides[axis] / self.side) as usize + 2)
    }

    fn place(&self, axis: usize, k: usize) -> f64 {
        self.low[axis] + (k as f64 + self.shift) * self.side
    }

    /// The span of each column between the first and the last triangle that it may meet.
    fn spans(&self, points: &[Point], triangles: &[[VertexId; 3]], sides: Point) -> Vec<[f64; 2]> {
        let counts = self.counts(sides);
        let mut spans = vec![[f64::INFINITY, f64::NEG_INFINITY]; counts[0] * counts[1]];
        for triangle in triangles {
            let corners = triangle.map(|v| points[v.index()]);
            let range = |axis: usize| {
                let x = corners.map(|p| p[axis]);
                [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])]
            };
            let [from, to] = range(self.along);
            let columns = [0, 1].map(|i| {
                let [low, high] =
                    range(self.across[i]).map(|x| (x - self.low[self.across[i]]) / self.side - self.shift);
                low.ceil().max(0.0) as usize..((high.floor() + 1.0).max(0.0) as usize).min(counts[i])
            });
            for i in columns[0].clone() {
                for j in columns[1].clone() {
                    let span = &mut spans[i * counts[1] + j];
                    *span = [span[0].min(from), span[1].max(to)];
                }
            }
        }
        spans
    }

    fn points(&self, sides: Point, spans: &[[f64; 2]]) -> Vec<Point> {
        let counts = self.counts(sides);
        let mut points = Vec::new();
        for (column, &[from, to]) in spans.iter().enumerate().filter(|(_, [from, to])| from <= to) {
            let mut p = [0.0; 3];
            p[self.across[0]] = self.place(self.across[0], column / counts[1]);
            p[self.across[1]] = self.place(self.across[1], column % counts[1]);
            let first = ((from - self.low[self.along]) / self.side - self.shift).ceil().max(0.0);
            for k in first as usize.. {
                p[self.along] = self.place(self.along, k);
                if p[self.along] > to {
                    break;
                }
                points.push(p);
            }
        }
        points
    }
}
