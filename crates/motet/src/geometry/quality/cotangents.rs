//! Cotangents of the angles of a tet: in [0, pi] they fall as the angle rises, so
//! the extreme angles are found among them before any arc is taken.

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;
use crate::geometry::tet::{EDGES, FACETS};
use crate::geometry::vector::{cross, dot, norm, sub};

/// The angle in [0, pi] with this cotangent.
pub(super) fn angle(cotangent: f64) -> f64 {
    1f64.atan2(cotangent)
}

/// Cosine by sine, both up to one positive factor. 0/0, an angle between things
/// without extent, counts as angle 0.
fn ratio(cosine: f64, sine: f64) -> f64 {
    let cotangent = cosine / sine;
    if cotangent.is_nan() { f64::INFINITY } else { cotangent }
}

/// Twice the area vector of each facet, outward for a positive tet.
fn normals(points: &[Point; 4]) -> [Point; 4] {
    FACETS.map(|facet| {
        let [a, b, c] = facet.map(|v| points[v]);
        cross(sub(b, a), sub(c, a))
    })
}

/// Cotangents of the dihedral angles at the six edges. An inverted tet has
/// those of its mirror image.
///
/// At the edge e between facets with normals m and n: `cot = -m.n / |m x n|`,
/// and `m x n` is e times six volumes, which is accurate where m and n are
/// nearly parallel and the cosine says nothing.
pub(super) fn dihedral(tet: &Scaled) -> [f64; 6] {
    let normals = normals(&tet.points);
    let volume_6 = tet.volume_6().abs();
    let lengths_squared = tet.lengths_squared();
    [0, 1, 2, 3, 4, 5].map(|e| {
        let [i, j] = EDGES[5 - e];
        ratio(-dot(normals[i], normals[j]), volume_6 * lengths_squared[e].sqrt())
    })
}

/// Cotangents of the twelve angles of the four facets.
pub(super) fn facets(tet: &Scaled) -> [[f64; 3]; 4] {
    let normals = normals(&tet.points);
    [0, 1, 2, 3].map(|f| {
        let corners = FACETS[f].map(|v| tet.points[v]);
        let sine = norm(normals[f]);
        [0, 1, 2].map(|i| {
            let [at, next, last] = [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]];
            ratio(dot(sub(next, at), sub(last, at)), sine)
        })
    })
}

/// The smallest and the largest.
pub(super) fn extremes(cotangents: &[f64]) -> [f64; 2] {
    cotangents
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &cot| [low.min(cot), high.max(cot)])
}
