//! Floor 7: how far apart surfaces are, where, and when they will touch.

mod crossing;
mod inside;
mod runs;
mod sweep;

pub use crossing::{crossings, own_crossings};
pub use inside::{inside, is_closed};
pub use sweep::{FirstContact, Sweep, sweep, sweep_own};
