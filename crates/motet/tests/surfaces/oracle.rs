//! Distances by brute force, with formulas that the library does not use.

use motet::base::Point;
use motet::geometry::vector::{add, cross, dot, scale, sub};

use super::Shape;

/// The distance from a point to a triangle by regions of the plane (Ericson 2005, *Real-time collision
/// detection*, 5.1.5), in coordinates relative to the point.
pub(crate) fn point_triangle(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let edges = segment_point(a, b, p).min(segment_point(b, c, p)).min(segment_point(c, a, p));
    let n = cross(sub(b, a), sub(c, a));
    if dot(n, n) == 0.0 {
        return edges;
    }
    let inside = [(a, b), (b, c), (c, a)].into_iter().all(|(u, v)| dot(cross(sub(v, u), sub(p, u)), n) > 0.0);
    if inside { edges.min(dot(sub(p, a), n).abs() / dot(n, n).sqrt()) } else { edges }
}

fn segment_point(a: Point, b: Point, p: Point) -> f64 {
    let (ab, ap) = (sub(b, a), sub(p, a));
    let length_squared = dot(ab, ab);
    let t = if length_squared == 0.0 { 0.0 } else { (dot(ap, ab) / length_squared).clamp(0.0, 1.0) };
    let off = sub(ap, scale(ab, t));
    dot(off, off).sqrt()
}

/// The distance of two segments: of ends from segments, and where the common perpendicular has both feet
/// inside, its length by the triple product.
pub(crate) fn segments([a, b]: [Point; 2], [c, d]: [Point; 2]) -> f64 {
    let ends = segment_point(a, b, c)
        .min(segment_point(a, b, d))
        .min(segment_point(c, d, a))
        .min(segment_point(c, d, b));
    let (u, v, w) = (sub(b, a), sub(d, c), sub(c, a));
    let n = cross(u, v);
    let n2 = dot(n, n);
    if n2 <= 1e-20 * dot(u, u) * dot(v, v) {
        return ends;
    }
    let (s, t) = (dot(cross(w, v), n) / n2, dot(cross(w, u), n) / n2);
    if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
        ends.min(dot(w, n).abs() / n2.sqrt())
    } else {
        ends
    }
}

/// Whether a segment passes through the interior of a triangle, by signs of volumes in floating point.
fn pierces([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let volume = |u: Point, v: Point, w: Point, x: Point| dot(cross(sub(v, u), sub(w, u)), sub(x, u));
    if volume(a, b, c, p) * volume(a, b, c, q) >= 0.0 {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0)
}

pub(crate) fn triangles(a: [Point; 3], b: [Point; 3]) -> f64 {
    let edges = |t: [Point; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut least = f64::INFINITY;
    for i in 0..3 {
        least = least.min(point_triangle(a[i], b)).min(point_triangle(b[i], a));
        for j in 0..3 {
            least = least.min(segments(edges(a)[i], edges(b)[j]));
        }
        if pierces(edges(a)[i], b) || pierces(edges(b)[i], a) {
            return 0.0;
        }
    }
    least
}

/// The distance from a point to the nearest triangle of a shape.
pub(crate) fn to_shape(p: Point, shape: &Shape) -> f64 {
    (0..shape.triangles.len()).map(|t| point_triangle(p, shape.corners(t))).fold(f64::INFINITY, f64::min)
}

/// The distance of two shapes.
pub(crate) fn shapes(a: &Shape, b: &Shape) -> f64 {
    let pairs = (0..a.triangles.len()).flat_map(|i| (0..b.triangles.len()).map(move |j| (i, j)));
    pairs.map(|(i, j)| triangles(a.corners(i), b.corners(j))).fold(f64::INFINITY, f64::min)
}

/// The largest distance of a point from the origin or from the first point, to which rounding is relative.
pub(crate) fn size(shapes: &[Shape]) -> f64 {
    let points = || shapes.iter().flat_map(|shape| &shape.points);
    let length = |p: Point| dot(p, p).sqrt();
    let first = points().next().copied().unwrap_or_default();
    points().map(|p| length(*p).max(length(add(*p, scale(first, -1.0))))).fold(0.0, f64::max)
}
