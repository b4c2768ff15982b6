//! Whether a closed surface encloses a point, from the definition alone.

use motet::base::{Point, VertexId};
use motet::geometry::vector::{cross, dot, norm, sub};

/// Whether a closed surface winds around `q` in either direction: by the solid angles of its triangles, which
/// sum to 4 pi per turn (Van Oosterom and Strackee 1983, *The solid angle of a plane triangle*).
pub(crate) fn encloses(points: &[Point], triangles: &[[VertexId; 3]], q: Point) -> bool {
    let angle = |t: &[VertexId; 3]| {
        let [a, b, c] = t.map(|v| sub(points[v.index()], q));
        let (x, y, z) = (norm(a), norm(b), norm(c));
        let below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
        2.0 * dot(a, cross(b, c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>().abs() > std::f64::consts::TAU
}
