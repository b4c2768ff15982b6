//! Two segments: their closest points, and the exact test whether they meet.

use super::frame::{Frame, offset};
use super::{Closest, point_segment};
use crate::base::Point;
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::{across, add, dot, scale, sub};

/// The closest points of two segments: the nearest among the pair within both segments, where there is one,
/// and the four pairs of an end with its closest point on the other segment. Parallel segments and those
/// without length have a closest pair of the latter kind. A badly conditioned pair within nearly parallel
/// segments is still a pair of points of the segments: it can be too far apart only by rounding, unless one
/// of the other four pairs is as near (see the parent module).
pub fn closest(a: [Point; 2], b: [Point; 2]) -> Closest<2, 2> {
    let (frame, a, b) = Frame::around(a, b);
    let ends = [
        ([1.0, 0.0], point_segment::weights(a[0], b)),
        ([0.0, 1.0], point_segment::weights(a[1], b)),
        (point_segment::weights(b[0], a), [1.0, 0.0]),
        (point_segment::weights(b[1], a), [0.0, 1.0]),
    ];
    let measured = |(on_a, on_b)| {
        let offset = offset(&a, &on_a, &b, &on_b);
        (dot(offset, offset), on_a, on_b, offset)
    };
    let mut best = measured(ends[0]);
    for pair in ends[1..].iter().copied().chain(within(a, b)) {
        let found = measured(pair);
        if found.0 < best.0 {
            best = found;
        }
    }
    frame.closest(best.1, best.2, best.3)
}

/// Weights of the closest points of the two lines, if they lie within both segments. In local coordinates.
#[inline(always)]
pub(super) fn within(a: [Point; 2], b: [Point; 2]) -> Option<([f64; 2], [f64; 2])> {
    let (along_a, along_b, from_a_to_b) = (sub(a[1], a[0]), sub(b[1], b[0]), sub(b[0], a[0]));
    let across = across(along_b, along_a);
    let t = -dot(from_a_to_b, across) / dot(across, across);
    // False for NaN as well.
    if !(t > 0.0 && t < 1.0) {
        return None;
    }
    let s = dot(add(from_a_to_b, scale(along_b, t)), along_a) / dot(along_a, along_a);
    (s > 0.0 && s < 1.0).then_some(([1.0 - s, s], [1.0 - t, t]))
}

/// Whether two segments have a point in common, ends included. The answer is exact.
pub fn meet([p, q]: [Point; 2], [r, s]: [Point; 2]) -> bool {
    if orient3d(p, q, r, s) != 0 {
        return false;
    }
    let Some(apex) = off_plane([p, q, r, s]) else { return boxes_touch([p, q], [r, s]) };
    let side = |a: Point, b: Point, c: Point| orient3d(a, b, c, apex);
    let [of_r, of_s, of_p, of_q] = [side(p, q, r), side(p, q, s), side(r, s, p), side(r, s, q)];
    of_r * of_s <= 0 && of_p * of_q <= 0
}

/// A point off the plane of four coplanar points; `None` if they are collinear. Orientations within that
/// plane are given by `orient3d` with this point last.
fn off_plane([p, q, r, s]: [Point; 4]) -> Option<Point> {
    (0..3).map(|axis| beside(p, axis)).find(|&apex| {
        [[p, q, r], [p, q, s], [r, s, p], [r, s, q]].iter().any(|&[a, b, c]| orient3d(a, b, c, apex) != 0)
    })
}

/// A point that differs from `p` along this axis only.
pub(crate) fn beside(mut p: Point, axis: usize) -> Point {
    let lowered = p[axis] / 2.0 - 1.0;
    p[axis] = if lowered == p[axis] { p[axis] + 1.0 } else { lowered };
    p
}

/// Whether the boxes around two segments touch. Collinear segments meet exactly when their boxes touch.
fn boxes_touch([p, q]: [Point; 2], [r, s]: [Point; 2]) -> bool {
    (0..3).all(|k| p[k].min(q[k]) <= r[k].max(s[k]) && r[k].min(s[k]) <= p[k].max(q[k]))
}
