//! A bent vessel with a sac on the outer side of its bend.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::distance;
use crate::mesh::Mesh;
use crate::mesh::shapes::check_count;
use crate::mesh::shapes::even_out::{Implicit, smooth_minimum};
use crate::mesh::shapes::junction::{Arm, junction};
use crate::mesh::shapes::labelled::patched_surface_mesh;

/// The parameters of a vessel with an aneurysm: the middle of its bend is the origin, it lies in the plane of
/// x and y, and the sac is where y is positive. All lengths are in one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Aneurysm {
    /// Radius of the vessel; default 1.
    pub radius: f64,
    /// Length of the vessel's axis; default 10.
    pub length: f64,
    /// Angle by which the axis bends, in degrees; 0 is straight. Default 90.
    pub bend_deg: f64,
    /// Radius of the sac; default 1.4.
    pub sac_radius: f64,
    /// Distance from the axis of the vessel to the centre of the sac; default 2.2.
    pub sac_height: f64,
    /// Vessel and sac are blended where their distances differ by less than this; larger is rounder. Default
    /// 0.5.
    pub blend: f64,
    /// Number of vertices around, rounded up to an even number; default 24.
    pub around: usize,
}

impl Default for Aneurysm {
    fn default() -> Self {
        Self {
            radius: 1.0,
            length: 10.0,
            bend_deg: 90.0,
            sac_radius: 1.4,
            sac_height: 2.2,
            blend: 0.5,
            around: 24,
        }
    }
}

/// Where the arm of the sac ends, as fractions of the sac's radius: the distance from its centre, and the
/// radius of the arm there, which puts the end on the sphere.
const TIP: [f64; 2] = [0.6, 0.8];

impl Aneurysm {
    /// The closed surface, facing outward, with patches `wall` (the sac is part of it), `inlet` (where x is
    /// negative) and `outlet`.
    ///
    /// # Errors
    /// If a size is not positive, there are fewer than 6 vertices around, the vessel bends more sharply than
    /// its width allows, or the sac does not rise over the vessel, does not touch it, or is near the vessel's
    /// ends.
    pub fn mesh(&self) -> Result<Mesh> {
        self.check()?;
        check_count(
            (self.around as f64).powi(2) * (self.length + self.sac_height + self.sac_radius)
                / self.radius.min(self.sac_radius),
        )?;
        let curvature = self.bend_deg.to_radians() / self.length;
        let half = |heading, curvature| Arm {
            heading,
            curvature,
            length: 0.5 * self.length,
            radius: self.radius,
            has_cap: true,
        };
        let sac = Arm {
            heading: std::f64::consts::FRAC_PI_2,
            curvature: 0.0,
            length: self.sac_height + TIP[0] * self.sac_radius,
            radius: TIP[1] * self.sac_radius,
            has_cap: false,
        };
        let arms = [half(0.0, -curvature), sac, half(std::f64::consts::PI, curvature)];
        let function = |p: Point| {
            let sac = distance(p, [0.0, self.sac_height, 0.0]) - self.sac_radius;
            smooth_minimum(distance_to_axis(p, curvature) - self.radius, sac, self.blend)
        };
        let size = self.radius.min(self.sac_radius);
        let made = junction(arms, &Implicit { function, size }, self.around.next_multiple_of(2))?;
        let [outlet, _, inlet] = &made.caps;
        let parts: [(&str, &[[VertexId; 3]]); 3] =
            [("wall", &made.wall), ("inlet", inlet), ("outlet", outlet)];
        Ok(patched_surface_mesh(made.points, &parts))
    }

    fn check(&self) -> Result<()> {
        let refuse = |what: &str, remedy: &str| Err(Error::options(what.to_owned()).remedy(remedy));
        let sizes = [self.radius, self.length, self.sac_radius, self.sac_height, self.blend];
        if !sizes.iter().all(|&x| x > 0.0 && x.is_finite()) || self.around < 6 {
            return refuse(
                "the lengths of an aneurysm must be positive, and it needs enough vertices around",
                "give lengths larger than 0 and at least 6 vertices around",
            );
        }
        let turn = self.bend_deg.to_radians();
        if !(turn >= 0.0 && turn * self.radius < self.length && self.bend_deg < 300.0) {
            return refuse("the vessel bends into itself", "bend it less, or make it longer");
        }
        let [low, high] = [-1.0, 1.0].map(|side| self.sac_height + side * self.sac_radius);
        if !(low > -0.5 * self.radius && low < self.radius && high > 1.2 * self.radius) {
            return refuse(
                "the sac must start inside the vessel, not far beyond its axis, and rise above it",
                "give a height that fits its radius",
            );
        }
        Ok(())
    }
}

/// The distance of a point from the axis of the vessel: a circle through the origin, or the line along x.
fn distance_to_axis([x, y, z]: Point, curvature: f64) -> f64 {
    if curvature == 0.0 {
        return y.hypot(z);
    }
    let radius = 1.0 / curvature;
    (x.hypot(y + radius) - radius).hypot(z)
}
