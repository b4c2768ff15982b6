//! Which tet of a triangulation contains a point: a walk through plain arrays, every step decided exactly.
//!
//! The walk crosses any facet that has the point strictly on its other side (Devillers, Pion and Teillaud
//! 2002). The facet to try first changes from step to step, so the walk ends in any triangulation of a convex
//! set (with probability 1), and always in a Delaunay triangulation. Because no sign is rounded, a point of
//! the hull is always found, also on facets, edges and vertices.

use super::hilbert::{Curve, bounding_cube};
use crate::base::{Point, TetId, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::triangle;
use crate::geometry::vector::{dot, sub};

/// Stands for no tet in an array of neighbours: the facet lies on the hull.
pub const OUTSIDE: TetId = TetId(u32::MAX);

/// Vertices of facet `i`, seen from outside the tet.
const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// Points located one after the other, each from where the previous one was found. The number is fixed, so
/// that results do not depend on the number of threads.
const CHUNK: usize = 1024;

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Located {
    /// In this tet, or on its surface.
    Inside(TetId),
    /// Outside the hull; this facet of the hull is nearest.
    Outside {
        /// The tet that has the facet.
        tet: TetId,
        /// The facet: the one opposite this vertex of the tet.
        facet: u8,
    },
}

impl Located {
    /// The tet that contains the point, or the one behind the nearest facet of the hull.
    pub fn tet(self) -> TetId {
        match self {
            Self::Inside(tet) | Self::Outside { tet, .. } => tet,
        }
    }

    /// Whether the point lies in the hull.
    pub fn is_inside(self) -> bool {
        matches!(self, Self::Inside(_))
    }
}

/// Finds points in a triangulation of a convex set.
#[derive(Clone, Copy, Debug)]
pub struct Locator<'a> {
    points: &'a [Point],
    tets: &'a [[VertexId; 4]],
    neighbors: &'a [[TetId; 4]],
}

impl<'a> Locator<'a> {
    /// `tets` must be positively oriented and fill the convex hull of their points; `neighbors[t][i]` is the
    /// tet across the facet opposite vertex `i` of tet `t`, or [`OUTSIDE`]. There must be at least one tet.
    pub fn new(points: &'a [Point], tets: &'a [[VertexId; 4]], neighbors: &'a [[TetId; 4]]) -> Self {
        Self { points, tets, neighbors }
    }

    /// Locates `q` (finite), by a walk that starts at `hint`, any tet.
    pub fn locate(&self, q: Point, hint: TetId) -> Located {
        let mut tet = hint;
        let mut from = OUTSIDE;
        let mut first = 0;
        loop {
            let Some(facet) = self.exit(tet, from, q, first) else { return Located::Inside(tet) };
            let next = self.neighbors[tet.index()][facet];
            if next == OUTSIDE {
                return self.nearest_of_hull(tet, facet, q);
            }
            (from, tet) = (tet, next);
            first = (first + 1) % 4;
        }
    }

    /// [`Self::locate`] for many points: neighbours one after the other, in parallel where `threads` allow.
    pub fn locate_all(&self, queries: &[Point], threads: &Threads) -> Vec<Located> {
        let order = hilbert_order(queries);
        let chunk = |ids: &[u32]| -> Vec<Located> {
            let mut hint = ids.first().map_or(TetId(0), |&id| self.start_near(queries[id as usize]));
            let locate = |&id: &u32| {
                let located = self.locate(queries[id as usize], hint);
                hint = located.tet();
                located
            };
            ids.iter().map(locate).collect()
        };
        let chunks = threads.each(order.chunks(CHUNK).collect(), chunk);
        let mut located = vec![Located::Inside(TetId(0)); queries.len()];
        for (&id, found) in order.iter().zip(chunks.into_iter().flatten()) {
            located[id as usize] = found;
        }
        located
    }

    /// The vertices of a tet.
    #[inline]
    fn corners(&self, tet: TetId) -> [Point; 4] {
        let [a, b, c, d] = self.tets[tet.index()];
        [self.points[a.index()], self.points[b.index()], self.points[c.index()], self.points[d.index()]]
    }

