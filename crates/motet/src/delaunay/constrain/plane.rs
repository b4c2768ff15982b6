//! The constrained Delaunay triangulation of a flat facet whose outline carries points.
//!
//! Each triangle with points on its edges is a convex polygon with collinear vertices, which is triangulated;
//! then edges between triangles are flipped until no vertex lies in the circumcircle of a neighbour (Lawson
//! 1977).
//!
//! Circles in the plane are sections of spheres through any fixed point beside it: so signs and ties are
//! those of space, and the result has the facets that the tets would have if they saw no others.

use hashbrown::HashMap;

use super::sites::Sites;
use crate::base::{Point, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::predicates::spot::{Spot, insphere_perturbed_of, orient3d_of};

/// The plane of a triangle.
pub(super) struct Plane<'a> {
    sites: &'a Sites,
    /// A point off the plane, in front of it.
    beside: Point,
}

impl<'a> Plane<'a> {
    /// The plane of three given vertices that are not collinear.
    pub(super) fn new(sites: &'a Sites, corners: [VertexId; 3]) -> Self {
        let [a, b, c] = corners.map(|v| sites.near(v));
        let step = |axis: usize, sign: f64| {
            let mut p = a;
            p[axis] = a[axis] + sign * (a[axis].abs() + b[axis].abs() + 1.0);
            p
        };
        let mut tries = (0..3).flat_map(|axis| [step(axis, 1.0), step(axis, -1.0)]);
        let beside = tries.find(|&p| orient3d(a, b, c, p) > 0).unwrap_or(a);
        Self { sites, beside }
    }

    /// The plane that has `beside` in front of it, a point that [`Self::beside`] returned.
    pub(super) fn behind(sites: &'a Sites, beside: Point) -> Self {
        Self { sites, beside }
    }

    /// A point in front of the plane, from which [`Self::behind`] makes it again.
    pub(super) fn beside(&self) -> Point {
        self.beside
    }

    /// The orientation of three vertices of the plane: 1 if they turn the same way as the triangle.
    pub(super) fn turn(&self, v: [VertexId; 3]) -> i8 {
        let [a, b, c] = v.map(|v| self.sites.spot(v));
        orient3d_of([a, b, c, Spot::Given(self.beside)])
    }

    /// Whether `query` lies in the circumcircle of three vertices oriented like the triangle.
    fn is_in_circle(&self, [a, b, c]: [VertexId; 3], query: VertexId) -> bool {
        let spot = |v: VertexId| self.sites.spot(v);
        let spots = [spot(a), spot(b), spot(c), Spot::Given(self.beside), spot(query)];
        let rank = |v: VertexId| self.sites.rank(v);
        // The point beside the plane is lifted least: this does not affect any circle.
        insphere_perturbed_of(spots, [rank(a), rank(b), rank(c), 0, rank(query)]) > 0
    }

    /// Triangulates a convex polygon, keeping its orientation. Its vertices may be collinear; the result is
    /// empty where all are.
    pub(super) fn triangulate(&self, polygon: &[VertexId]) -> Vec<[VertexId; 3]> {
        let mut triangles = Vec::new();
        let mut chains = vec![(0, polygon.len() - 1)];
        // A chain is closed by the directed edge from its last vertex to its first; its other vertices lie to
        // the left of that edge and are yet to be joined.
        while let Some((from, to)) = chains.pop() {
            let [last, first] = [polygon[to], polygon[from]];
            let mut apex: Option<usize> = None;
            for k in from + 1..to {
                let is_better = apex.is_none_or(|a| self.is_in_circle([last, first, polygon[a]], polygon[k]));
                if is_better && self.turn([last, first, polygon[k]]) > 0 {
                    apex = Some(k);
                }
            }
            if let Some(k) = apex {
                triangles.push([last, first, polygon[k]]);
                chains.extend([(from, k), (k, to)]);
            }
        }
        triangles
    }

    /// Triangulates a polygon that need not be convex by clipping ears, keeping its orientation; `None` where
    /// it has no ear.
    pub(super) fn clip(&self, polygon: &[VertexId]) -> Option<Vec<[VertexId; 3]>> {
        let (mut left, mut triangles) = (polygon.to_vec(), Vec::new());
        while left.len() > 2 {
            let n = left.len();
            let ear = (0..n).find(|&i| {
                let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
                let holds = |v: &VertexId| {
                    ![a, b, c].contains(v)
                        && [[a, b, *v], [b, c, *v], [c, a, *v]].into_iter().all(|t| self.turn(t) >= 0)
                };
                self.turn([a, b, c]) > 0 && !left.iter().any(holds)
            })?;
            triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
            left.remove(ear);
        }
        Some(triangles)
    }

