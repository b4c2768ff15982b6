//! Floor 7: mesh motion. Boundary displacement in, volume mesh out.

mod boundary_motion;
mod matching;
mod prescribed;

pub use boundary_motion::{BoundaryMotion, Taken};
pub use matching::{Matching, SurfaceMotion, match_patch};
pub use prescribed::Prescribed;
