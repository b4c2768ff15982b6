//! Floor 7: mesh motion. Boundary displacement in, volume mesh out.

mod matching;
mod prescribed;

pub use matching::{SurfaceMotion, match_points};
pub use prescribed::Prescribed;
