//! How wires become tubes, in words: what files, Python and other callers give.

use super::options::{Options, Radius};
use crate::base::Result;
use crate::mesh::Mesh;
use crate::mesh::shapes::{Braid, Coil};
use crate::words;

words! {
    /// How wires become tubes.
    pub struct TubeWords {
        /// The input is centre lines of wires (line cells), which become one closed surface of round tubes
        /// of this radius, in the unit of the points; or the name of an array of points or cells with radii.
        tubes: Option<String> = None,
        /// The number of sides of each tube. By default as many as size and distance require, at least 8.
        sides: Option<usize> = None,
        /// Wires whose gap is at most this, or that overlap by no more, are joined by material between them,
        /// in the unit of the points; 0 adds none. By default a tenth of the smaller radius.
        join: Option<f64> = None,
    }
}

words! {
    /// The wires of a braided stent, such as a flow diverter, along z from 0.
    pub struct BraidWords {
        /// The mean radius.
        radius: f64 = Braid::default().radius,
        /// Length along z.
        length: f64 = Braid::default().length,
        /// Number of wires, half of them winding each way.
        wires: usize = Braid::default().wires,
        /// The length along z of one turn of a wire.
        pitch: f64 = Braid::default().pitch,
        /// Radius of the wires.
        wire: f64 = Braid::default().wire_radius,
        /// The gap between wires where they cross; at 0 they touch, below 0 they overlap.
        gap: f64 = Braid::default().gap,
        /// How many wires each wire passes over before it passes under as many: 1 or 2.
        over: usize = Braid::default().over,
        /// Segments of a wire from one crossing to the next.
        steps: usize = 8,
    }
}

words! {
    /// The wire of a coil around the z axis, its middle at 0.
    pub struct CoilWords {
        /// Distance from the axis to the centre line of the wire.
        radius: f64 = 0.5,
        /// Distance between turns along the axis.
        pitch: f64 = 0.3,
        /// Number of turns; need not be whole.
        turns: f64 = 3.0,
        /// Radius of the wire.
        wire: f64 = 0.08,
        /// Segments of a turn.
        steps: usize = 48,
    }
}

impl BraidWords {
    /// The centre lines, as [`Braid::lines`] makes them.
    ///
    /// # Errors
    /// Those of [`Braid::lines`].
    pub fn lines(&self) -> Result<Mesh> {
        let braid = Braid {
            radius: self.radius,
            length: self.length,
            wires: self.wires,
            pitch: self.pitch,
            wire_radius: self.wire,
            gap: self.gap,
            over: self.over,
        };
        braid.lines(self.steps)
    }
}

impl CoilWords {
    /// The centre line, as [`Coil::lines`] makes it.
    ///
    /// # Errors
    /// Those of [`Coil::lines`].
    pub fn lines(&self) -> Result<Mesh> {
        let [radius, pitch, turns, wire_radius] = [self.radius, self.pitch, self.turns, self.wire];
        Coil { centre: [0.0; 3], radius, pitch, turns, wire_radius }.lines(self.steps)
    }
}

impl TubeWords {
    /// The options that these words determine; `None` if the input is a surface. `repair`: segments that are
    /// not finite or have no length are left out.
    ///
    /// # Errors
    /// When the radius is a number that is no length.
    pub fn options(&self, repair: bool) -> Result<Option<Options>> {
        let Some(text) = &self.tubes else { return Ok(None) };
        let radius = match text.trim().parse::<f64>() {
            Ok(radius) => Radius::Same(radius),
            Err(_) => Radius::Array(text.clone()),
        };
        Ok(Some(Options { sides: self.sides, join: self.join, repair, ..Options::of(radius) }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_is_a_number_or_an_array() {
        let of = |text: &str| {
            let words = TubeWords { tubes: Some(text.into()), sides: Some(9), ..TubeWords::default() };
            words.options(true).unwrap().unwrap()
        };
        assert_eq!(of("0.03").radius, Radius::Same(0.03));
        assert_eq!(of("radius").radius, Radius::Array("radius".into()));
        assert_eq!((of("r").sides, of("r").join, of("r").repair), (Some(9), None, true));
        assert_eq!(TubeWords::default().options(false).unwrap(), None);
    }
}
