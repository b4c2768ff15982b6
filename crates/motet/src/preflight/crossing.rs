//! Finds which triangles of two surfaces meet, or of one surface with itself: exact, touching included.
//!
//! Neighbours on a surface meet in the vertices that they share, which is not a crossing. Pairs with vertices
//! in common are therefore judged by what else they have in common:
//!
//! | shared | the pair counts if |
//! |---|---|
//! | no vertex | the triangles have a point in common |
//! | one vertex | the edge opposite to it, of one of them, meets the other: a path within both triangles away from the shared vertex leaves one of them through that edge |
//! | two vertices | both lie in one plane on the same side of the shared edge |
//! | all three | always: the triangle is duplicated |
//!
//! Vertices are shared if they have the same id. Two vertices with different ids at one place are points that
//! touch.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::distance::triangle_triangle;
use crate::geometry::distance::{segment_segment, segment_triangle};
use crate::geometry::predicates::{collinear, orient3d};
use crate::geometry::triangle::area_vector;
use crate::spatial::BoxTree;
use crate::spatial::runs::{bounding_box, corners, in_runs};

/// All pairs of a triangle of `a` and one of `b` that meet in more than the vertices and edges that they
/// share, in rising order.
///
/// Triangles with a corner that is not finite meet nothing. Triangles without area count as their edges.
///
/// Panics if a triangle names a point beyond `points`.
pub fn crossings(
    points: &[Point],
    a: &[[VertexId; 3]],
    b: &[[VertexId; 3]],
    threads: &Threads,
) -> Vec<[u32; 2]> {
    crossings_of(points, [a, b], threads, |_, _| true)
}

