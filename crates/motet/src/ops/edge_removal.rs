//! An edge taken out, and the hole filled in the best of all ways.
//!
//! The tets round an edge `ab` go. What comes in their place is a triangulation of the ring round the edge, each triangle joined to `a` and
//! to `b`. The one whose worst tet is best is found by dynamic programming (Klincsek 1980, *Minimal triangulations of
//! polygonal domains*; Shewchuk 2002, *Two discrete optimization algorithms for the topological improvement of tetrahedral meshes*): the flips
//! 3-2 and 4-4 are its cases for rings of three and four.

use crate::base::{TetId, VertexId};
use crate::kernel::{Change, Complex, Shell};

/// Rings with more vertices are left alone: triangulations become many, and good ones rare.
const LARGEST_RING: usize = 10;

/// Room for the tables, used again and again.
#[derive(Clone, Debug, Default)]
pub struct EdgeRemoval {
    shell: Shell,
    /// For ring vertices i < j: the best worst quality of what fills the ring between them, and the third vertex of the triangle at `ij`.
    best: Vec<(f64, u8)>,
}

impl EdgeRemoval {
    /// Proposes to remove the edge from `a` to `b`, which `start` has. `false` when there is no way better than `bar`, or a wall has the edge.
    pub fn propose(
        &mut self,
        complex: &Complex,
        start: TetId,
        [a, b]: [VertexId; 2],
        bar: f64,
        change: &mut Change,
    ) -> bool {
        self.shell.walk(complex, start, a, b);
        let m = self.shell.ring.len();
        if !self.shell.is_free() || !(3..=LARGEST_RING).contains(&m) || complex.is_fixed_edge(a, b) {
            return false;
        }
        change.clear();
        if !self.tabulate(complex, [a, b], bar) {
            return false;
        }
        change.cavity.extend_from_slice(&self.shell.tets);
        self.build(complex, [a, b], (0, m - 1), change);
        true
    }

    /// Fills the table; whether the whole ring has a filling better than `bar`.
    fn tabulate(&mut self, complex: &Complex, [a, b]: [VertexId; 2], bar: f64) -> bool {
        let Self { shell, best } = self;
        let ring = &shell.ring;
        let m = ring.len();
        let [pa, pb] = [complex.point(a), complex.point(b)];
        let mut points = [[0.0; 3]; LARGEST_RING];
        for i in 0..m {
            points[i] = complex.point(ring[i]);
        }
        best.clear();
        best.resize(m * m, (f64::INFINITY, 0));
        for length in 2..m {
            for i in 0..m - length {
                let j = i + length;
                let mut found = (bar, u8::MAX);
                for k in i + 1..j {
                    let sides = best[i * m + k].0.min(best[k * m + j].0);
                    if !(sides > found.0) {
                        continue;
                    }
                    let above = complex.measure([points[i], points[k], points[j], pb]);
                    if !(above > found.0) {
                        continue;
                    }
                    let below = complex.measure([points[i], points[j], points[k], pa]);
                    let all = sides.min(above).min(below);
                    if all > found.0 {
                        found = (all, k as u8);
                    }
                }
                best[i * m + j] = if found.1 == u8::MAX { (f64::NEG_INFINITY, u8::MAX) } else { found };
            }
        }
        best[m - 1].0 > bar
    }

    fn build(&self, complex: &Complex, edge: [VertexId; 2], (i, j): (usize, usize), change: &mut Change) {
        if j < i + 2 {
            return;
        }
        let m = self.shell.ring.len();
        let k = usize::from(self.best[i * m + j].1);
        let [a, b] = edge;
        let [p, q, r] = [i, k, j].map(|place| self.shell.ring[place]);
        let region = complex.region(self.shell.tets[0]);
        change.push(complex, [p, q, r, b], region);
        change.push(complex, [p, r, q, a], region);
        self.build(complex, edge, (i, k), change);
        self.build(complex, edge, (k, j), change);
    }
}
