//! Delaunay tets of points and of surfaces.

#[path = "../common/mod.rs"]
mod common;

mod cad;
mod constrain;
mod hard_cases;
mod triangulation;
