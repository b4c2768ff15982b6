//! Distances along the surface, so that neighbours are not mistaken for a gap.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::base::{Csr, MaybeId, Point, VertexId, id};
use crate::geometry::vector::distance;

/// The edges of all bodies together: bodies that share vertices are one surface here.
#[derive(Clone, Debug)]
pub(super) struct SurfaceGraph {
    neighbors: Csr<VertexId>,
    /// The piece of each vertex, by its first vertex: no path leads from one piece to another.
    pieces: Vec<MaybeId<VertexId>>,
}

/// A factor above one by more than rounding adds up to along a path.
const SLACK: f64 = 1.0 + 1e-9;

/// A search continues up to this multiple of the requested length: what it then finds out about one vertex
/// decides enough of those around it, so that few searches are left.
const SEARCH_FACTOR: f64 = 1.5;

impl SurfaceGraph {
    pub(super) fn new<'a>(
        n_points: usize,
        triangles: impl Iterator<Item = &'a [VertexId; 3]> + Clone,
    ) -> Self {
        let twice = Csr::from_pairs(n_points, || {
            triangles.clone().flat_map(|&[a, b, c]| {
                [(a, b), (b, c), (c, a)].into_iter().flat_map(|(x, y)| [(x.index(), y), (y.index(), x)])
            })
        });
        let neighbors = Csr::from_pairs(n_points, || {
            twice.iter().enumerate().flat_map(|(v, list): (_, &[VertexId])| {
                let is_new = move |&k: &usize| !list[..k].contains(&list[k]);
                (0..list.len()).filter(is_new).map(move |k| (v, list[k]))
            })
        });
        let pieces = pieces(&neighbors);
        Self { neighbors, pieces }
    }

    /// The vertices that an edge joins to this one.
    pub(super) fn neighbors(&self, vertex: VertexId) -> &[VertexId] {
        self.neighbors.list(vertex.index())
    }

    /// Whether some path from a vertex to a place in a triangle with these corners is no longer than
    /// `length`, along edges and finally within the triangle.
    ///
    /// Paths along edges are longer than paths across triangles, by up to two fifths in a regular grid; so
    /// the answer errs towards calling a place a gap, which is the safe side.
    pub(super) fn is_within(
        &self,
        points: &[Point],
        from: VertexId,
        to: PathEnd,
        length: f64,
        paths: &mut PathSearch,
    ) -> bool {
        paths.begin(points.len());
        let piece = |v: VertexId| self.pieces[v.index()];
        if to.corners.iter().all(|&corner| piece(corner) != piece(from)) {
            return false;
        }
        let known = self.lower_bound(points, from, to, length, paths);
        if known > length * SLACK {
            paths.remember_far(from, Far { to, least: known });
            return false;
        }
        let least = self.shortest(points, from, to, length * SEARCH_FACTOR, paths);
        // Also false for a length that is NaN.
        let is_far = least > length;
        if !is_far {
            return true;
        }
        paths.remember_far(from, Far { to, least });
        false
    }

    /// A lower bound of the distance from a vertex to a place, by what is known of the vertex and its
    /// neighbours; 0 if that says nothing. A path to the place continues to another place in the same
    /// triangle, or through a corner to one in an adjacent triangle.
    fn lower_bound(
        &self,
        points: &[Point],
        from: VertexId,
        PathEnd { corners, place }: PathEnd,
        enough: f64,
        paths: &PathSearch,
    ) -> f64 {
        let mut most = 0.0;
        for &via in [from].iter().chain(self.neighbors.list(from.index())) {
            let Some(&Far { to: PathEnd { corners: others, place: other }, least }) = paths.far_from(via)
            else {
                continue;
            };
            let step = distance(points[via.index()], points[from.index()]);
            let on = match corners == others {
                true => distance(place, other),
                false => {
                    let shared = corners.iter().filter(|corner| others.contains(corner));
                    let by = |v: &VertexId| {
                        distance(place, points[v.index()]) + distance(points[v.index()], other)
                    };
                    shared.map(by).fold(f64::INFINITY, f64::min)
                }
            };
            // `SLACK` covers the rounding of the three lengths, which is less than a fraction of the longest.
            most = f64::max(most, least / SLACK - step - on);
            if most > enough * SLACK {
                break;
            }
        }
        most
    }

    /// The distance along edges from a vertex to a place; if it exceeds `length`, a lower bound that exceeds
    /// `length`.
    ///
    /// Shortest paths first, with the straight distance as the estimate of what is left (A*: Hart, Nilsson
    /// and Raphael 1968): only vertices within an ellipse are examined.
    fn shortest(
        &self,
        points: &[Point],
        from: VertexId,
        PathEnd { corners, place }: PathEnd,
        length: f64,
        paths: &mut PathSearch,
    ) -> f64 {
        let left = |v: VertexId| distance(points[v.index()], place);
        paths.reach(from, 0.0, left(from));
        while let Some((Reverse(bits), v)) = paths.open.pop() {
            let whole = f64::from_bits(bits);
            if whole > length {
                return whole;
            }
            let far = paths.distances[v.index()];
            // A vertex is in the queue once more for each shorter path found to it.
            if (far + left(v)).to_bits() != bits {
                continue;
            }
            if corners.contains(&v) {
                return whole;
            }
            for &next in self.neighbors.list(v.index()) {
                let step = distance(points[v.index()], points[next.index()]);
                paths.reach(next, far + step, left(next));
            }
        }
        f64::INFINITY
    }
}

