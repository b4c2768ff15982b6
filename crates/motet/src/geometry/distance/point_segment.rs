//! The closest points of a point and a segment.

use super::Closest;
use super::frame::{Frame, offset};
use crate::base::Point;
use crate::geometry::segment;

/// The closest points of a point and a segment. A segment without length is treated as its first end.
pub fn closest(p: Point, segment: [Point; 2]) -> Closest<1, 2> {
    let (frame, p, segment) = Frame::around([p], segment);
    let on_b = weights(p[0], segment);
    frame.closest([1.0], on_b, offset(&p, &[1.0], &segment, &on_b))
}

/// Weights of the ends that give the point of the segment closest to `p`, in local coordinates; exactly 0 and
/// 1 at an end.
#[inline(always)]
pub(super) fn weights(p: Point, segment: [Point; 2]) -> [f64; 2] {
    let t = segment::closest(segment, p);
    [1.0 - t, t]
}
