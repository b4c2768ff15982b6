//! Meshes: their facets, their defects, curved cells, arrays across changes, built-in shapes.

#[path = "../common/mod.rs"]
mod common;

mod adjacency;
mod check;
mod curved;
mod device_shapes;
mod history;
mod shapes;
mod vessel_shapes;
