//! The three cases of the paper on dynamic remeshing: a sphere in a channel, a box with a membrane, a cube
//! that is distorted.

pub mod channel;
pub mod cube;
pub mod harmonic;
pub mod measure;
pub mod membrane;
pub mod meshes;
pub mod scatter;
pub mod transfer;

use motet::remesh::{Options, SurfaceRule};

/// Repair of bad tets with the surface kept. None of the meshes has boundary layers: tets that motion makes
/// thin are not exempt.
pub fn keep() -> Options {
    Options { keep_layers: false, ..Options::default() }
}

/// Repair of bad tets with a surface that adapts.
pub fn adapt() -> Options {
    Options { surface: SurfaceRule::Adapt { distance: None }, ..keep() }
}