    /// Gives a triangle the orientation of the plane.
    pub(super) fn turned(&self, [a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
        if self.turn([a, b, c]) > 0 { [a, b, c] } else { [a, c, b] }
    }

    /// Flips edges between triangles, all with the orientation of the plane, until all but those on the
    /// outline are Delaunay.
    pub(super) fn make_delaunay(&self, triangles: &mut [[VertexId; 3]]) {
        let mut net = Net::new(triangles);
        let mut todo: Vec<[VertexId; 2]> = net.edges();
        while let Some([a, b]) = todo.pop() {
            let Some([(s, p), (t, q)]) = net.sides([a, b]) else { continue };
            let is_convex = self.turn([p, a, q]) > 0 && self.turn([q, b, p]) > 0;
            if is_convex && self.is_in_circle([a, b, p], q) {
                net.flip(triangles, [a, b], [(s, p), (t, q)]);
                todo.extend([[a, p], [p, b], [b, q], [q, a]]);
            }
        }
    }

    /// Whether the open segments a b and c d cross; all vertices lie in the plane, no three are collinear
    /// unless the segments share an end.
    pub(super) fn cross(&self, [a, b]: [VertexId; 2], [c, d]: [VertexId; 2]) -> bool {
        let shares = [c, d].contains(&a) || [c, d].contains(&b);
        !shares
            && self.turn([a, b, c]) * self.turn([a, b, d]) < 0
            && self.turn([c, d, a]) * self.turn([c, d, b]) < 0
    }

    /// Whether the edge a b, with p on its left and q on its right, can be flipped.
    pub(super) fn can_flip(&self, [a, b]: [VertexId; 2], [p, q]: [VertexId; 2]) -> bool {
        self.turn([p, a, q]) > 0 && self.turn([q, b, p]) > 0
    }
}

/// Triangles by their directed edges.
pub(super) struct Net {
    /// The triangle on the left of each directed edge, and its third vertex.
    left: HashMap<[VertexId; 2], (u32, VertexId)>,
}

impl Net {
    pub(super) fn new(triangles: &[[VertexId; 3]]) -> Self {
        let mut net = Self { left: HashMap::with_capacity(3 * triangles.len()) };
        triangles.iter().enumerate().for_each(|(i, &t)| net.put(i as u32, t));
        net
    }

    fn put(&mut self, i: u32, [a, b, c]: [VertexId; 3]) {
        self.left.insert([a, b], (i, c));
        self.left.insert([b, c], (i, a));
        self.left.insert([c, a], (i, b));
    }

    /// The number of directed edges: three per triangle, where no two triangles have the same one.
    pub(super) fn len(&self) -> usize {
        self.left.len()
    }

    /// The edges with no triangle on their right; ascending.
    pub(super) fn outline(&self) -> Vec<[VertexId; 2]> {
        let outer = self.left.keys().filter(|[a, b]| !self.left.contains_key(&[*b, *a]));
        let mut edges: Vec<_> = outer.copied().collect();
        edges.sort_unstable();
        edges
    }

    /// All edges between two triangles, each once; ascending.
    pub(super) fn edges(&self) -> Vec<[VertexId; 2]> {
        let inner = self.left.keys().filter(|[a, b]| a < b && self.left.contains_key(&[*b, *a]));
        let mut edges: Vec<_> = inner.copied().collect();
        edges.sort_unstable();
        edges
    }

    /// The triangles on the left and on the right of an edge, each with its third vertex.
    pub(super) fn sides(&self, [a, b]: [VertexId; 2]) -> Option<[(u32, VertexId); 2]> {
        Some([*self.left.get(&[a, b])?, *self.left.get(&[b, a])?])
    }

    /// Whether an edge exists.
    pub(super) fn has(&self, [a, b]: [VertexId; 2]) -> bool {
        self.left.contains_key(&[a, b]) || self.left.contains_key(&[b, a])
    }

    /// The edges that the segment from a to b crosses, in the order of the way: walks from triangle to
    /// triangle, starting at one of `fan`, the triangles of a. `None` where the way does not arrive at b.
    pub(super) fn crossed(
        &self,
        plane: &Plane,
        fan: impl Iterator<Item = [VertexId; 3]>,
        [a, b]: [VertexId; 2],
    ) -> Option<Vec<[VertexId; 2]>> {
        let mut opposite = fan.filter_map(|t| {
            let i = t.iter().position(|&v| v == a)?;
            Some([t[(i + 1) % 3], t[(i + 2) % 3]])
        });
        let mut edge = opposite.find(|&edge| plane.cross([a, b], edge))?;
        let mut crossed = vec![edge];
        loop {
            let [x, y] = edge;
            let (_, next) = *self.left.get(&[y, x])?;
            if next == b {
                return Some(crossed);
            }
            edge = [[x, next], [next, y]].into_iter().find(|&edge| plane.cross([a, b], edge))?;
            // A way that turns back would never end.
            if crossed.len() > self.left.len() {
                return None;
            }
            crossed.push(edge);
        }
    }

    /// Replaces the edge a b by the one between the vertices p on its left and q on its right.
    pub(super) fn flip(
        &mut self,
        triangles: &mut [[VertexId; 3]],
        [a, b]: [VertexId; 2],
        [(s, p), (t, q)]: [(u32, VertexId); 2],
    ) {
        self.left.remove(&[a, b]);
        self.left.remove(&[b, a]);
        for (i, triangle) in [(s, [p, a, q]), (t, [q, b, p])] {
            triangles[i as usize] = triangle;
            self.put(i, triangle);
        }
    }
}
