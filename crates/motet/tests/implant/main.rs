//! Devices that are put into meshes.

#[path = "../common/mod.rs"]
mod common;

mod devices;
mod tangled;
mod touching;
mod walls;
