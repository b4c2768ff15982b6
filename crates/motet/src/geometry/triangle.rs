//! The triangle: area vector, centre, and the point of it closest to another.

use crate::base::Point;
use crate::geometry::segment;
use crate::geometry::vector::{add, cross, dot, scale, sub};

/// Half the cross product: as long as the triangle is large, along its normal
/// (counter-clockwise seen from its tip).
#[inline]
pub fn area_vector([a, b, c]: [Point; 3]) -> Point {
    scale(cross(sub(b, a), sub(c, a)), 0.5)
}

/// The area.
#[inline]
pub fn area(triangle: [Point; 3]) -> f64 {
    let n = area_vector(triangle);
    dot(n, n).sqrt()
}

/// The centre of gravity.
pub fn centroid([a, b, c]: [Point; 3]) -> Point {
    scale(add(add(a, b), c), 1.0 / 3.0)
}

/// The point with these weights of the vertices.
#[inline]
pub fn at([a, b, c]: [Point; 3], weights: [f64; 3]) -> Point {
    add(add(scale(a, weights[0]), scale(b, weights[1])), scale(c, weights[2]))
}

/// Below this squared sine of the angle between its sides a triangle is a needle,
/// whose normal rounding may turn. A fast path only: either side of it gives the closest point.
const NEEDLE: f64 = 1e-8;

/// Weights of the vertices, each in [0, 1] and 1 in sum, that give the point of
/// the triangle closest to `p`.
///
/// The nearest of four candidates: the foot of the perpendicular, where it lies
/// inside, and the closest point of each edge. No tolerance, hence the same at
/// any unit; where a needle spoils the foot, the edges are as close to it as the
/// needle is thin; a triangle without area is its edges.
#[inline]
pub fn closest(triangle: [Point; 3], p: Point) -> [f64; 3] {
    let [a, b, c] = triangle;
    let (ab, ac) = (sub(b, a), sub(c, a));
    let normal = cross(ab, ac);
    let foot = foot(triangle, normal, p);
    let is_needle = dot(normal, normal) < NEEDLE * dot(ab, ab) * dot(ac, ac);
    match foot {
        Some(weights) if !is_needle => weights,
        _ => closest_of(triangle, foot, p),
    }
}

/// Weights of the foot of the perpendicular from `p`; `None` when it lies outside.
#[inline(always)]
fn foot([a, b, c]: [Point; 3], normal: Point, p: Point) -> Option<[f64; 3]> {
    let (pa, pb, pc) = (sub(a, p), sub(b, p), sub(c, p));
    let parts = [dot(normal, cross(pb, pc)), dot(normal, cross(pc, pa)), dot(normal, cross(pa, pb))];
    if parts[0] < 0.0 || parts[1] < 0.0 || parts[2] < 0.0 {
        return None;
    }
    let scale = 1.0 / (parts[0] + parts[1] + parts[2]);
    let weights = [parts[0] * scale, parts[1] * scale, parts[2] * scale];
    weights.iter().all(|w| (0.0..=1.0).contains(w)).then_some(weights)
}

/// The nearest of the foot, if there is one, and the closest points of the edges.
#[inline(always)]
fn closest_of(triangle: [Point; 3], foot: Option<[f64; 3]>, p: Point) -> [f64; 3] {
    let distance_squared = |weights: [f64; 3]| {
        let offset = sub(at(triangle, weights), p);
        dot(offset, offset)
    };
    let mut best = foot.unwrap_or([1.0, 0.0, 0.0]);
    let mut least = distance_squared(best);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let t = segment::closest([triangle[i], triangle[j]], p);
        let mut weights = [0.0; 3];
        weights[i] = 1.0 - t;
        weights[j] = t;
        let distance_squared = distance_squared(weights);
        if distance_squared < least {
            (best, least) = (weights, distance_squared);
        }
    }
    best
}
