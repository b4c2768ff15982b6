//! Fills a ring of vertices with triangles of the least total area.
//!
//! Barequet and Sharir 1995, *Filling gaps in the boundary of a polyhedron*: the best fill of the ring from
//! `i` to `j` is a triangle on that chord and the best fills on its two other edges, so all are found by
//! dynamic programming, from the shortest chord up, in `n^3 / 6` steps.

use crate::base::{Point, VertexId};
use crate::geometry::predicates::collinear;
use crate::geometry::triangle::area;

/// The triangles of the fill, by the indices of their corners in the ring, oriented like the ring, the
/// smallest index first. `is_forbidden` returns whether a chord cannot be a new edge. `None` if there is no
/// fill without such chords and without triangles that have no area.
pub(super) fn fill(
    points: &[Point],
    ring: &[VertexId],
    is_forbidden: impl Fn(VertexId, VertexId) -> bool,
) -> Option<Vec<[usize; 3]>> {
    let n = ring.len();
    let at = |i: usize| points[ring[i].index()];
    let mut best = Table::new(n);
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            if span + 1 < n && is_forbidden(ring[i], ring[j]) {
                continue;
            }
            for m in i + 1..j {
                let all = best.area(i, m) + best.area(m, j) + area([at(i), at(m), at(j)]);
                // The exact test comes last, since it takes ten times as long as the rest.
                if all < best.area(i, j) && !collinear(at(i), at(m), at(j)) {
                    best.put(i, j, all, m);
                }
            }
        }
    }
    (n > 2 && best.area(0, n - 1) < f64::INFINITY).then(|| best.triangles(n))
}

/// For each chord, the least area of a fill, and the corner opposite to the chord in it.
struct Table {
    n: usize,
    entries: Vec<(f64, u32)>,
}

impl Table {
    fn new(n: usize) -> Self {
        Self { n, entries: vec![(f64::INFINITY, 0); n * n] }
    }

    /// The least area on a chord; infinite if there is no fill.
    fn area(&self, i: usize, j: usize) -> f64 {
        if j == i + 1 { 0.0 } else { self.entries[i * self.n + j].0 }
    }

    fn put(&mut self, i: usize, j: usize, area: f64, middle: usize) {
        self.entries[i * self.n + j] = (area, middle as u32);
    }

    fn triangles(&self, n: usize) -> Vec<[usize; 3]> {
        let (mut open, mut triangles) = (vec![(0, n - 1)], Vec::new());
        while let Some((i, j)) = open.pop() {
            if j > i + 1 {
                let m = self.entries[i * self.n + j].1 as usize;
                triangles.push([i, m, j]);
                open.extend([(i, m), (m, j)]);
            }
        }
        triangles
    }
}
