//! Volume meshes of surfaces.

#[path = "../common/mod.rs"]
mod common;

mod adapt;
mod divide;
mod layers;
mod sizes_and_regions;
mod tubes;
mod voids;
mod wall;
