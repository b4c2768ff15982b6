//! How far apart places are along the surface, so that neighbours are not taken for a gap.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::base::{Csr, Point, VertexId};
use crate::geometry::vector::distance;

/// The edges of all bodies together: bodies that share vertices are one surface here.
#[derive(Clone, Debug)]
pub(super) struct Along {
    neighbors: Csr<u32>,
}

impl Along {
    pub(super) fn new<'a>(
        n_points: usize,
        triangles: impl Iterator<Item = &'a [VertexId; 3]> + Clone,
    ) -> Self {
        let neighbors = Csr::from_pairs(n_points, || {
            triangles.clone().flat_map(|&[a, b, c]| {
                [(a, b), (b, c), (c, a)].into_iter().flat_map(|(x, y)| [(x.index(), y.0), (y.index(), x.0)])
            })
        });
        Self { neighbors }
    }

    /// The vertices that an edge joins to this one, some more than once.
    pub(super) fn neighbors(&self, vertex: VertexId) -> &[u32] {
        self.neighbors.list(vertex.index())
    }

    /// Whether one goes from a vertex to a place in a triangle with these corners within `length`, along edges and at last within the
    /// triangle.
    ///
    /// Shortest ways first, counted with what is left as the crow flies (Hart, Nilsson and Raphael 1968): only vertices within an ellipse are
    /// looked at, about a quarter of those within `length`.
    /// Along edges it is farther than across triangles, by up to two fifths in a regular grid; so the answer errs
    /// towards calling a place a gap, which is the safe side.
    pub(super) fn is_within(
        &self,
        points: &[Point],
        from: VertexId,
        (corners, place): ([VertexId; 3], Point),
        length: f64,
        ways: &mut Ways,
    ) -> bool {
        ways.begin(points.len());
        let left = |v: u32| distance(points[v as usize], place);
        ways.reach(from.0, 0.0, left(from.0));
        while let Some((Reverse(bits), v)) = ways.open.pop() {
            if f64::from_bits(bits) > length {
                return false;
            }
            let far = ways.far[v as usize];
            // A vertex is open once more for each shorter way that was found to it.
            if (far + left(v)).to_bits() != bits {
                continue;
            }
            if corners.iter().any(|corner| corner.0 == v) {
                return true;
            }
            for &next in self.neighbors.list(v as usize) {
                let step = distance(points[v as usize], points[next as usize]);
                ways.reach(next, far + step, left(next));
            }
        }
        false
    }
}

/// What one search needs, kept for the next.
#[derive(Debug, Default)]
pub(super) struct Ways {
    /// How far each vertex is, where `round` says that it was reached in this search.
    far: Vec<f64>,
    round: Vec<u32>,
    now: u32,
    /// By the whole length, as bits: those of positive numbers are in the order of the numbers.
    open: BinaryHeap<(Reverse<u64>, u32)>,
}

impl Ways {
    fn begin(&mut self, n_points: usize) {
        self.open.clear();
        if self.far.len() != n_points || self.now == u32::MAX {
            (self.far, self.round, self.now) = (vec![0.0; n_points], vec![0; n_points], 0);
        }
        self.now += 1;
    }

    fn reach(&mut self, v: u32, far: f64, left: f64) {
        let i = v as usize;
        if self.round[i] != self.now || far < self.far[i] {
            (self.round[i], self.far[i]) = (self.now, far);
            self.open.push((Reverse((far + left).to_bits()), v));
        }
    }
}
