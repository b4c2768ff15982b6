//! Floor 7: closed surfaces in, volume mesh out.
//!
//! | step | file | how |
//! |---|---|---|
//! | surfaces | `surfaces` | joined: equal points are one, triangles that surfaces share are one |
//! | check | [`crate::preflight`] | what would stop it, all of it, with ids and places |
//! | layers | [`layers`] | thin prisms on walls, where they are asked for; what follows fills the room that they leave |
//! | points | `interior` | a lattice inside, a little away from the surface |
//! | tets | [`mod@crate::delaunay::constrain`] | every triangle is a facet of tets |
//! | quality | [`crate::remesh`] | bad tets repaired, the surface kept |
//! | labels | `fill` | what surfaces enclose is a region, triangles keep their patches |

mod compact;
mod fill;
mod interior;
pub mod layers;
mod surfaces;

pub use fill::{Filled, Options, Report, fill};
pub use surfaces::Surfaces;
