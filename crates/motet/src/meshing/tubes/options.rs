//! How wires become tubes.

use std::f64::consts::PI;

use crate::base::{Error, Result};
use crate::geometry::vector::LARGEST;
use crate::mesh::shapes::corner_radius;

/// The fewest sides of a tube, if the caller does not choose.
const FEWEST_SIDES: usize = 8;

/// The most sides that a tube may have.
pub const MOST_SIDES: usize = 360;

/// The allowed distance of surfaces from round tubes, over the smallest radius, if the caller does not
/// choose.
const DISTANCE_OVER_RADIUS: f64 = 1.0 / 8.0;

/// Wires nearer than this times the smaller radius are joined, if the caller does not choose.
const JOIN_OVER_RADIUS: f64 = 0.1;

/// The radius of wires.
#[derive(Clone, Debug, PartialEq)]
pub enum Radius {
    /// One for all, in the unit of the points.
    Same(f64),
    /// That of an array of points or cells with this name.
    Array(String),
}

/// How wires become tubes.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The radius of the wires.
    pub radius: Radius,
    /// The number of sides of each tube, from 3 to [`MOST_SIDES`]; `None`: as many as `size` and `distance`
    /// require, at least 8. Default: `None`.
    pub sides: Option<usize>,
    /// Wires whose gap is at most this, or that overlap by no more, are joined by material between them, in
    /// the unit of the points; at 0, no material is added. `None`: a tenth of the smaller radius, for each
    /// pair. Default: `None`.
    pub join: Option<f64>,
    /// The length of edges that the surface gets later; `None`: not known. Default: `None`.
    pub size: Option<f64>,
    /// How far sections may be from round ones; `None`: an eighth of the smallest radius. Default: `None`.
    pub distance: Option<f64>,
    /// Whether segments with a point or a radius that is not finite, and those without length, are left out,
    /// and points at the same place joined. Default: no; such segments are errors.
    pub repair: bool,
}

impl Options {
    /// Options of a radius, all others at their defaults.
    pub fn of(radius: Radius) -> Self {
        Self { radius, sides: None, join: None, size: None, distance: None, repair: false }
    }

    /// # Errors
    /// When a number is out of its range.
    pub(super) fn check(&self) -> Result<()> {
        let is_length = |x: f64| x > 0.0 && x <= LARGEST;
        if let Some(sides) = self.sides.filter(|sides| !(3..=MOST_SIDES).contains(sides)) {
            return Err(Error::options(format!(
                "a tube cannot have {sides} sides: 3 to {MOST_SIDES} are possible"
            )));
        }
        if let Some(gap) = self.join.filter(|gap| !(0.0..=LARGEST).contains(gap)) {
            return Err(Error::options(format!("the gap at which wires are joined cannot be {gap}"))
                .remedy("give a distance of 0 or more"));
        }
        for (name, value) in [("size", self.size), ("distance", self.distance)] {
            if let Some(x) = value.filter(|x| !is_length(*x)) {
                return Err(Error::options(format!("the {name} of tubes must be above 0; got {x}")));
            }
        }
        Ok(())
    }

    /// How far sections of wires with this smallest radius may be from round ones.
    pub fn allowed(&self, smallest: f64) -> f64 {
        self.distance.unwrap_or(DISTANCE_OVER_RADIUS * smallest)
    }

    /// The number of sides of wires with these smallest and largest radii.
    pub(super) fn n_sides(&self, [smallest, largest]: [f64; 2]) -> usize {
        let by_size = self.size.map_or(0.0, |size| 2.0 * PI * smallest / size);
        let n = by_size.ceil().clamp(FEWEST_SIDES as f64, MOST_SIDES as f64) as usize;
        let is_far = |n: &usize| (corner_radius(*n) - 1.0) * largest > self.allowed(smallest);
        self.sides.unwrap_or_else(|| (n..MOST_SIDES).find(|n| !is_far(n)).unwrap_or(MOST_SIDES))
    }

    /// The gap at which wires with this smaller radius are joined.
    pub(super) fn gap(&self, smaller: f64) -> f64 {
        self.join.unwrap_or(JOIN_OVER_RADIUS * smaller)
    }
}
