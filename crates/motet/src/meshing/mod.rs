//! Floor 7: closed surfaces in, volume mesh out.
//!
//! | step | file | how |
//! |---|---|---|
//! | surfaces | `surfaces` | joined: equal points are one, triangles that surfaces share are one |
//! | check | [`crate::preflight`] | what would stop it, all of it, with ids and places |
//! | tets | [`crate::delaunay::constrain`] | every triangle is a facet of tets |
//! | labels | `fill` | what surfaces enclose is a region, triangles keep their patches |

mod fill;
mod surfaces;

pub use fill::{Filled, Report, fill};
pub use surfaces::Surfaces;
