//! Whether two places of surfaces see each other through free space.

use super::body::Prepared;
use super::side::Side;
use crate::base::Point;
use crate::geometry::vector::{dot, norm, scale, sub};

/// The least cosine between a normal and the way across the gap: 75 degrees. Neighbours on one smooth surface lie at right
/// angles to its normal; on a convex edge or corner that is nearest to something, some triangle is within 75 degrees.
const LEAST_COSINE: f64 = 0.25;

/// Whether the way `out` from a triangle with this normal goes into free space.
fn goes_free(free: Side, normal: Point, out: Point) -> bool {
    let cosine = dot(normal, out);
    match free {
        Side::Both => cosine.abs() > LEAST_COSINE,
        Side::Outside => cosine > LEAST_COSINE,
        Side::Inside => cosine < -LEAST_COSINE,
    }
}

/// How far rounding may move a point off a plane, as a part of how far it is from a point in it.
const ROUNDING: f64 = 1e-15;

/// The cosine between the normals of two triangles that face away from each other as far as they may.
const LEAST_TURN: f64 = 1.0 - 2.0 * LEAST_COSINE * LEAST_COSINE;

/// Whether two triangles may face each other anywhere. It is a quick look that spares most neighbours the measuring: their normals
/// are too much alike, or one lies behind the other. A coil of 51,304 triangles is measured against itself in a third of the time.
pub(super) fn may_face(points: &[Point], [a, b]: [&Prepared; 2], [i, j]: [u32; 2]) -> bool {
    let (normal_a, normal_b) = (a.normal(points, i), b.normal(points, j));
    let turn = dot(normal_a, normal_b);
    let is_alike = match (a.free, b.free) {
        (Side::Both, _) | (_, Side::Both) => false,
        (own, other) if own == other => turn > LEAST_TURN,
        _ => turn < -LEAST_TURN,
    };
    let (corners_a, corners_b) = (a.corners(points, i), b.corners(points, j));
    !is_alike
        && !is_behind(a.free, normal_a, corners_a[0], corners_b)
        && !is_behind(b.free, normal_b, corners_b[0], corners_a)
}

/// Whether all corners are on the side of a plane that is not free.
fn is_behind(free: Side, normal: Point, within: Point, corners: [Point; 3]) -> bool {
    let sign = match free {
        Side::Both => return false,
        Side::Outside => 1.0,
        Side::Inside => -1.0,
    };
    corners.iter().all(|&corner| {
        let off = sub(corner, within);
        sign * dot(normal, off) < -ROUNDING * norm(off)
    })
}

/// Whether some triangle of `star` of body `a` and triangle `j` of `b` face each other along the way from `from` to `to`. Places that touch
/// face each other.
pub(super) fn is_facing(
    points: &[Point],
    (a, star): (&Prepared, &[u32]),
    (b, j): (&Prepared, u32),
    [from, to]: [Point; 2],
) -> bool {
    let way = sub(to, from);
    let length = norm(way);
    if length == 0.0 {
        return true;
    }
    let way = scale(way, 1.0 / length);
    goes_free(b.free, b.normal(points, j), scale(way, -1.0))
        && star.iter().any(|&i| goes_free(a.free, a.normal(points, i), way))
}
