//! Floor 3: searching in space.

mod nearest;

pub use nearest::{Closest, NearestTriangle};
