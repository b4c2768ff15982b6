//! Refinement and coarsening by division of tets.

#[path = "../common/mod.rs"]
mod common;

mod adaptation_loop;
mod criteria;
mod generations;
mod lines;
mod long;
mod memory;
mod sizes;
mod threads;
mod whole;
mod wishes;
