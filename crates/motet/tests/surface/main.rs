//! Surfaces made even: as near as allowed, closed, free of crossings, without narrow triangles.

#[path = "../common/mod.rs"]
mod common;

mod alone;
mod clip;
mod even;
