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
pub fn at([a, b, c]: [Point; 3], weights: [f64; 3]) -> Point {
    add(add(scale(a, weights[0]), scale(b, weights[1])), scale(c, weights[2]))
}

/// Weights of the vertices, each in [0, 1] and 1 in sum, that give the point of
/// the triangle closest to `p`.
///
/// The nearest of four candidates: the foot of the perpendicular, where it lies
/// inside, and the closest point of each edge. No tolerance, hence the same at
/// any unit; where a needle spoils the foot, the edges are as close to it as the
/// needle is thin; a triangle without area is its edges.
pub fn closest(triangle: [Point; 3], p: Point) -> [f64; 3] {
    let on_edges = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
        let t = segment::closest([triangle[i], triangle[j]], p);
        let mut weights = [0.0; 3];
        weights[i] = 1.0 - t;
        weights[j] = t;
        weights
    });
    let distance_squared = |weights: &[f64; 3]| {
        let offset = sub(at(triangle, *weights), p);
        dot(offset, offset)
    };
    on_edges
        .into_iter()
        .chain(foot(triangle, p))
        .map(|weights| (distance_squared(&weights), weights))
        .min_by(|x, y| x.0.total_cmp(&y.0))
        .map_or([1.0, 0.0, 0.0], |(_, weights)| weights)
}

/// Weights of the foot of the perpendicular from `p`; `None` when it lies outside.
fn foot([a, b, c]: [Point; 3], p: Point) -> Option<[f64; 3]> {
    let normal = cross(sub(b, a), sub(c, a));
    let parts = [[b, c], [c, a], [a, b]].map(|[from, to]| dot(normal, cross(sub(to, from), sub(p, from))));
    let weights = parts.map(|part| part / (parts[0] + parts[1] + parts[2]));
    weights.iter().all(|w| (0.0..=1.0).contains(w)).then_some(weights)
}
