//! Divides one triangle into pieces such that every point on it is a vertex and every segment an edge.
//!
//! Points are inserted one by one; edges that cross a segment are flipped until it is an edge (Sloan 1993, *A
//! fast algorithm for generating constrained Delaunay triangulations*), then the others until opposite angles
//! sum to no more than 180 degrees (Lawson 1977). Points on an edge of the triangle count as collinear,
//! however they are rounded; all others are seen from one point beside the plane, with exact signs.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use crate::base::Point;
use crate::geometry::distance::segment_segment::beside;
use crate::geometry::predicates::orient3d;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{cross, dot, norm, sub};

/// A walk of more steps than this goes around in circles, or takes longer than testing all triangles.
const MAX_WALK_STEPS: usize = 1000;

/// With more points than this, many edges are in the way of a segment.
const MANY: usize = 64;

/// After this many flips, they go around in circles.
const MAX_FLIPS: usize = 10_000;

/// An edge is flipped if the cotangents of its opposite angles sum to less than this: slightly below 0, so
/// that ties stay as they are.
const FLAT: f64 = -1e-9;

/// A triangle and its pieces. Points are indices into `points`, which starts with the corners.
pub(super) struct Plane<'a> {
    points: &'a [Point],
    /// Which edges of the triangle each point lies on, as bits.
    on: Vec<u8>,
    beside: Point,
    turn: i8,
    /// For each directed edge, the vertex opposite to it in the triangle on its left.
    apex: BTreeMap<[usize; 2], usize>,
    fixed: BTreeSet<[usize; 2]>,
    /// The point that was inserted last, or a corner.
    last: usize,
}

