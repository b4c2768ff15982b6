//! The paper's own distances in a tet, kept for comparison; nothing else uses them.

use super::{GapKind, GapTet};
use crate::base::Point;
use crate::geometry::distance::point_triangle;
use crate::geometry::vector::{cross, distance, dot, norm, sub};

/// The distance of two skew edges according to Moyle and Ventikos (2008, figure 10): that of their lines if
/// both feet of the common perpendicular lie within the edges, and otherwise the shortest of the four edges
/// that join their ends.
///
/// The second case overestimates wherever the point of one edge that is nearest to an end of the other lies
/// in its interior.
pub fn two_two([p, q]: [Point; 2], [r, s]: [Point; 2]) -> f64 {
    let (u, v, w) = (sub(q, p), sub(s, r), sub(r, p));
    let normal = cross(u, v);
    let normal_squared = dot(normal, normal);
    let (along_u, along_v) =
        (dot(cross(w, v), normal) / normal_squared, dot(cross(w, u), normal) / normal_squared);
    if (0.0..=1.0).contains(&along_u) && (0.0..=1.0).contains(&along_v) {
        return dot(w, normal).abs() / norm(normal);
    }
    [distance(p, r), distance(p, s), distance(q, r), distance(q, s)].into_iter().fold(f64::INFINITY, f64::min)
}

/// The distance of a vertex and a facet: to its plane, its edges or its vertices, whichever has the foot
/// (figure 9 there).
pub fn three_one(facet: [Point; 3], lone: Point) -> f64 {
    point_triangle::closest(lone, facet).distance()
}

/// The paper's distance in a gap tet, which takes every edge and facet of the tet for one of the surfaces;
/// `None` for kinds of tets that the paper does not treat.
pub fn within(tet: &GapTet, points: &[Point]) -> Option<f64> {
    let corners = tet.corners()?.map(|v| points[v.index()]);
    match tet.kind {
        GapKind::TwoTwo => {
            let [p, q, r, s] = corners;
            Some(two_two([p, q], [r, s]))
        }
        GapKind::ThreeOne => {
            let [p, q, r, lone] = corners;
            Some(three_one([p, q, r], lone))
        }
        _ => None,
    }
}
