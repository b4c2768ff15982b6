//! What two triangles have in common: points, and how they are connected.

use crate::base::{Point, VertexId};
use crate::geometry::segment;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};

/// The identity of a point: every pair of triangles that has the point gives it the same key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum PointKey {
    /// A vertex.
    Vertex(VertexId),
    /// Where two edges cross, the smaller edge first, each with its smaller vertex first.
    Edges([VertexId; 2], [VertexId; 2]),
    /// Where an edge passes through a triangle, by its number.
    Through([VertexId; 2], u32),
}

/// Where a point lies on a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Location {
    Corner(usize),
    /// On the edge from this corner to the next.
    Edge(usize),
    Inside,
}

impl Location {
    /// Whether it lies on the edge from corner `k` to the next, its ends included.
    fn is_along(self, k: usize) -> bool {
        match self {
            Location::Corner(c) => c == k || c == (k + 1) % 3,
            Location::Edge(e) => e == k,
            Location::Inside => false,
        }
    }
}

/// A point that two triangles have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared {
    pub(super) key: PointKey,
    pub(super) at: Point,
    /// Where it lies on the first triangle, and on the second.
    pub(super) on: [Location; 2],
}

/// All that two triangles have in common.
#[derive(Clone, Debug, Default)]
pub(super) struct Common {
    pub(super) points: Vec<Shared>,
    /// Pairs of points that an edge joins.
    pub(super) segments: Vec<[usize; 2]>,
    /// Whether the triangles lie in one plane, and may have an area in common.
    pub(super) is_flat: bool,
}

/// One of two triangles that may meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct NumberedTriangle {
    pub(super) number: u32,
    pub(super) vertices: [VertexId; 3],
    pub(super) corners: [Point; 3],
}

impl NumberedTriangle {
    fn edge(&self, k: usize) -> ([VertexId; 2], [Point; 2]) {
        let [i, j] = [k, (k + 1) % 3];
        let [i, j] = if self.vertices[i] < self.vertices[j] { [i, j] } else { [j, i] };
        ([self.vertices[i], self.vertices[j]], [self.corners[i], self.corners[j]])
    }

    /// How far the corners of another triangle lie in front of the plane of this one; 0 for those within
    /// `near` of it or shared. `None` if this triangle has no area.
    fn offsets(&self, of: &NumberedTriangle, near: f64) -> Option<[f64; 3]> {
        let normal = area_vector(self.corners);
        let length = norm(normal);
        let offset = |k: usize| {
            if self.vertices.contains(&of.vertices[k]) {
                return 0.0;
            }
            let offset = dot(normal, sub(of.corners[k], self.corners[0])) / length;
            if offset.abs() <= near { 0.0 } else { offset }
        };
        (length > 0.0).then(|| [offset(0), offset(1), offset(2)])
    }

    /// Where on the triangle a point of its plane lies; `None` if it is outside.
    fn locate(&self, p: Point, near: f64) -> Option<Location> {
        if let Some(k) = (0..3).find(|&k| distance(self.corners[k], p) <= near) {
            return Some(Location::Corner(k));
        }
        let to_edge = |k: usize| {
            let [a, b] = [self.corners[k], self.corners[(k + 1) % 3]];
            distance(add(a, scale(sub(b, a), segment::closest([a, b], p))), p)
        };
        if let Some(k) = (0..3).find(|&k| to_edge(k) <= near) {
            return Some(Location::Edge(k));
        }
        let normal = area_vector(self.corners);
        let is_within = |k: usize| {
            let [a, b] = [self.corners[k], self.corners[(k + 1) % 3]];
            dot(normal, cross(sub(b, a), sub(p, a))) > 0.0
        };
        (0..3).all(is_within).then_some(Location::Inside)
    }
}

impl Common {
    /// What two triangles have in common, `None` if nothing. Points nearer than `near` are one place.
    pub(super) fn of(a: &NumberedTriangle, b: &NumberedTriangle, near: f64) -> Option<Self> {
        let (of_a, of_b) = (b.offsets(a, near)?, a.offsets(b, near)?);
        if [of_a, of_b].iter().any(|o| o.iter().all(|x| *x > 0.0) || o.iter().all(|x| *x < 0.0)) {
            return None;
        }
        let mut common = Self::default();
        common.add_vertices(0, [a, b], of_a, near);
        common.add_vertices(1, [b, a], of_b, near);
        common.add_piercings(0, [a, b], of_a, near);
        common.add_piercings(1, [b, a], of_b, near);
        common.is_flat = of_a.iter().chain(&of_b).all(|x| *x == 0.0);
        if common.is_flat {
            common.add_crossings(a, b, near);
            common.join_along_edges([a, b]);
        } else {
            common.join_in_line();
        }
        (!common.points.is_empty()).then_some(common)
    }

    /// Whether the triangles have more in common than corners of both.
    pub(super) fn needs_division(&self) -> bool {
        self.points.iter().any(|p| !matches!(p.on, [Location::Corner(_), Location::Corner(_)]))
    }

    /// Whether the triangles cross: what they have in common is a segment that lies on no edge of either. If
    /// it lies on an edge, they touch.
    pub(super) fn is_crossing(&self) -> bool {
        let is_on_edge = |s: usize| (0..3).any(|k| self.points.iter().all(|p| p.on[s].is_along(k)));
        let is_pierced = self.points.iter().any(|p| matches!(p.key, PointKey::Through(..)));
        !self.is_flat && (is_pierced || self.points.len() > 1 && !is_on_edge(0) && !is_on_edge(1))
    }