/// All pairs of triangles of one surface that meet in more than they share, the smaller id first, in rising
/// order.
///
/// Panics if a triangle names a point beyond `points`.
pub fn own_crossings(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Vec<[u32; 2]> {
    crossings_of(points, [triangles, triangles], threads, |i, j| i < j)
}

/// The pairs of a triangle of `a` and one of `b` that `admit` accepts and that meet in more than the vertices
/// and edges that they share, in rising order.
pub(super) fn crossings_of(
    points: &[Point],
    [a, b]: [&[[VertexId; 3]]; 2],
    threads: &Threads,
    admit: impl Fn(u32, u32) -> bool + Sync + Send,
) -> Vec<[u32; 2]> {
    let boxes: Vec<_> = b.iter().map(|&t| bounding_box(&corners(points, t))).collect();
    let tree = BoxTree::new(&boxes);
    in_runs(a.len(), threads, |near, run| {
        let mut found = Vec::new();
        for i in run {
            tree.touching(bounding_box(&corners(points, a[i])), near);
            let met = near.iter().filter(|&&j| admit(i as u32, j) && meet(points, a[i], b[j as usize]));
            found.extend(met.map(|&j| [i as u32, j]));
        }
        found
    })
}

/// Whether two triangles have more in common than the vertices and edges that they share by id.
pub(crate) fn meet(points: &[Point], a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    if are_beside(points, a, b) || are_beside(points, b, a) {
        return false;
    }
    let [of_a, of_b] = [a, b].map(|t| corners(points, t));
    if !a.iter().any(|v| b.contains(v)) {
        return triangle_triangle::meet(of_a, of_b);
    }
    let (shared, _) = distinct(a, |v| b.contains(&v));
    let ((rest_a, n_a), (rest_b, n_b)) = (distinct(a, |v| !b.contains(&v)), distinct(b, |v| !a.contains(&v)));
    let at = |v: VertexId| points[v.index()];
    match (n_a, n_b) {
        // The same vertices: a duplicated triangle, unless it is only an edge or a point.
        (0, 0) => distinct(a, |_| true).1 == 3,
        // One of them is an edge or a vertex of the other.
        (0, _) | (_, 0) => false,
        (1, 1) if shared[0] != shared[1] => {
            overlap_beyond_edge([at(shared[0]), at(shared[1])], at(rest_a[0]), at(rest_b[0]))
        }
        // With a single vertex left, the edge opposite is that vertex twice.
        _ => {
            segment_triangle::meet([at(rest_a[0]), at(rest_a[1])], of_b)
                || segment_triangle::meet([at(rest_b[0]), at(rest_b[1])], of_a)
        }
    }
}

/// The rounding error of twice the area of a triangle in a plane, relative to the sum of the absolute values
/// of its two products (Shewchuk 1997, *Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates*: 3 times 2^-53 and a little).
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Products below this may have lost bits to underflow.
const UNDERFLOW: f64 = 1e-290;

/// Whether a plane through an edge of `a`, along the axis nearest to its normal, has the rest of `a` on one
/// side and `b` on the other but for the vertices of that edge: they then have no other point in common.
/// `false` if that is not certain.
fn are_beside(points: &[Point], a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    let corners = corners(points, a);
    let normal = area_vector(corners);
    let axis = (0..3).fold(0, |most, k| if normal[k].abs() > normal[most].abs() { k } else { most });
    let seen = |p: Point| [p[(axis + 1) % 3], p[(axis + 2) % 3]];
    let [p, q, r] = corners.map(seen);
    let side = side_of([p, q], r);
    if side == 0 {
        return false;
    }
    [([a[0], a[1]], [p, q]), ([a[1], a[2]], [q, r]), ([a[2], a[0]], [r, p])].into_iter().any(
        |(edge, line)| b.iter().all(|v| edge.contains(v) || side_of(line, seen(points[v.index()])) == -side),
    )
}

/// The side of a line in a plane on which a point lies: 1, -1, or 0 if that is not certain.
fn side_of([p, q]: [[f64; 2]; 2], r: [f64; 2]) -> i8 {
    let [first, second] = [(q[0] - p[0]) * (r[1] - p[1]), (q[1] - p[1]) * (r[0] - p[0])];
    let error = ROUNDING * (first.abs() + second.abs()) + UNDERFLOW;
    match first - second {
        area if area > error => 1,
        area if area < -error => -1,
        _ => 0,
    }
}

/// The first and the last of the distinct vertices of a triangle that are `wanted`, and the number of these.
fn distinct(t: [VertexId; 3], wanted: impl Fn(VertexId) -> bool) -> ([VertexId; 2], usize) {
    let (mut ends, mut n) = ([t[0]; 2], 0);
    for (k, &v) in t.iter().enumerate() {
        if wanted(v) && !t[..k].contains(&v) {
            ends = if n == 0 { [v, v] } else { [ends[0], v] };
            n += 1;
        }
    }
    (ends, n)
}

/// Whether the triangles formed by an edge with `p` and with `q` have more in common than the edge.
fn overlap_beyond_edge(edge: [Point; 2], p: Point, q: Point) -> bool {
    let [u, v] = edge;
    if orient3d(u, v, p, q) != 0 {
        return false;
    }
    let flat = [collinear(u, v, p), collinear(u, v, q)];
    if u == v {
        return segment_segment::meet([u, p], [q, q]) || segment_segment::meet([u, q], [p, p]);
    }
    match flat {
        [false, false] => is_same_side(edge, p, q),
        // All on one line, along which points are ordered like their coordinates.
        [true, true] => {
            let (first, last) = if u < v { (u, v) } else { (v, u) };
            p < first && q < first || p > last && q > last
        }
        _ => false,
    }
}

/// Whether two points of one plane lie on the same side of a line in it; neither lies on the line.
fn is_same_side([u, v]: [Point; 2], p: Point, q: Point) -> bool {
    (0..3).map(|axis| segment_segment::beside(u, axis)).any(|apex| {
        let side = orient3d(u, v, p, apex);
        side != 0 && side == orient3d(u, v, q, apex)
    })
}
