//! Floor 6: the Delaunay triangulation of any point set in space, exact.

mod cavity;
mod conflict;
mod edges;
mod fill;
mod finish;
mod gauge;
mod input;
mod insert;
mod order;
mod start;
mod store;
mod triangulation;
mod walk;

pub use triangulation::{HullFacet, Triangulation};
