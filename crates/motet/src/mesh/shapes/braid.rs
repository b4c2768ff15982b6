//! A braided stent, such as a flow diverter: wires that wind around a cylinder both ways, over and under each
//! other.
//!
//! Crossings lie in planes across the axis, `2 pi / n` of the turn apart for `n` wires. In each plane the
//! wires of one way are outside and those of the other inside, so a wave of the radius, the same for all
//! wires of one way, weaves them.

use std::f64::consts::{PI, SQRT_2, TAU};

use crate::base::{Error, Result, VertexId};
use crate::geometry::vector::LARGEST;
use crate::mesh::shapes::check_count;
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// The parameters of a braided stent. It lies along z from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Braid {
    /// The mean radius: where wires cross, one is farther out and the other farther in. Default 2.
    pub radius: f64,
    /// Length along z; default 10.
    pub length: f64,
    /// Number of wires, half of them winding each way; default 24.
    pub wires: usize,
    /// The length along z of one turn of a wire; default 10.
    pub pitch: f64,
    /// Radius of the wires; default 0.05.
    pub wire_radius: f64,
    /// The gap between wires where they cross; below 0 they overlap, and at minus the diameter of a wire
    /// their centre lines cross. Default 0: they touch.
    pub gap: f64,
    /// How many wires each wire passes over before it passes under as many: 1 or 2. Default 1.
    pub over: usize,
}

impl Default for Braid {
    fn default() -> Self {
        Self { radius: 2.0, length: 10.0, wires: 24, pitch: 10.0, wire_radius: 0.05, gap: 0.0, over: 1 }
    }
}

impl Braid {
    /// The centre lines as polylines, with the point array `radius` and the cell array `wire`, which numbers
    /// the wires from 0: first those that wind to the left seen along z. Each has `steps` segments from one
    /// crossing to the next.
    ///
    /// # Errors
    /// If a parameter is out of its range, or there would be more points than a shape may have.
    pub fn lines(&self, steps: usize) -> Result<Mesh> {
        self.check()?;
        let half = self.wires / 2;
        let n_crossings = (self.length / self.pitch * self.wires as f64).max(1.0);
        check_count((n_crossings + 1.0) * steps as f64 * self.wires as f64)?;
        if steps == 0 {
            return Err(Error::options("a braid needs a segment from crossing to crossing, but got 0"));
        }
        let n = (n_crossings * steps as f64).ceil() as usize;
        let (mut points, mut cells) = (Vec::new(), Cells::new());
        for wire in 0..self.wires {
            let way = if wire < half { 1.0 } else { -1.0 };
            let first = points.len();
            let begin = TAU * (wire % half) as f64 / half as f64;
            for i in 0..=n {
                let z = self.length * i as f64 / n as f64;
                let turn = TAU * z / self.pitch;
                // Crossings are where this is a whole number.
                let place = self.wires as f64 * z / self.pitch;
                let radius = self.radius + way * self.wave(place);
                let (sin, cos) = (begin + way * turn).sin_cos();
                points.push([radius * cos, radius * sin, z]);
            }
            cells.push(CellKind::POLY_LINE, (first..points.len()).map(VertexId::new));
        }
        let radii = vec![self.wire_radius; points.len()];
        let mut mesh = Mesh::new(points, cells);
        mesh.set_point_field(Field::scalars("radius", radii));
        mesh.set_cell_field(Field::scalars("wire", (0..self.wires as i32).collect::<Vec<_>>()));
        Ok(mesh)
    }

    /// How far a wire of the first way is outside the mean radius, `place` crossings from the end.
    fn wave(&self, place: f64) -> f64 {
        let height = (self.wire_radius + self.gap / 2.0).max(0.0);
        match self.over {
            1 => height * (PI * place).cos(),
            _ => height * SQRT_2 * (PI / 2.0 * (place - 0.5)).cos(),
        }
    }

    fn check(&self) -> Result<()> {
        let lengths = [self.radius, self.length, self.pitch, self.wire_radius];
        if lengths.iter().any(|x| !(*x > 0.0 && *x <= LARGEST))
            || self.gap.is_nan()
            || self.gap.abs() > LARGEST
        {
            return Err(Error::options(format!(
                "got {lengths:?} for radius, length, pitch and wire radius, and the gap {}",
                self.gap
            ))
            .remedy("give lengths above 0, and a finite gap"));
        }
        if self.wires < 2 || !self.wires.is_multiple_of(2) || !(1..=2).contains(&self.over) {
            return Err(Error::options(format!(
                "a braid cannot have {} wires that pass over {} at a time",
                self.wires, self.over
            ))
            .remedy("give an even number of wires, and 1 or 2"));
        }
        let deepest = self.wire_radius + (self.wire_radius + self.gap / 2.0).max(0.0) * SQRT_2;
        if deepest >= self.radius {
            return Err(Error::options(format!(
                "the wires reach {deepest} inward of a braid of radius {}",
                self.radius
            ))
            .remedy("give thinner wires, a smaller gap or a larger radius"));
        }
        Ok(())
    }
}
