//! The three cases of the paper on dynamic remeshing: a sphere in a channel, a box with a membrane, a cube that is distorted.

pub mod channel;
pub mod cube;
pub mod harmonic;
pub mod measure;
pub mod membrane;
pub mod meshes;
pub mod scatter;
