//! Two more ways for the volume to follow, by distances from the boundary alone: to compare with. Neither knows walls or cells.

mod inverse;
mod radial;

pub(crate) use inverse::Inverse;
pub(crate) use radial::Radial;
