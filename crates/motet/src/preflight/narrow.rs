//! Triangles too narrow for good tets on them.

use serde::Serialize;

use super::single::Shape;
use super::surfaces::Surfaces;
use crate::base::{Point, Threads};
use crate::geometry::quality::highest_eas;
use crate::geometry::triangle::{angle_at, centroid};
use crate::mesh::BAD_EAS;

/// Triangles that force bad tets: one with an angle below 12 or above 156 degrees makes each tet on it bad,
/// whatever its fourth vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Narrow {
    /// Number of such triangles.
    pub n_triangles: usize,
    /// The highest EAS of a tet on the narrowest.
    pub highest_eas: f64,
    /// The narrowest triangle.
    pub triangle: u32,
    /// The centroid of the narrowest one.
    pub at: Point,
}

impl Narrow {
    /// Those of sound triangles; `None` if there are none.
    pub(super) fn of(surfaces: &Surfaces, shapes: &[Shape], threads: &Threads) -> Option<Self> {
        let highest = threads.map(shapes.len(), |t| match shapes[t] {
            Shape::Sound => highest(surfaces.corners(t as u32)),
            _ => f64::INFINITY,
        });
        let (triangle, &worst) = highest.iter().enumerate().min_by(|x, y| x.1.total_cmp(y.1))?;
        let n_triangles = highest.iter().filter(|highest| **highest < BAD_EAS).count();
        let triangle = triangle as u32;
        let at = centroid(surfaces.corners(triangle));
        (n_triangles > 0).then_some(Self { n_triangles, highest_eas: worst, triangle, at })
    }
}

/// The highest EAS of a tet with this facet.
fn highest(facet: [Point; 3]) -> f64 {
    let of = |corner| highest_eas(angle_at(facet, corner).to_degrees());
    (0..3).map(of).fold(f64::INFINITY, f64::min)
}
