//! Floor 3: searching in space.

pub(crate) mod hilbert;
mod locate;
mod nearest;

pub use locate::{Located, Locator, OUTSIDE};
pub use nearest::{Closest, NearestTriangle};