    /// A facet that has `q` strictly beyond it, other than the one to the tet `from`.
    #[inline]
    fn exit(&self, tet: TetId, from: TetId, q: Point, first: usize) -> Option<usize> {
        let corners = self.corners(tet);
        let neighbors = self.neighbors[tet.index()];
        for i in [first, first + 1, first + 2, first + 3] {
            let i = i % 4;
            if (neighbors[i] != from || neighbors[i] == OUTSIDE) && is_beyond(corners, i, q) {
                return Some(i);
            }
        }
        None
    }

    /// A start for a walk: of a few tets spread over the array, the one whose first vertex is nearest (Mücke,
    /// Saias and Zhu 1999, *Fast randomized point location without preprocessing*).
    fn start_near(&self, q: Point) -> TetId {
        let step = self.tets.len().div_ceil(64);
        let distance_squared = |tet: usize| {
            let arm = sub(self.points[self.tets[tet][0].index()], q);
            dot(arm, arm)
        };
        let nearest = (0..self.tets.len())
            .step_by(step)
            .min_by(|&a, &b| distance_squared(a).total_cmp(&distance_squared(b)));
        TetId::new(nearest.unwrap_or(0))
    }

    /// The hull facet nearest to `q`, given one that `q` sees. The nearest one is visible too, and the part
    /// of a convex hull that is visible from a point is connected, so it is enough to search that part.
    fn nearest_of_hull(&self, tet: TetId, facet: usize, q: Point) -> Located {
        let mut seen = vec![(tet, facet)];
        let mut known: std::collections::HashSet<(TetId, usize)> = seen.iter().copied().collect();
        let mut nearest = (f64::INFINITY, tet, facet);
        while let Some((tet, facet)) = seen.pop() {
            let corners = self.corners(tet);
            let corner = FACETS[facet].map(|i| corners[i]);
            let arm = sub(triangle::at(corner, triangle::closest(corner, q)), q);
            let candidate = (dot(arm, arm), tet, facet);
            if candidate < nearest {
                nearest = candidate;
            }
            for [u, v] in [[0, 1], [1, 2], [2, 0]] {
                let next = self.across_hull_edge(tet, facet, [FACETS[facet][u], FACETS[facet][v]]);
                if is_beyond(self.corners(next.0), next.1, q) && known.insert(next) {
                    seen.push(next);
                }
            }
        }
        Located::Outside { tet: nearest.1, facet: nearest.2 as u8 }
    }

    /// The other hull facet at an edge of a hull facet, found by going around the edge from tet to tet.
    /// `edge` are local indices in the tet.
    fn across_hull_edge(&self, tet: TetId, facet: usize, edge: [usize; 2]) -> (TetId, usize) {
        let edge = edge.map(|i| self.tets[tet.index()][i]);
        // Each tet at the edge has two facets there: `behind` is the vertex off the facet last crossed, and
        // the next one crossed is the facet that contains it.
        let mut tet = tet;
        let mut behind = self.tets[tet.index()][facet];
        loop {
            let vertices = self.tets[tet.index()];
            let cross = (0..4).find(|&i| vertices[i] != behind && !edge.contains(&vertices[i])).unwrap_or(0);
            let next = self.neighbors[tet.index()][cross];
            if next == OUTSIDE {
                return (tet, cross);
            }
            let shared = [edge[0], edge[1], behind];
            let across = self.tets[next.index()].iter().find(|v| !shared.contains(v));
            behind = across.copied().unwrap_or(behind);
            tet = next;
        }
    }
}

/// Whether `q` lies strictly on the other side of facet `i`.
#[inline]
fn is_beyond(corners: [Point; 4], i: usize, q: Point) -> bool {
    let [a, b, c] = FACETS[i];
    let (a, b, c) = (corners[a], corners[b], corners[c]);
    orient3d(q, a, b, c) < 0
}

/// Ids of the points in the order of a Hilbert curve.
fn hilbert_order(points: &[Point]) -> Vec<u32> {
    let (corner, extent) = bounding_cube(points.iter().copied());
    let curve = Curve::new(corner, extent);
    let mut keyed: Vec<(u64, u32)> =
        points.iter().enumerate().map(|(i, &p)| (curve.key(p), i as u32)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|k| k.1).collect()
}
