//! Options for layers: which, and on which walls.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::geometry::vector::LARGEST;

/// The largest number of layers on one wall: no flow needs more, and a typing error should not fill the
/// memory.
pub const MOST_LAYERS: u32 = 200;

/// Layers on a wall, one on top of the other. Lengths are measured normal to the wall, in units of the
/// surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stack {
    /// The number of layers, at least 1.
    pub count: u32,
    /// Thickness of the layer at the wall.
    pub first: f64,
    /// The ratio of the thickness of each layer to that of the one before.
    pub growth: f64,
}

impl Stack {
    /// The height of each level above the wall, from 0 up to the top of the last layer.
    pub fn levels(&self) -> Vec<f64> {
        let (mut levels, mut thickness) = (vec![0.0], self.first);
        for k in 0..self.count as usize {
            levels.push(levels[k] + thickness);
            thickness *= self.growth;
        }
        levels
    }

    /// The total thickness of all layers.
    pub fn thickness(&self) -> f64 {
        self.levels().last().copied().unwrap_or(0.0)
    }

    /// Checks the stack.
    ///
    /// # Errors
    /// When the number of layers is out of range, or a layer has no thickness.
    pub fn check(&self) -> Result<()> {
        let refuse = |what: String, remedy: &str| Err(Error::options(what).remedy(remedy));
        let Self { count, first, growth } = *self;
        if !(1..=MOST_LAYERS).contains(&count) {
            return refuse(format!("the number of layers is {count}"), "request 1 to 200 layers");
        }
        if !(first > 0.0 && first.is_finite()) {
            return refuse(format!("the thickness of the first layer is {first}"), "give a length above 0");
        }
        if !(growth > 0.0 && growth.is_finite()) {
            return refuse(
                format!("the growth of layers is {growth}"),
                "give a ratio above 0: 1 for equal layers, 1.2 for each a fifth thicker than the last",
            );
        }
        let levels = self.levels();
        if !(levels[levels.len() - 1] <= LARGEST && levels.windows(2).all(|pair| pair[0] < pair[1])) {
            return refuse(
                format!(
                    "{count} layers starting at {first} and growing by {growth} are too thick or thin to represent"
                ),
                "request fewer layers, or a growth closer to 1",
            );
        }
        Ok(())
    }
}

/// Which walls get layers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// The stack for every triangle that is not on a cap and whose patch has no stack of its own. A cap is a
    /// flat part of the surface with at least three triangles and a crease of 45 degrees or more all around;
    /// if the whole surface consists of such parts, none is a cap. A triangle of a wall in the plane of an
    /// adjacent cap belongs to the cap. Default: `None`.
    pub everywhere: Option<Stack>,
    /// Stacks by patch. Default: none.
    pub by_patch: BTreeMap<i32, Stack>,
    /// Whether prisms stay wedges and pyramids, with quads on caps, instead of being divided into tets.
    /// Default: false.
    pub keep_prisms: bool,
}

impl Layers {
    /// Checks all stacks.
    ///
    /// # Errors
    /// When a stack is invalid, or there is none.
    pub fn check(&self) -> Result<()> {
        if self.everywhere.is_none() && self.by_patch.is_empty() {
            return Err(Error::options("layers are requested, but on no wall")
                .remedy("name a patch, or request layers everywhere"));
        }
        self.everywhere.iter().chain(self.by_patch.values()).try_for_each(Stack::check)
    }
}
