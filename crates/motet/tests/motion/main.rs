//! Motion of vertices with their walls, by each method.

#[path = "../common/mod.rs"]
mod common;

mod bodies;
mod curved;
mod distance;
mod graph;
mod guided;
mod slide;
mod slide_steps;
mod smooth;
mod solve;
mod stepped;
mod walls;
