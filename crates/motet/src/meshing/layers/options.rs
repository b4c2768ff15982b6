//! What layers are asked for, and where.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::geometry::vector::LARGEST;

/// More layers than this on one wall are refused: no flow needs them, and a slip of the pen should not fill the memory.
pub const MOST_LAYERS: u32 = 200;

/// Layers on a wall, one on the other: how many, and how thick. Lengths are at right angles to the wall, in units of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stack {
    /// How many layers; at least 1.
    pub count: u32,
    /// Thickness of the layer at the wall.
    pub first: f64,
    /// How many times as thick as the one before each layer is.
    pub growth: f64,
}

impl Stack {
    /// How high each level lies above the wall, from 0 up to the top of the last layer.
    pub fn levels(&self) -> Vec<f64> {
        let (mut levels, mut thickness) = (vec![0.0], self.first);
        for k in 0..self.count as usize {
            levels.push(levels[k] + thickness);
            thickness *= self.growth;
        }
        levels
    }

    /// The thickness of all layers together.
    pub fn thickness(&self) -> f64 {
        self.levels().last().copied().unwrap_or(0.0)
    }

    /// # Errors
    /// When there is no layer, or too many, or one without thickness.
    pub fn check(&self) -> Result<()> {
        let refuse = |what: String, remedy: &str| Err(Error::options(what).remedy(remedy));
        let Self { count, first, growth } = *self;
        if !(1..=MOST_LAYERS).contains(&count) {
            return refuse(format!("{count} layers"), "ask for 1 to 200 layers");
        }
        if !(first > 0.0 && first.is_finite()) {
            return refuse(format!("a first layer of thickness {first}"), "give a length above 0");
        }
        if !(growth > 0.0 && growth.is_finite()) {
            return refuse(
                format!("layers that grow by {growth}"),
                "give a ratio above 0: 1 for layers that are all alike, 1.2 for each a fifth thicker",
            );
        }
        let levels = self.levels();
        if !(levels[levels.len() - 1] <= LARGEST && levels.windows(2).all(|pair| pair[0] < pair[1])) {
            return refuse(
                format!("{count} layers from {first} on that grow by {growth} are beyond numbers"),
                "ask for fewer layers, or a growth nearer to 1",
            );
        }
        Ok(())
    }
}

/// Which walls get layers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// On every triangle that is no cap and whose patch has no stack of its own. A cap is a flat part of the surface, three triangles or more,
    /// with a crease of 45 degrees or more all round; where the whole surface is made of such parts, none is a cap. A
    /// triangle of a wall that lies in the plane of a cap beside it is a part of the cap. Default: `None`.
    pub everywhere: Option<Stack>,
    /// By patch. Default: none.
    pub by_patch: BTreeMap<i32, Stack>,
    /// Whether prisms stay as they are: wedges and pyramids, quads on caps. Otherwise they are divided into tets. Default: false.
    pub keep_prisms: bool,
}

impl Layers {
    /// # Errors
    /// When a stack means nothing, or there is none.
    pub fn check(&self) -> Result<()> {
        if self.everywhere.is_none() && self.by_patch.is_empty() {
            return Err(Error::options("layers on no wall").remedy("name a patch, or give layers for all"));
        }
        self.everywhere.iter().chain(self.by_patch.values()).try_for_each(Stack::check)
    }
}
