//! A segment and a triangle: the exact test whether they meet, and where.

use super::segment_segment::{self, beside};
use crate::base::Point;
use crate::geometry::predicates::{collinear, exact, orient3d};

/// Whether a segment and a triangle have a point in common, borders included. The answer is exact. A triangle
/// without area is treated as its edges.
pub fn meet([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let (of_p, of_q) = (orient3d(a, b, c, p), orient3d(a, b, c, q));
    if of_p * of_q > 0 {
        return false;
    }
    if of_p != 0 || of_q != 0 {
        // The line of the segment meets the plane in one point, which lies in the triangle if the line has
        // all edges on one side.
        return on_one_hand([orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)]);
    }
    in_plane([p, q], [a, b, c])
}

/// [`meet`] for a segment in the plane of the triangle, or for a triangle without area.
#[cold]
fn in_plane([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> bool {
    let edges = [[a, b], [b, c], [c, a]];
    edges.iter().any(|&edge| segment_segment::meet([p, q], edge))
        || !collinear(a, b, c)
            && (0..3)
                .map(|axis| beside(a, axis))
                .find(|&apex| orient3d(a, b, c, apex) != 0)
                .is_some_and(|apex| on_one_hand(edges.map(|[from, to]| orient3d(from, to, p, apex))))
}

/// Whether no two signs are opposite.
fn on_one_hand(signs: [i8; 3]) -> bool {
    signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0)
}

/// Weights, on both primitives, of the point where a segment that meets the triangle crosses its plane;
/// accurate to the last digits, since they are ratios of exact determinants. `None` for a segment within the
/// plane.
#[cold]
pub(super) fn common_point([p, q]: [Point; 2], [a, b, c]: [Point; 3]) -> Option<([f64; 2], [f64; 3])> {
    let on_segment = shares(exact::orient3d_ratios([[a, b, c, q], [a, b, c, p]]))?;
    let on_triangle = shares(exact::orient3d_ratios([[p, q, b, c], [p, q, c, a], [p, q, a, b]]))?;
    Some((on_segment, on_triangle))
}

/// Absolute values as fractions of their sum; `None` where all are 0.
fn shares<const N: usize>(sizes: [f64; N]) -> Option<[f64; N]> {
    let sum: f64 = sizes.iter().map(|x| x.abs()).sum();
    (sum > 0.0).then(|| sizes.map(|x| x.abs() / sum))
}
