//! Meshes that move with their walls over many steps.

#[path = "../common/mod.rs"]
mod common;

mod drift;
mod ends;
mod gaps;
mod inside;
mod reports;
mod script;
mod steps;