/// Numbers the pieces that edges connect, each by its first vertex.
fn pieces(neighbors: &Csr<VertexId>) -> Vec<MaybeId<VertexId>> {
    let mut pieces = vec![MaybeId::NONE; neighbors.len()];
    let mut open = Vec::new();
    for first in (0..neighbors.len()).map(VertexId::new) {
        if pieces[first.index()].is_some() {
            continue;
        }
        pieces[first.index()] = first.into();
        open.push(first);
        while let Some(v) = open.pop() {
            for &next in neighbors.list(v.index()) {
                if pieces[next.index()].is_none() {
                    pieces[next.index()] = first.into();
                    open.push(next);
                }
            }
        }
    }
    pieces
}

/// Where a path along the surface ends: a place in a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathEnd {
    /// The corners of the triangle.
    pub(super) corners: [VertexId; 3],
    pub(super) place: Point,
}

id!(
    /// An entry of the list of places that are known to be far from a vertex.
    FarId
);

/// A place in a triangle, and a lower bound of its distance along the surface.
#[derive(Clone, Copy, Debug)]
struct Far {
    to: PathEnd,
    least: f64,
}

/// The buffers of a search, kept for the next one, and what searches found. Valid for one surface at one
/// time.
#[derive(Debug, Default)]
pub(super) struct PathSearch {
    /// The distance of each vertex, valid if its `search_number` is `current_search`.
    distances: Vec<f64>,
    search_number: Vec<u32>,
    current_search: u32,
    /// By the estimated whole length, as bits: those of positive numbers are in the order of the numbers.
    open: BinaryHeap<(Reverse<u64>, VertexId)>,
    /// For each vertex, the last of `far_places` that was found to be far from it, if any.
    last_far: Vec<MaybeId<FarId>>,
    far_places: Vec<Far>,
}

impl PathSearch {
    fn begin(&mut self, n_points: usize) {
        self.open.clear();
        if self.distances.len() != n_points || self.current_search == u32::MAX {
            (self.distances, self.search_number, self.current_search) =
                (vec![0.0; n_points], vec![0; n_points], 0);
            (self.last_far, self.far_places) = (vec![MaybeId::NONE; n_points], Vec::new());
        }
        self.current_search += 1;
    }

    fn reach(&mut self, v: VertexId, far: f64, left: f64) {
        let i = v.index();
        if self.search_number[i] != self.current_search || far < self.distances[i] {
            (self.search_number[i], self.distances[i]) = (self.current_search, far);
            self.open.push((Reverse((far + left).to_bits()), v));
        }
    }

    fn far_from(&self, v: VertexId) -> Option<&Far> {
        self.last_far[v.index()].get().map(|far| &self.far_places[far.index()])
    }

    fn remember_far(&mut self, v: VertexId, far: Far) {
        let last = &mut self.last_far[v.index()];
        match last.get() {
            Some(known) => self.far_places[known.index()] = far,
            None => {
                *last = FarId::new(self.far_places.len()).into();
                self.far_places.push(far);
            }
        }
    }
}
