//! Whether volumes and areas may be rounding alone.

use crate::base::Point;
use crate::geometry::tet::volume;
use crate::geometry::triangle::area;
use crate::geometry::vector::{dot, sub};

/// If six times a volume is below this times the largest coordinate and the square of the longest edge, it
/// may be rounding alone.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Whether the volume of a tet may be rounding alone.
pub(super) fn is_flat(corners: [Point; 4]) -> bool {
    6.0 * volume(corners) <= rounding(&corners) * longest_squared(&corners)
}

/// Whether a triangle is so thin that no tet on it has a volume distinguishable from rounding.
pub(super) fn is_needle(corners: [Point; 3]) -> bool {
    2.0 * area(corners) <= rounding(&corners) * longest_squared(&corners).sqrt()
}

fn rounding(corners: &[Point]) -> f64 {
    ROUNDING * corners.as_flattened().iter().fold(0.0f64, |largest, x| largest.max(x.abs()))
}

fn longest_squared(corners: &[Point]) -> f64 {
    let squared = |p: Point, q: Point| dot(sub(q, p), sub(q, p));
    let to_others =
        |(i, p): (usize, &Point)| corners[..i].iter().map(|q| squared(*p, *q)).fold(0.0, f64::max);
    corners.iter().enumerate().map(to_others).fold(0.0, f64::max)
}
