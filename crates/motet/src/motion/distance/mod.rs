//! Two more methods, by distances from the boundary alone, for comparison. Neither knows of walls or cells.

mod inverse;
mod radial;

pub(crate) use inverse::InverseDistance;
pub(crate) use radial::Radial;
