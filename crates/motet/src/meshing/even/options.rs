//! How a surface is made even.

use super::super::adapt::Adapting;
use super::super::sizes::Sizes;
use super::clip::Cut;
use crate::preflight::Repairs;

/// How a surface is made even.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The requested edge lengths, those at points one for each point of the mesh; `None`: the length of the
    /// edges of as many even triangles. Default: `None`.
    pub sizes: Option<Sizes>,
    /// How far the surface may stray, and which edges are creases.
    pub adapting: Adapting,
    /// What is cut off first. Default: nothing.
    pub cuts: Vec<Cut>,
    /// What is repaired first; triangles without area are dropped in any case. Default: nothing.
    pub repairs: Repairs,
    /// How many passes of smoothing come before: vertices move, but those of rims, borders of patches and
    /// creases. Distances are then measured from the smoothed surface. Default: 0.
    pub smooth: usize,
    /// For each point of the mesh, whether it stays where it is; edges between two such points stay as well.
    /// Empty if none has to. Default: empty.
    pub held: Vec<bool>,
}
