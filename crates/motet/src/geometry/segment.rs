//! The segment, and the point on it closest to a given point.

use crate::base::Point;
use crate::geometry::vector::{dot, sub};

/// The point of the segment closest to `p`, as the fraction of the way from `a` (0) to `b` (1); 0 when the
/// segment has no length.
#[inline]
pub fn closest([a, b]: [Point; 2], p: Point) -> f64 {
    let along = sub(b, a);
    let t = dot(along, sub(p, a)) / dot(along, along);
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 }
}

/// The point at a fraction of the way from `a` (0) to `b` (1).
#[inline]
pub fn at([a, b]: [Point; 2], share: f64) -> Point {
    std::array::from_fn(|k| a[k] + share * (b[k] - a[k]))
}