    /// Whether the triangles overlap: they lie in one plane, with an area in common.
    pub(super) fn is_overlap(&self) -> bool {
        let is_on_edge = |s: usize| (0..3).any(|k| self.points.iter().all(|p| p.on[s].is_along(k)));
        self.is_flat && self.points.len() > 2 && !is_on_edge(0) && !is_on_edge(1)
    }

    /// The mean of the points that they have in common.
    pub(super) fn middle(&self) -> Point {
        let part = 1.0 / self.points.len() as f64;
        self.points.iter().fold([0.0; 3], |sum, p| add(sum, scale(p.at, part)))
    }

    /// Adds a point, unless one with this key is known. `on` states where it lies on triangle `first` of the
    /// two, and on the other.
    fn add(&mut self, first: usize, key: PointKey, at: Point, on: [Location; 2]) {
        let on = if first == 0 { on } else { [on[1], on[0]] };
        if !self.points.iter().any(|known| known.key == key) {
            self.points.push(Shared { key, at, on });
        }
    }

    /// Adds the vertices of `a` that lie on `b`.
    fn add_vertices(&mut self, first: usize, [a, b]: [&NumberedTriangle; 2], of_a: [f64; 3], near: f64) {
        for k in (0..3).filter(|&k| of_a[k] == 0.0) {
            let on = match b.vertices.iter().position(|v| *v == a.vertices[k]) {
                Some(corner) => Some(Location::Corner(corner)),
                None => b.locate(a.corners[k], near),
            };
            if let Some(on) = on {
                self.add(first, PointKey::Vertex(a.vertices[k]), a.corners[k], [Location::Corner(k), on]);
            }
        }
    }

    /// Adds the points in which edges of `a` pass through the plane of `b`, within `b`.
    fn add_piercings(&mut self, first: usize, [a, b]: [&NumberedTriangle; 2], of_a: [f64; 3], near: f64) {
        for k in 0..3 {
            let (of_k, of_next) = (of_a[k], of_a[(k + 1) % 3]);
            if of_k * of_next >= 0.0 {
                continue;
            }
            let (edge, [p, q]) = a.edge(k);
            let [from, to] = if edge[0] == a.vertices[k] { [of_k, of_next] } else { [of_next, of_k] };
            let at = add(p, scale(sub(q, p), from / (from - to)));
            let Some(on) = b.locate(at, near) else { continue };
            let (key, at) = match on {
                Location::Corner(corner) => (PointKey::Vertex(b.vertices[corner]), b.corners[corner]),
                Location::Edge(other) => (edges(edge, b.edge(other).0), at),
                Location::Inside => (PointKey::Through(edge, b.number), at),
            };
            self.add(first, key, at, [Location::Edge(k), on]);
        }
    }

    /// Adds the points in which edges cross within one plane.
    fn add_crossings(&mut self, a: &NumberedTriangle, b: &NumberedTriangle, near: f64) {
        let normal = area_vector(a.corners);
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let ((of_a, [p, q]), (of_b, [r, s])) = (a.edge(i), b.edge(j));
            if of_a.iter().any(|v| of_b.contains(v)) {
                continue;
            }
            let side = |from: Point, to: Point, x: Point| {
                let along = sub(to, from);
                let off = dot(normal, cross(along, sub(x, from))) / (norm(normal) * norm(along));
                if off.abs() <= near { 0.0 } else { off }
            };
            let (of_r, of_s) = (side(p, q, r), side(p, q, s));
            let (of_p, of_q) = (side(r, s, p), side(r, s, q));
            if of_r * of_s < 0.0 && of_p * of_q < 0.0 {
                let at = add(p, scale(sub(q, p), of_p / (of_p - of_q)));
                self.add(0, edges(of_a, of_b), at, [Location::Edge(i), Location::Edge(j)]);
            }
        }
    }

    /// Joins the points of triangles that are not in one plane: these points lie on a line.
    fn join_in_line(&mut self) {
        let far = |from: usize| {
            let off = |i: &usize| distance(self.points[from].at, self.points[*i].at);
            (0..self.points.len()).max_by(|i, j| off(i).total_cmp(&off(j)))
        };
        let Some(first) = far(0).and_then(far) else { return };
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        let off = |i: usize| distance(self.points[first].at, self.points[i].at);
        order.sort_by(|&i, &j| off(i).total_cmp(&off(j)));
        self.segments = order.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    }

    /// Joins the points of triangles in one plane along their edges, parts of which bound what they have in
    /// common.
    fn join_along_edges(&mut self, triangles: [&NumberedTriangle; 2]) {
        for (s, k) in [0, 1].into_iter().flat_map(|s| (0..3).map(move |k| (s, k))) {
            let start = triangles[s].corners[k];
            let mut along: Vec<usize> =
                (0..self.points.len()).filter(|&i| self.points[i].on[s].is_along(k)).collect();
            let off = |i: usize| distance(start, self.points[i].at);
            along.sort_by(|&i, &j| off(i).total_cmp(&off(j)));
            self.segments.extend(along.windows(2).map(|pair| [pair[0], pair[1]]));
        }
    }
}

/// The key of a crossing of two edges.
fn edges(a: [VertexId; 2], b: [VertexId; 2]) -> PointKey {
    PointKey::Edges(a.min(b), a.max(b))
}
