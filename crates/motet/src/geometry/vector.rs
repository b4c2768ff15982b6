//! The few vector operations that everything uses, on plain `[f64; 3]`.

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

/// Whether no coordinate is NaN or infinite: a sum of anything with one of these is neither. No branch for each.
#[inline(always)]
pub fn is_finite(a: Point) -> bool {
    (a[0] * 0.0 + a[1] * 0.0 + a[2] * 0.0) == 0.0
}

/// The largest coordinate that is reckoned with: volumes, their products and sums of those stay numbers.
pub const LARGEST: f64 = 1e60;

/// Whether the coordinates are numbers to reckon with: finite, and none beyond [`LARGEST`].
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

/// The same way, of length 1; `None` where it has no length, or one beyond numbers.
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

/// The part of `v` at right angles to `along`, projected twice: once leaves errors of the size of `v`, which may be more than
/// the part itself ("twice is enough", Kahan in Parlett 1980, *The symmetric eigenvalue problem*, 6-9). NaN where `along` has no length.
#[inline(always)]
pub fn across(v: Point, along: Point) -> Point {
    let per_length = 1.0 / dot(along, along);
    let once = sub(v, scale(along, dot(v, along) * per_length));
    sub(once, scale(along, dot(once, along) * per_length))
}
