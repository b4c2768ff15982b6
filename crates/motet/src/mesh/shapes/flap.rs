//! A vessel with a dissection flap: a sheet inside the lumen that shares vertices with the wall where it is
//! attached.
//!
//! ```text
//!    .-""-.       cross-section: the flap joins two lines of the wall, or only the first, and then its
//!   /      \      other edge is free. Lengthwise it starts and ends inside, with free edges.
//!  a-------_b
//!   \      /      Waves move it across its chord, least near the wall.
//!    `-..-'
//! ```

use std::f64::consts::{PI, TAU};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{add, cross, distance, norm, scale, sub};
use crate::mesh::Mesh;
use crate::mesh::disc::disc;
use crate::mesh::shapes::labelled::patched_surface_mesh;
use crate::mesh::shapes::sleeve::{Sleeve, bend, cylinder, reversed, split_quad};

/// The parameters of a vessel with a flap. It starts at the origin and runs along z. All lengths are in one
/// unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Flap {
    /// Radius of the vessel; default 1.
    pub radius: f64,
    /// Length along the axis; default 6.
    pub length: f64,
    /// Angle by which the axis bends towards x, in degrees; default 0, a straight vessel.
    pub bend_deg: f64,
    /// Number of vertices around; default 24.
    pub around: usize,
    /// Number of steps along the axis; default 24.
    pub slices: usize,
    /// Where on the circumference the flap is attached, in degrees, rounded to the nearest vertices. Default
    /// 200 and 340.
    pub lines_deg: [f64; 2],
    /// The start and the end of the flap along the axis, as fractions of the length, rounded to the nearest
    /// slices. Default 0.2 to 0.8.
    pub extent: [f64; 2],
    /// How far the flap reaches from its first line towards the second: 1 to be attached to both, less for a
    /// free edge. Default 1.
    pub reach: f64,
    /// Amplitude of the waves of the flap, as a fraction of the radius; default 0.
    pub wave_height: f64,
    /// Number of waves along its length; default 2.
    pub waves: f64,
}

impl Default for Flap {
    fn default() -> Self {
        Self {
            radius: 1.0,
            length: 6.0,
            bend_deg: 0.0,
            around: 24,
            slices: 24,
            lines_deg: [200.0, 340.0],
            extent: [0.2, 0.8],
            reach: 1.0,
            wave_height: 0.0,
            waves: 2.0,
        }
    }
}

impl Flap {
    /// The surface, with patches `wall`, `inlet`, `outlet` and `flap`. The first three together are closed
    /// and face outward.
    ///
    /// # Errors
    /// If a size is not positive or a count too small, the vessel bends more sharply than its width allows,
    /// the flap has no width or length or does not end inside, or its waves would reach the wall.
    pub fn mesh(&self) -> Result<Mesh> {
        self.check()?;
        let wall = Sleeve { first: 0, around: self.around };
        let mut points = cylinder(self.radius, self.length, self.around, self.slices);
        let inlet = reversed(disc(&mut points, &wall.ring(0)));
        let outlet = disc(&mut points, &wall.ring(self.slices));
        let flap = self.sheet(&mut points, wall);
        bend(&mut points, self.length, self.bend_deg);
        let parts: [(&str, &[[VertexId; 3]]); 4] = [
            ("wall", &wall.triangles(0..self.slices)),
            ("inlet", &inlet),
            ("outlet", &outlet),
            ("flap", &flap),
        ];
        Ok(patched_surface_mesh(points, &parts))
    }

