//! A vessel that branches into two, smooth where the three meet.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{dot, norm, scale, sub};
use crate::mesh::Mesh;
use crate::mesh::shapes::even_out::{Implicit, smooth_minimum};
use crate::mesh::shapes::junction::{Arm, junction};
use crate::mesh::shapes::labelled::patched_surface_mesh;

/// The parameters of a bifurcation: the vessel comes along x and branches at the origin, and its branches lie
/// in the plane of x and y. All lengths are in one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Bifurcation {
    /// Radius of the vessel before it branches; default 1.
    pub radius: f64,
    /// Radius of each branch; default 0.79, for which the cubes of the radii sum to that of the vessel
    /// (Murray 1926).
    pub branch_radii: [f64; 2],
    /// Angle between the axis and each branch, in degrees; default 40.
    pub branch_angles_deg: [f64; 2],
    /// Length of the vessel up to where the axes meet; default 4.
    pub length: f64,
    /// Length of each branch from where the axes meet; default 5.
    pub branch_lengths: [f64; 2],
    /// Two vessels are blended where their distances differ by less than this; larger is rounder. Default
    /// 0.6.
    pub blend: f64,
    /// Number of vertices around each vessel, rounded up to an even number; default 24.
    pub around: usize,
}

impl Default for Bifurcation {
    fn default() -> Self {
        Self {
            radius: 1.0,
            branch_radii: [0.79; 2],
            branch_angles_deg: [40.0; 2],
            length: 4.0,
            branch_lengths: [5.0; 2],
            blend: 0.6,
            around: 24,
        }
    }
}

impl Bifurcation {
    /// The closed surface, facing outward, with patches `wall`, `inlet`, `outlet_1` (where y is positive) and
    /// `outlet_2`.
    ///
    /// # Errors
    /// If a size is not positive, there are fewer than 6 vertices around, an angle is not between 0 and 150
    /// degrees, or vessels are too near each other at their ends.
    pub fn mesh(&self) -> Result<Mesh> {
        self.check()?;
        let [left, right] = self.branch_angles_deg.map(f64::to_radians);
        let straight =
            |heading, length, radius| Arm { heading, curvature: 0.0, length, radius, has_cap: true };
        let arms = [
            straight(-right, self.branch_lengths[1], self.branch_radii[1]),
            straight(left, self.branch_lengths[0], self.branch_radii[0]),
            straight(std::f64::consts::PI, self.length, self.radius),
        ];
        let function = |p: Point| {
            let [a, b, c] = arms.map(|arm| distance_to_ray(p, arm.heading) - arm.radius);
            smooth_minimum(smooth_minimum(a, b, self.blend), c, self.blend)
        };
        let size = arms.iter().fold(self.radius, |least, arm| least.min(arm.radius));
        let made = junction(arms, &Implicit { function, size }, self.around.next_multiple_of(2))?;
        let [outlet_2, outlet_1, inlet] = &made.caps;
        let parts: [(&str, &[[VertexId; 3]]); 4] =
            [("wall", &made.wall), ("inlet", inlet), ("outlet_1", outlet_1), ("outlet_2", outlet_2)];
        Ok(patched_surface_mesh(made.points, &parts))
    }

    fn check(&self) -> Result<()> {
        let ([a, b], [c, d]) = (self.branch_radii, self.branch_lengths);
        let sizes = [self.radius, self.length, self.blend, a, b, c, d];
        if !sizes.iter().all(|&x| x > 0.0 && x.is_finite()) || self.around < 6 {
            return Err(Error::options(
                "the lengths of a bifurcation must be positive, and it needs enough vertices around",
            )
            .remedy("give lengths larger than 0 and at least 6 vertices around"));
        }
        if !self.branch_angles_deg.iter().all(|&deg| deg > 0.0 && deg < 150.0) {
            return Err(Error::options("the branches overlap each other, or the vessel")
                .remedy("give angles between 0 and 150 degrees"));
        }
        Ok(())
    }
}

/// The distance of a point from a ray that starts at the origin.
fn distance_to_ray(p: Point, heading: f64) -> f64 {
    let along = [heading.cos(), heading.sin(), 0.0];
    norm(sub(p, scale(along, dot(p, along).max(0.0))))
}
