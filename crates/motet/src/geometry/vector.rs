//! The basic vector operations, on plain `[f64; 3]`.

use crate::base::Point;

/// `a - b`
#[inline(always)]
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + b`
#[inline(always)]
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `s a`
#[inline(always)]
pub fn scale(a: Point, s: f64) -> Point {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// `a . b`
#[inline(always)]
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a x b`
#[inline(always)]
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether no coordinate is NaN or infinite. Tested without branches: multiplied by 0, such a coordinate
/// makes the sum NaN.
#[inline(always)]
pub fn is_finite(a: Point) -> bool {
    (a[0] * 0.0 + a[1] * 0.0 + a[2] * 0.0) == 0.0
}

/// The largest coordinate supported: volumes, their products and the sums of those stay finite.
pub const LARGEST: f64 = 1e60;

/// Whether all coordinates are finite and none exceeds [`LARGEST`] in magnitude.
#[inline(always)]
pub fn in_range(a: Point) -> bool {
    (a[0].abs() <= LARGEST) & (a[1].abs() <= LARGEST) & (a[2].abs() <= LARGEST)
}

/// The largest absolute value of a coordinate; 0 without points.
pub fn largest_coordinate(points: &[Point]) -> f64 {
    points.as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// `|a|`
#[inline(always)]
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector in the direction of `v`; `None` where its length is 0 or not finite.
pub fn unit(v: Point) -> Option<Point> {
    let length = norm(v);
    (length > 0.0 && length.is_finite()).then(|| scale(v, 1.0 / length))
}

/// `|a - b|`
#[inline(always)]
pub fn distance(a: Point, b: Point) -> f64 {
    norm(sub(a, b))
}

/// `|a - b|^2`
#[inline(always)]
pub fn distance_squared(a: Point, b: Point) -> f64 {
    let d = sub(a, b);
    dot(d, d)
}

/// The component of `v` orthogonal to `along`, projected twice: one projection leaves errors of the size of
/// `v`, which may exceed the component itself ("twice is enough", Kahan in Parlett 1980, *The symmetric
/// eigenvalue problem*, 6-9). NaN where `along` has no length.
#[inline(always)]
pub fn across(v: Point, along: Point) -> Point {
    let per_length = 1.0 / dot(along, along);
    let once = sub(v, scale(along, dot(v, along) * per_length));
    sub(once, scale(along, dot(once, along) * per_length))
}
