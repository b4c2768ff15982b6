//! The triangle: area vector, centroid, angles, and the point on it closest to a given point; the normal of a
//! surface where triangles meet.

mod needle;

use std::ops::Range;

use crate::base::Point;
use crate::geometry::vector::{self, add, cross, distance, dot, norm, scale, sub, unit};

/// Half the cross product of two sides: its length is the area, its direction the normal (from its tip the
/// triangle is seen counter-clockwise).
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

/// The centroid.
pub fn centroid([a, b, c]: [Point; 3]) -> Point {
    scale(add(add(a, b), c), 1.0 / 3.0)
}

/// The point with these barycentric coordinates.
#[inline]
pub fn at([a, b, c]: [Point; 3], weights: [f64; 3]) -> Point {
    add(add(scale(a, weights[0]), scale(b, weights[1])), scale(c, weights[2]))
}

/// The angle at a corner, in radians.
pub fn angle_at(triangle: [Point; 3], corner: usize) -> f64 {
    let [u, v] = [1, 2].map(|k| sub(triangle[(corner + k) % 3], triangle[corner]));
    norm(cross(u, v)).atan2(dot(u, v))
}

/// The cosine of the smallest angle; 1 if a side has no length.
pub fn largest_cosine(triangle: [Point; 3]) -> f64 {
    let cosine = |corner: usize| {
        let [u, v] = [1, 2].map(|k| sub(triangle[(corner + k) % 3], triangle[corner]));
        let lengths = norm(u) * norm(v);
        if lengths > 0.0 { dot(u, v) / lengths } else { 1.0 }
    };
    cosine(0).max(cosine(1)).max(cosine(2))
}

/// The length of the longest side.
pub fn longest_side([a, b, c]: [Point; 3]) -> f64 {
    distance(a, b).max(distance(b, c)).max(distance(c, a))
}

/// The middles of the sides, and the centroid.
pub fn middles([a, b, c]: [Point; 3]) -> [Point; 4] {
    let half = |p: Point, q: Point| scale(add(p, q), 0.5);
    [half(a, b), half(b, c), half(c, a), centroid([a, b, c])]
}

/// The normal, not of unit length, of a surface at a place shared by all these triangles: the sum of their
/// unit normals, at a vertex weighted by their angles there. `corner` is the number of the corner that lies
/// at the place, if any. The sign of the normal shows on which side of the surface a point lies whose nearest
/// place this is (Baerentzen and Aanaes 2005). Triangles without area are ignored.
pub fn normal_where_they_meet(around: impl IntoIterator<Item = ([Point; 3], Option<usize>)>) -> Point {
    let of = |(triangle, corner): ([Point; 3], Option<usize>)| {
        let weight = corner.map_or(1.0, |corner| angle_at(triangle, corner));
        unit(area_vector(triangle)).map_or([0.0; 3], |normal| scale(normal, weight))
    };
    around.into_iter().map(of).fold([0.0; 3], add)
}

/// A triangle is well shaped when its height is more than a tenth of its longest edge (here both are
/// squared). The plain formulas then lose at most one digit; for needles, among 20,000 triangles with a point
/// near or on them, they were off by up to 4e-4 of the extent.
const WELL_SHAPED: f64 = 0.01;
/// Range in which squares of areas, which are fourth powers of lengths, are trusted: their sums and products
/// then lose no digits.
const FOURTH_POWERS: Range<f64> = 1e-280..1e280;

/// Weights of the vertices, each in [0, 1] with sum 1 up to rounding, that give the point of the triangle
/// closest to `p`; exactly 0 for vertices not on the feature that contains the point.
///
/// The closest point is the foot of the perpendicular where that lies inside, else the nearest of the closest
/// points of the edges. The distance is accurate to about 1e-15 of the *extent*, the size of triangle and
/// point together, for any shape (`needle.rs` explains why), in any unit and for any origin. A triangle
/// without area is treated as its edges.
#[inline(always)]
pub fn closest(triangle: [Point; 3], p: Point) -> [f64; 3] {
    let [a, b, c] = triangle;
    let edges = [sub(b, a), sub(c, b), sub(a, c)];
    let squares = [dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2])];
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    let longest_squared = larger(larger(squares[0], squares[1]), squares[2]);
    let normal = cross(edges[0], sub(c, a));
    let square = dot(normal, normal);
    if !is_well_shaped(square, longest_squared) {
        return needle::closest(triangle, p);
    }
    let from_p = [sub(a, p), sub(b, p), sub(c, p)];
    foot(from_p, normal).unwrap_or_else(|| on_edges(from_p, edges, squares))
}

/// The squared distance of a point from a triangle.
#[inline]
pub fn distance_squared(triangle: [Point; 3], p: Point) -> f64 {
    vector::distance_squared(at(triangle, closest(triangle, p)), p)
}

/// Whether plain formulas serve for a triangle with this square of twice its area and of its longest side.
#[inline(always)]
pub(crate) fn is_well_shaped(square: f64, longest_squared: f64) -> bool {
    FOURTH_POWERS.contains(&square) && square > WELL_SHAPED * longest_squared * longest_squared
}

/// Weights of the foot of the perpendicular from the origin; `None` when it lies outside.
#[inline(always)]
fn foot([a, b, c]: [Point; 3], normal: Point) -> Option<[f64; 3]> {
    let parts = [dot(normal, cross(b, c)), dot(normal, cross(c, a)), dot(normal, cross(a, b))];
    if parts[0] < 0.0 || parts[1] < 0.0 || parts[2] < 0.0 {
        return None;
    }
    let scale = 1.0 / (parts[0] + parts[1] + parts[2]);
    let weights = [parts[0] * scale, parts[1] * scale, parts[2] * scale];
    weights.iter().all(|w| (0.0..=1.0).contains(w)).then_some(weights)
}

/// Weights of the point of the edges closest to the origin. Edge `i` runs from vertex `i` to the next vertex.
#[inline(always)]
fn on_edges(triangle: [Point; 3], edges: [Point; 3], squares: [f64; 3]) -> [f64; 3] {
    let (mut best, mut least) = ([1.0, 0.0, 0.0], f64::INFINITY);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        // The edges of well-shaped triangles have nonzero length.
        let t = (-dot(edges[i], triangle[i]) / squares[i]).clamp(0.0, 1.0);
        let point = add(scale(triangle[i], 1.0 - t), scale(triangle[j], t));
        let distance_squared = dot(point, point);
        if distance_squared < least {
            least = distance_squared;
            best = [0.0; 3];
            (best[i], best[j]) = (1.0 - t, t);
        }
    }
    best
}
