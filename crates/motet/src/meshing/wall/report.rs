//! What became of a wall.

use serde::Serialize;

use super::super::layers;
use crate::base::reasons;
use crate::mesh::Spread;

/// What became of a wall.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// The number of the wall's region.
    pub region: i32,
    /// The name of the wall's region.
    pub name: String,
    /// The name of the patch on the outer side.
    pub outer: String,
    /// The names of the patches at the ends, where the wall is cut off.
    pub ends: Vec<String>,
    /// The triangles that lumen and wall share.
    pub interface: usize,
    /// The layers: cells, volume, and thickness beside that requested.
    pub layers: layers::Report,
    /// The EAS of the wall's tets, or of those that its prisms can be divided into.
    pub eas: Option<Spread>,
}

impl Report {
    /// Why the requested result was not reached; `None` if it was.
    pub fn not_reached(&self) -> Option<String> {
        let layers = &self.layers;
        let bare = || format!("there is no wall at {} of {} vertices", layers.without, layers.vertices);
        reasons([(layers.without > 0).then(bare)])
    }
}
