//! Floor 4: what stops closed surfaces from being meshed: found exactly, all of it.

mod crossing;

pub use crossing::{crossings, own_crossings};
