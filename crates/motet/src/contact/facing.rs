//! Whether two places on surfaces face each other through free space.

use super::body::{BodyView, PreparedBody};
use super::side::Side;
use crate::base::Point;
use crate::geometry::distance::triangle_triangle;
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};

/// The least cosine between the normal of a surface and the direction to a place nearest to it: 75 degrees.
/// Neighbours on one smooth surface are at right angles to the normal.
const MIN_COSINE: f64 = 0.25;

/// The least cosine on an edge or a vertex, where the nearest place may lie at any angle to each triangle
/// around: 89 degrees.
const MIN_FEATURE_COSINE: f64 = 0.02;

/// The least cosine with which a direction leaves a surface, so that rounding does not make one within it
/// leave.
const MIN_LEAVING_COSINE: f64 = 1e-9;

/// How far rounding may move a point off a plane, relative to its distance from a point of the plane.
const ROUNDING: f64 = 1e-15;

/// The cosine between the normals of two triangles that face away from each other as far as allowed.
const ALIKE_COSINE: f64 = 1.0 - 2.0 * MIN_COSINE * MIN_COSINE;

/// A place on a body: a point of a triangle, by the weights of its vertices.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) body: BodyView<'a>,
    pub(super) triangle: u32,
    pub(super) weights: [f64; 3],
}

/// Whether two triangles may face each other anywhere. This quick test rules out most neighbours without
/// measuring: those whose normals are too similar, or of which one lies behind the other, unless they meet.
pub(super) fn may_face(points: &[Point], [a, b]: [BodyView<'_>; 2], [i, j]: [u32; 2]) -> bool {
    let (normal_a, normal_b) = (a.normal(points, i), b.normal(points, j));
    let turn = dot(normal_a, normal_b);
    let is_alike = match (a.free, b.free) {
        (Side::Both, _) | (_, Side::Both) => false,
        (own, other) if own == other => turn > ALIKE_COSINE,
        _ => turn < -ALIKE_COSINE,
    };
    let (corners_a, corners_b) = (a.corners(points, i), b.corners(points, j));
    let is_turned_away = is_alike
        || is_behind(a.free, normal_a, corners_a[0], corners_b)
        || is_behind(b.free, normal_b, corners_b[0], corners_a);
    !is_turned_away || triangle_triangle::meet(corners_a, corners_b)
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

/// Decides which directions from a vertex lead into free space.
pub(super) struct Sight {
    free: Side,
    /// The normals of the triangles around, and the direction of their sum.
    normals: Vec<Point>,
    sum: Point,
    is_rim: bool,
}

impl Sight {
    /// For a vertex, by its index in the body's list.
    pub(super) fn new(points: &[Point], body: BodyView<'_>, vertex: usize) -> Self {
        let star = body.star(vertex);
        Self {
            free: body.free,
            normals: star.iter().map(|&t| body.normal(points, t)).collect(),
            sum: sum_of_normals(points, &body, star.iter().copied()),
            is_rim: body.is_rim[vertex],
        }
    }

    /// Whether the direction to a place on another surface starts in free space and ends at right angles to
    /// that surface, more or less. Places that touch face each other.
    pub(super) fn sees(&self, points: &[Point], to: Place<'_>, way: Point) -> bool {
        let Some(way) = unit(way) else { return true };
        let is_off = self.normals.iter().any(|&normal| is_free(self.free, normal, way, MIN_LEAVING_COSINE))
            || is_free(self.free, self.sum, way, MIN_COSINE)
            || self.free == Side::Both && self.is_rim;
        is_off && faces(points, to, scale(way, -1.0))
    }
}

/// Whether two places that are nearest to each other are so across free space.
pub(super) fn see_each_other(points: &[Point], from: Place<'_>, to: Place<'_>, way: Point) -> bool {
    let Some(way) = unit(way) else { return true };
    faces(points, to, scale(way, -1.0)) && faces(points, from, way)
}

/// Whether the direction `out`, from a place to what it is nearest to, leads into free space: by the normal
/// of the triangle, or on an edge or a vertex by the sum of the normals around, which even an edge as sharp
/// as a knife has. The rim of an open surface may be left in any direction.
fn faces(points: &[Point], Place { body, triangle, weights }: Place<'_>, out: Point) -> bool {
    if is_free(body.free, body.normal(points, triangle), out, MIN_COSINE) {
        return true;
    }
    let (vertices, places) = (body.joined[triangle as usize], body.places[triangle as usize]);
    let held = || (0..3).filter(|&k| weights[k] != 0.0);
    let Some(first) = held().next() else { return false };
    if held().count() == 3 {
        return false;
    }
    if body.free == Side::Both && held().all(|k| body.is_rim[places[k] as usize]) {
        return true;
    }
    let star = body.star(places[first] as usize).iter().copied();
    let around = star.filter(|&t| held().all(|k| body.joined[t as usize].contains(&vertices[k])));
    around.clone().any(|t| is_free(body.free, body.normal(points, t), out, MIN_FEATURE_COSINE))
        || is_free(body.free, sum_of_normals(points, &body, around), out, MIN_COSINE)
}

/// Whether a direction leads to the free side of a surface with this normal, with a cosine above `least`. If
/// both sides are free, it has to be above [`MIN_COSINE`] in any case: with less, nearly every direction
/// would leave, those along the surface to neighbours included.
fn is_free(free: Side, normal: Point, way: Point, least: f64) -> bool {
    let cosine = dot(normal, way);
    match free {
        Side::Both => cosine.abs() > MIN_COSINE,
        Side::Outside => cosine > least,
        Side::Inside => cosine < -least,
    }
}

/// The direction of the sum of the normals of some triangles; zero where they cancel out.
fn sum_of_normals(points: &[Point], body: &PreparedBody, triangles: impl Iterator<Item = u32>) -> Point {
    let sum = triangles.fold([0.0; 3], |sum, t| add(sum, body.normal(points, t)));
    unit(sum).unwrap_or_default()
}
