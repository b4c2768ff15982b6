//! The kernel, which changes tets and keeps them valid: invariants, rules, refusals, walls.

#[path = "../common/mod.rs"]
mod common;

mod invariants;
mod refusals;
mod rules;
mod walls;
