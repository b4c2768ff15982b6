//! Floor 1: pure functions on points, without any knowledge of meshes.

pub mod bernstein;
pub(crate) mod deepest;
pub mod distance;
pub(crate) mod fused;
pub mod overlap;
pub mod predicates;
pub mod quality;
pub mod rigid;
pub(crate) mod rounding;
pub mod segment;
pub mod symmetric;
pub mod tent;
pub mod tet;
pub mod triangle;
pub(crate) mod unit;
pub mod vector;
mod weights;

pub use weights::weights;
