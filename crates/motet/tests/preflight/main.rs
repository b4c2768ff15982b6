//! Surfaces before they are meshed: their faults, and what repairs make of them.

#[path = "../common/mod.rs"]
mod common;

mod faults;
mod joints;
mod oracle;
mod repair;
mod union;
mod wrap;
