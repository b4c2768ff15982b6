//! Floor 3: searching in space.

mod boxes;
mod growing_boxes;
pub(crate) mod hilbert;
mod locate;
mod nearest;
pub(crate) mod runs;
pub mod trace;
mod winding;

pub use boxes::{Bounds, BoxTree};
pub(crate) use boxes::{bounding_box, expanded, squared_distance_to_box, touch};
pub(crate) use growing_boxes::GrowingBoxes;
pub use locate::{Located, Locator, OUTSIDE};
pub use nearest::{Closest, NearestTriangle};
pub use winding::WindingNumber;
pub(crate) use winding::winding_of_triangle;
