//! A vessel with a wall of finite thickness, as one surface: two closed regions, lumen and wall, that share
//! an interface.

use crate::base::{Error, Result, VertexId};
use crate::geometry::vector::{add, scale};
use crate::mesh::Mesh;
use crate::mesh::disc::disc;
use crate::mesh::shapes::labelled::patched_surface_mesh;
use crate::mesh::shapes::sleeve::{Sleeve, bend, cylinder, reversed, split_quad};

/// The parameters of a vessel with a thick wall. It starts at the origin and runs along z. All lengths are in
/// one unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ThickTube {
    /// Radius of the lumen; default 1.
    pub radius: f64,
    /// Thickness of the wall; default 0.3.
    pub thickness: f64,
    /// Length along the axis; default 6.
    pub length: f64,
    /// Angle by which the axis bends towards x, in degrees; default 0, a straight vessel.
    pub bend_deg: f64,
    /// Number of vertices around; default 24.
    pub around: usize,
    /// Number of steps along the axis; default 24.
    pub slices: usize,
    /// Number of steps through the wall, at its ends; default 1.
    pub layers: usize,
}

impl Default for ThickTube {
    fn default() -> Self {
        Self { radius: 1.0, thickness: 0.3, length: 6.0, bend_deg: 0.0, around: 24, slices: 24, layers: 1 }
    }
}

impl ThickTube {
    /// The surface, with patches `lumen_inlet`, `lumen_outlet`, `interface`, `outer`, `wall_inlet`,
    /// `wall_outlet`. The interface faces the wall, all others outward. Three patches meet at each rim of the
    /// lumen.
    ///
    /// # Errors
    /// If a size is not positive, a count is too small, or the vessel bends more sharply than its width
    /// allows.
    pub fn mesh(&self) -> Result<Mesh> {
        self.check()?;
        let (around, slices) = (self.around, self.slices);
        let mut points = cylinder(self.radius, self.length, around, slices);
        let lumen = Sleeve { first: 0, around };
        let outer = Sleeve { first: points.len(), around };
        points.extend(cylinder(self.radius + self.thickness, self.length, around, slices));
        let [mut inlet, mut outlet] = [Vec::new(), Vec::new()];
        for (slice, part) in [(0, &mut inlet), (slices, &mut outlet)] {
            let mut within = lumen.ring(slice);
            for layer in 1..=self.layers {
                let without = match layer == self.layers {
                    true => outer.ring(slice),
                    false => {
                        let share = layer as f64 / self.layers as f64;
                        let first = points.len();
                        points.extend(
                            (0..around)
                                .map(|i| {
                                    let [p, q] = [lumen, outer].map(|s| points[s.at(slice, i).index()]);
                                    add(scale(p, 1.0 - share), scale(q, share))
                                })
                                .collect::<Vec<_>>(),
                        );
                        Sleeve { first, around }.ring(0)
                    }
                };
                part.extend(annulus(&within, &without));
                within = without;
            }
        }
        let lumen_inlet = reversed(disc(&mut points, &lumen.ring(0)));
        let lumen_outlet = disc(&mut points, &lumen.ring(slices));
        bend(&mut points, self.length, self.bend_deg);
        let parts: [(&str, &[[VertexId; 3]]); 6] = [
            ("lumen_inlet", &lumen_inlet),
            ("lumen_outlet", &lumen_outlet),
            ("interface", &lumen.triangles(0..slices)),
            ("outer", &outer.triangles(0..slices)),
            ("wall_inlet", &reversed(inlet)),
            ("wall_outlet", &outlet),
        ];
        Ok(patched_surface_mesh(points, &parts))
    }

    fn check(&self) -> Result<()> {
        let refuse = |what: &str, remedy: &str| Err(Error::options(what.to_owned()).remedy(remedy));
        if ![self.radius, self.thickness, self.length].iter().all(|&x| x > 0.0 && x.is_finite()) {
            return refuse(
                "radius, thickness and length of a thick tube must be positive",
                "give radius, thickness and length larger than 0",
            );
        }
        if self.around < 3 || self.slices == 0 || self.layers == 0 {
            return refuse(
                "a thick tube needs more vertices around it, more slices or more layers",
                "give at least 3 around, a slice and a layer",
            );
        }
        let widest = (self.radius + self.thickness) * self.bend_deg.to_radians().abs();
        if !(widest < self.length && self.bend_deg.abs() < 330.0) {
            return refuse("the thick tube bends into itself", "bend it less, or make it longer");
        }
        Ok(())
    }
}

/// The triangles between two rings with the same number of vertices, counter-clockwise as the rings are.
fn annulus(within: &[VertexId], without: &[VertexId]) -> Vec<[VertexId; 3]> {
    let n = within.len();
    let quad = |i: usize| [within[i], without[i], without[(i + 1) % n], within[(i + 1) % n]];
    (0..n).flat_map(|i| split_quad(quad(i), i)).collect()
}
