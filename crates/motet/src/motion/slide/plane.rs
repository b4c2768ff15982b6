//! The plane of a flat patch, and how far the patch is off it.

use crate::base::{Error, Point, Result};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, dot, in_range, norm, scale, sub};
use crate::motion::options::FacetSet;

/// The plane of a patch that is flat within a tolerance.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    centre: Point,
    axes: [Point; 2],
    pub(crate) normal: Point,
    /// The largest distance of a vertex from the centre.
    pub(crate) radius: f64,
    /// The largest distance of a vertex from the plane.
    pub(crate) deviation: f64,
}

impl Plane {
    /// The plane through the mean of the vertices, at right angles to the sum of the area vectors.
    ///
    /// # Errors
    /// When the facets have no area, or a vertex is off the plane by more than `tolerance` times the radius.
    pub(crate) fn new(points: &[Point], set: &FacetSet, tolerance: f64) -> Result<Self> {
        let corners = set.vertices.iter().map(|v| points[v.index()]);
        let centre = scale(corners.clone().fold([0.0; 3], add), 1.0 / set.vertices.len().max(1) as f64);
        let radius = corners.clone().map(|p| norm(sub(p, centre))).fold(0.0, f64::max);
        // Facets of a patch need not all have the same orientation: none may cancel another.
        let area = set.triangles().map(|t| area_vector(t.map(|v| points[v.index()])));
        let area = area.fold([0.0; 3], |sum, a| if dot(sum, a) < 0.0 { sub(sum, a) } else { add(sum, a) });
        let normal = scale(area, 1.0 / norm(area));
        if !in_range(normal) {
            return Err(Error::input(format!("its {} facets have no area", set.rings.len()))
                .remedy("name a patch of the mesh that has facets with an area"));
        }
        let deviation = corners.map(|p| dot(normal, sub(p, centre)).abs()).fold(0.0, f64::max);
        if deviation > tolerance * radius {
            return Err(Error::input(format!(
                "is not flat: vertices are up to {deviation:.3e} off its plane, {:.3e} of its radius {radius:.3e}; \
                 a fraction of {tolerance} is allowed",
                deviation / radius
            ))
            .remedy(
                "let only flat patches slide, such as inlets and outlets; or allow more (`--slide-tolerance`), \
                 or make caps flat (`motet cap --flatten`)",
            ));
        }
        // Along the coordinate axis that is farthest from the normal.
        let least = (0..3).fold(0, |i, j| if normal[j].abs() < normal[i].abs() { j } else { i });
        let across = cross(normal, [0, 1, 2].map(|i| f64::from(u8::from(i == least))));
        let across = scale(across, 1.0 / norm(across));
        Ok(Self { centre, axes: [cross(across, normal), across], normal, radius, deviation })
    }

    /// Coordinates in the plane; the third is 0.
    pub(crate) fn flatten(&self, p: Point) -> Point {
        let p = sub(p, self.centre);
        [dot(p, self.axes[0]), dot(p, self.axes[1]), 0.0]
    }

    /// The angle in radians by which the normal may be off, since the patch is not exactly flat.
    pub(crate) fn normal_error(&self) -> f64 {
        if self.radius > 0.0 { self.deviation / self.radius } else { 0.0 }
    }
}