impl<'a> Plane<'a> {
    /// The first three points are the corners; `on_edges[k]` has those between corner `k` and the next, in
    /// their order. `None` if the triangle has no area.
    pub(super) fn new(points: &'a [Point], on_edges: &[Vec<usize>; 3]) -> Option<Self> {
        let normal = area_vector([points[0], points[1], points[2]]);
        let axis = (0..3).max_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))?;
        let beside = beside(points[0], axis);
        let mut on = vec![0u8; points.len()];
        (on[0], on[1], on[2]) = (0b101, 0b011, 0b110);
        for (k, list) in on_edges.iter().enumerate() {
            list.iter().for_each(|&i| on[i] |= 1 << k);
        }
        let turn = orient3d(points[0], points[1], points[2], beside);
        let mut plane =
            Self { points, on, beside, turn, apex: BTreeMap::new(), fixed: BTreeSet::new(), last: 0 };
        plane.add([0, 1, 2]);
        for (k, list) in on_edges.iter().enumerate() {
            let mut from = k;
            for &p in list {
                plane.divide_edge([from, (k + 1) % 3], p);
                from = p;
            }
        }
        (turn != 0).then_some(plane)
    }

    fn side(&self, [i, j, k]: [usize; 3]) -> i8 {
        if self.on[i] & self.on[j] & self.on[k] != 0 {
            return 0;
        }
        self.turn * orient3d(self.points[i], self.points[j], self.points[k], self.beside)
    }

    fn add(&mut self, [i, j, k]: [usize; 3]) {
        self.apex.extend([([i, j], k), ([j, k], i), ([k, i], j)]);
    }

    fn remove(&mut self, [i, j, k]: [usize; 3]) {
        [[i, j], [j, k], [k, i]].iter().for_each(|edge| {
            self.apex.remove(edge);
        });
    }

    /// Inserts a point on an edge, on both sides of it.
    fn divide_edge(&mut self, [i, j]: [usize; 2], p: usize) {
        for [i, j] in [[i, j], [j, i]] {
            if let Some(&k) = self.apex.get(&[i, j]) {
                self.remove([i, j, k]);
                self.add([i, p, k]);
                self.add([p, j, k]);
            }
        }
    }

    /// Each triangle once, in rising order.
    pub(super) fn triangles(&self) -> Vec<[usize; 3]> {
        let firsts = self.apex.iter().filter(|([i, j], k)| i < j && i < *k);
        firsts.map(|([i, j], k)| [*i, *j, *k]).collect()
    }

    /// Inserts a point within the triangle. `None` if it does not lie there, or is at a vertex.
    pub(super) fn insert(&mut self, p: usize) -> Option<()> {
        let [i, j, k] = self.walk_to(p).or_else(|| {
            self.triangles()
                .into_iter()
                .find(|&[i, j, k]| [[i, j, p], [j, k, p], [k, i, p]].iter().all(|&turn| self.side(turn) >= 0))
        })?;
        let edges = [[i, j, k], [j, k, i], [k, i, j]];
        let sides = edges.map(|[i, j, _]| self.side([i, j, p]));
        match edges.iter().zip(sides).filter(|(_, side)| *side == 0).collect::<Vec<_>>()[..] {
            [] => {
                self.remove([i, j, k]);
                edges.iter().for_each(|&[i, j, _]| self.add([i, j, p]));
            }
            [(&[i, j, _], _)] => self.divide_edge([i, j], p),
            _ => return None,
        }
        self.last = p;
        Some(())
    }

    /// The triangle that contains a point, found by walking from the point that was inserted last. `None` if
    /// the walk leaves the triangle or takes too many steps.
    fn walk_to(&self, p: usize) -> Option<[usize; 3]> {
        let (&[mut i, mut j], &(mut k)) = self.apex.range([self.last, 0]..).next()?;
        for _ in 0..MAX_WALK_STEPS {
            let beyond = [[i, j], [j, k], [k, i]].into_iter().find(|&[u, v]| self.side([u, v, p]) < 0);
            let Some([u, v]) = beyond else { return Some([i, j, k]) };
            (i, j, k) = (v, u, *self.apex.get(&[v, u])?);
        }
        None
    }

    /// Makes a segment an edge, or several if points lie on it. `None` if another segment is in the way.
    pub(super) fn insert_segment(&mut self, [p, q]: [usize; 2]) -> Option<()> {
        if self.on[p] & self.on[q] != 0 {
            return Some(());
        }
        let mut from = p;
        while from != q {
            let is_there = |plane: &Self, to| {
                plane.apex.contains_key(&[from, to]) || plane.apex.contains_key(&[to, from])
            };
            let to = if is_there(self, q) { q } else { self.next_vertex_on_segment(from, q)? };
            if !is_there(self, to) {
                self.flip_crossing_edges([from, to])?;
            }
            self.fixed.extend([[from, to], [to, from]]);
            from = to;
        }
        Some(())
    }

    /// The first vertex on the segment from `p` to `q`: `q` itself if there is none between.
    fn next_vertex_on_segment(&self, p: usize, q: usize) -> Option<usize> {
        let is_between = |v: usize| {
            let [to_v, to_q] = [v, q].map(|v| sub(self.points[v], self.points[p]));
            let ahead = dot(to_v, to_q);
            ahead > 0.0 && ahead < dot(to_q, to_q)
        };
        let on_segment = (0..self.points.len()).filter(|&v| v != p && v != q && self.is_vertex(v));
        let on_segment = on_segment.filter(|&v| self.side([p, q, v]) == 0 && is_between(v));
        let off = |v: usize| norm(sub(self.points[v], self.points[p]));
        on_segment.min_by(|&v, &w| off(v).total_cmp(&off(w))).or(Some(q))
    }

    fn is_vertex(&self, v: usize) -> bool {
        self.apex.range([v, 0]..[v + 1, 0]).next().is_some()
    }

    /// Flips the edges that cross the segment between two vertices, on which no other vertex lies. `None` if
    /// it does not become an edge.
    fn flip_crossing_edges(&mut self, [p, q]: [usize; 2]) -> Option<()> {
        let crosses = |plane: &Self, [a, b]: [usize; 2]| {
            ![p, q].iter().any(|v| [a, b].contains(v))
                && plane.side([p, q, a]) * plane.side([p, q, b]) < 0
                && plane.side([a, b, p]) * plane.side([a, b, q]) < 0
        };
        let edges = self.apex.keys().copied().filter(|[i, j]| i < j);
        let mut todo: VecDeque<[usize; 2]> = edges.filter(|&edge| crosses(self, edge)).collect();
        let mut n_tried = 0;
        while let Some([a, b]) = todo.pop_front() {
            n_tried += 1;
            if n_tried > MAX_FLIPS || self.fixed.contains(&[a, b]) {
                return None;
            }
            match self.flip([a, b]) {
                None => todo.push_back([a, b]),
                Some(edge) if crosses(self, edge) => todo.push_back(edge),
                Some(_) => {}
            }
        }
        let is_there = self.apex.contains_key(&[p, q]) || self.apex.contains_key(&[q, p]);
        is_there.then_some(())
    }

    /// Flips an edge if its two triangles form a convex quadrilateral; returns the other diagonal.
    fn flip(&mut self, [a, b]: [usize; 2]) -> Option<[usize; 2]> {
        let (c, d) = (*self.apex.get(&[a, b])?, *self.apex.get(&[b, a])?);
        if self.side([a, d, c]) <= 0 || self.side([d, b, c]) <= 0 {
            return None;
        }
        self.remove([a, b, c]);
        self.remove([b, a, d]);
        self.add([a, d, c]);
        self.add([d, b, c]);
        Some([c, d])
    }

    /// Flips edges that are not Delaunay if there are many points, so that few edges are in the way of
    /// segments.
    pub(super) fn restore_delaunay_if_many(&mut self) {
        if self.points.len() > MANY {
            self.restore_delaunay();
        }
    }

    /// Flips edges that are not Delaunay and not fixed.
    pub(super) fn restore_delaunay(&mut self) {
        let mut todo: VecDeque<[usize; 2]> = self.apex.keys().copied().filter(|[i, j]| i < j).collect();
        for _ in 0..MAX_FLIPS.max(todo.len() * todo.len()) {
            let Some([a, b]) = todo.pop_front() else { return };
            let (Some(&c), Some(&d)) = (self.apex.get(&[a, b]), self.apex.get(&[b, a])) else { continue };
            if self.fixed.contains(&[a, b]) || self.cotangent(c, a, b) + self.cotangent(d, a, b) >= FLAT {
                continue;
            }
            if self.flip([a, b]).is_some() {
                todo.extend([[a, d], [d, b], [b, c], [c, a]]);
            }
        }
    }

    /// The cotangent of the angle at `apex`.
    fn cotangent(&self, apex: usize, a: usize, b: usize) -> f64 {
        let [u, v] = [a, b].map(|i| sub(self.points[i], self.points[apex]));
        dot(u, v) / norm(cross(u, v)).max(f64::MIN_POSITIVE)
    }
}
