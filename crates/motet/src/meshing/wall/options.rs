//! How a wall is made.

use super::super::layers::Stack;
use crate::base::{Error, Result};
use crate::geometry::vector::LARGEST;

/// How thick a wall is.
#[derive(Clone, Debug, PartialEq)]
pub enum Thickness {
    /// One thickness everywhere, in the unit of the mesh.
    Uniform(f64),
    /// One value for each point of the mesh, in its unit; those of points that are not on the wall are not
    /// used.
    AtPoints(Vec<f64>),
    /// This part of the local radius: that of the largest ball that touches the lumen from inside.
    OfRadius(f64),
}

/// How a wall is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How thick the wall is.
    pub thickness: Thickness,
    /// The number of layers, 1 to 200. Default: 1.
    pub layers: u32,
    /// The ratio of the thickness of each layer to that of the one inside it. Default: 1.
    pub growth: f64,
    /// The patches on which the wall stands; empty: all of the surface but caps, which are flat parts of at
    /// least three triangles with a crease of 45 degrees or more all around. Default: empty.
    pub on: Vec<String>,
    /// Whether prisms stay wedges and pyramids, with quads at the ends, instead of being divided into tets.
    /// Default: false.
    pub keep_prisms: bool,
    /// The name of the wall's region. Default: `wall`.
    pub name: String,
}

impl Options {
    /// One layer of a thickness.
    pub fn new(thickness: Thickness) -> Self {
        Self { thickness, layers: 1, growth: 1.0, on: Vec::new(), keep_prisms: false, name: "wall".into() }
    }

    /// The layers, in parts of the thickness.
    ///
    /// # Errors
    /// When the number of layers, their growth or the thickness is out of its range.
    pub(super) fn stack(&self) -> Result<Stack> {
        let (value, what) = match self.thickness {
            Thickness::Uniform(t) => (t, "the thickness of the wall"),
            Thickness::OfRadius(part) => (part, "the thickness as a part of the radius"),
            Thickness::AtPoints(_) => (1.0, ""),
        };
        if !(value > 0.0 && value <= LARGEST) {
            return Err(Error::options(format!("{what} must be a number above 0; got {value}")));
        }
        let first = Stack { count: self.layers, first: 1.0, growth: self.growth };
        first.check()?;
        if self.growth > LARGEST {
            return Err(Error::options(format!(
                "the growth of layers must be at most 1e60; got {}",
                self.growth
            )));
        }
        let stack = Stack { first: 1.0 / first.thickness(), ..first };
        stack.check().map(|()| stack)
    }
}
