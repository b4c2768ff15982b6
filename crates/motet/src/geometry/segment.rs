//! The segment: the point of it closest to another.

use crate::base::Point;
use crate::geometry::vector::{dot, sub};

/// How far along from `a` (0) to `b` (1) the point of the segment lies that is
/// closest to `p`; 0 when the segment has no length.
#[inline]
pub fn closest([a, b]: [Point; 2], p: Point) -> f64 {
    let along = sub(b, a);
    let t = dot(along, sub(p, a)) / dot(along, along);
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 }
}