    /// The triangles of the flap. Those of its points that are not on the wall are added to `points`.
    fn sheet(&self, points: &mut Vec<Point>, wall: Sleeve) -> Vec<[VertexId; 3]> {
        let ([from, to], [first, last]) = (self.lines(), self.ends());
        let span = |slice: usize| [from, to].map(|i| wall.at(slice, i));
        let [p, q] = span(0).map(|v| points[v.index()]);
        let width = self.reach * distance(p, q);
        let edge = TAU * self.radius / self.around as f64;
        let columns = ((width / edge).round() as usize).max(2);
        let mut rows = Vec::new();
        for slice in first..=last {
            let [a, b] = span(slice);
            let along = (slice - first) as f64 / (last - first) as f64;
            let row = (0..=columns).map(|column| {
                if column == 0 {
                    return a;
                }
                if column == columns && self.reach == 1.0 {
                    return b;
                }
                let across = self.reach * column as f64 / columns as f64;
                points.push(self.place([a, b].map(|v| points[v.index()]), across, along));
                VertexId::new(points.len() - 1)
            });
            rows.push(row.collect::<Vec<_>>());
        }
        let quad = |r: usize, c: usize| [rows[r][c], rows[r + 1][c], rows[r + 1][c + 1], rows[r][c + 1]];
        (0..last - first)
            .flat_map(|r| (0..columns).flat_map(move |c| split_quad(quad(r, c), r + c)))
            .collect()
    }

    /// A point of the flap: on the chord between two points of the wall, displaced from it by the wave.
    fn place(&self, [a, b]: [Point; 2], across: f64, along: f64) -> Point {
        let chord = sub(b, a);
        let off = cross(chord, [0.0, 0.0, 1.0 / norm(chord)]);
        let wave = (PI * across).sin().powi(2) * (TAU * self.waves * along).sin();
        add(add(a, scale(chord, across)), scale(off, self.wave_height * self.radius * wave))
    }

    /// The indices around the circumference at which it is attached.
    fn lines(&self) -> [usize; 2] {
        let n = self.around as f64;
        self.lines_deg.map(|deg| (deg.rem_euclid(360.0) / 360.0 * n).round() as usize % self.around)
    }

    /// The first and the last slice of the flap.
    fn ends(&self) -> [usize; 2] {
        self.extent.map(|share| (share * self.slices as f64).round() as usize)
    }

    fn check(&self) -> Result<()> {
        let refuse = |what: &str, remedy: &str| Err(Error::options(what.to_owned()).remedy(remedy));
        if ![self.radius, self.length].iter().all(|&x| x > 0.0 && x.is_finite()) {
            return refuse(
                "the radius and the length of a vessel must be positive",
                "give a radius and a length larger than 0",
            );
        }
        if self.around < 4 || self.slices < 3 {
            return refuse(
                "a vessel needs more vertices around it, or more slices",
                "give at least 4 vertices around and 3 slices",
            );
        }
        if !(self.radius * self.bend_deg.to_radians().abs() < self.length && self.bend_deg.abs() < 330.0) {
            return refuse("the vessel bends into itself", "bend it less, or make it longer");
        }
        let ([from, to], [first, last]) = (self.lines(), self.ends());
        let apart = from.abs_diff(to).min(self.around - from.abs_diff(to));
        if apart < 2 || !self.lines_deg.iter().all(|deg| deg.is_finite()) {
            return refuse(
                "the lines of the flap are too close together, or not finite",
                "put its lines farther apart",
            );
        }
        if !(0 < first && first < last && last < self.slices) {
            return refuse(
                "the flap does not start and end inside the vessel",
                "give an extent within 0 to 1, or more slices",
            );
        }
        if !(self.reach > 0.0 && self.reach <= 1.0) {
            return refuse(
                "the reach of the flap must be above 0 and at most 1",
                "give a reach above 0, at most 1",
            );
        }
        // The distance from the middle of the chord to the nearer side of the wall.
        let room = 1.0 - (PI * apart as f64 / self.around as f64).cos().abs();
        if !(self.wave_height.abs() < 0.8 * room && self.waves.is_finite()) {
            return refuse(
                "the waves of the flap reach the wall",
                "give a smaller wave height, or move the lines",
            );
        }
        Ok(())
    }
}
