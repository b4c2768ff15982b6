//! A coil: a wire wound around a line, such as those that fill aneurysms.

use std::f64::consts::TAU;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{LARGEST, add};
use crate::mesh::shapes::{check_count, wire};
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// A helix around a line along z. All lengths are in one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coil {
    /// The middle of the axis.
    pub centre: Point,
    /// Distance from the axis to the centre line of the wire.
    pub radius: f64,
    /// Distance between turns along the axis.
    pub pitch: f64,
    /// Number of turns; need not be whole.
    pub turns: f64,
    /// Radius of the wire.
    pub wire_radius: f64,
}

impl Coil {
    /// The centre line of the wire, with `steps` straight segments per turn.
    pub fn line(&self, steps: usize) -> Vec<Point> {
        let n = (self.turns * steps as f64).ceil().max(1.0) as usize;
        let place = |i: usize| {
            let turn = self.turns * i as f64 / n as f64;
            let (sin, cos) = (TAU * turn).sin_cos();
            let along = self.pitch * (turn - 0.5 * self.turns);
            add(self.centre, [self.radius * cos, self.radius * sin, along])
        };
        (0..=n).map(place).collect()
    }

    /// The centre line as a polyline, with the point array `radius`, which holds that of the wire.
    ///
    /// # Errors
    /// If a number is not finite or `turns` is negative, and if there would be more points than a shape may
    /// have.
    pub fn lines(&self, steps: usize) -> Result<Mesh> {
        self.check()?;
        check_count(self.turns * steps as f64 + 1.0)?;
        let line = self.line(steps);
        let mut cells = Cells::new();
        cells.push(CellKind::POLY_LINE, (0..line.len()).map(VertexId::new));
        let radii = vec![self.wire_radius; line.len()];
        let mut mesh = Mesh::new(line, cells);
        mesh.set_point_field(Field::scalars("radius", radii));
        Ok(mesh)
    }

    /// The closed surface, as the patch `wire`, with `steps` segments per turn and `around` sides.
    ///
    /// # Errors
    /// The errors of [`wire`]; also if a number is not finite or `turns` is negative, and if the coil would
    /// have more points than a shape may have.
    pub fn mesh(&self, steps: usize, around: usize) -> Result<Mesh> {
        self.check()?;
        check_count((self.turns * steps as f64 + 1.0) * (around as f64 + 1.0))?;
        let line = self.line(steps);
        let segments: Vec<[VertexId; 2]> =
            (1..line.len()).map(|i| [VertexId::new(i - 1), VertexId::new(i)]).collect();
        wire(&line, &segments, self.wire_radius, around)
    }

    fn check(&self) -> Result<()> {
        let sizes = [
            self.radius,
            self.pitch,
            self.turns,
            self.wire_radius,
            self.centre[0],
            self.centre[1],
            self.centre[2],
        ];
        if !sizes.iter().all(|x| x.abs() <= LARGEST) || self.turns < 0.0 {
            return Err(Error::options(format!(
                "a coil cannot have {} turns of radius {} and pitch {}",
                self.turns, self.radius, self.pitch
            ))
            .remedy("give finite numbers, and 0 turns or more"));
        }
        Ok(())
    }
}
