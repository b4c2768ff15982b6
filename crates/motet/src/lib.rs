//! motet keeps tetrahedral meshes good while the world in them moves.
//!
//! | module | floor | what it holds |
//! |---|---|---|
//! | [`base`] | 0 | typed ids, lists of lists, errors, threads |
//! | [`algebra`] | 1 | sparse matrices, and solving with them |
//! | [`geometry`] | 1 | pure functions on points: exact signs, simplices, quality, distances |
//! | [`mesh`] | 2 | the exchange form: points, cells of any kind, fields, labels, shapes |
//! | [`io`] | 3 | one file per format, their registry, time series |
//! | [`spatial`] | 3 | searching: which tet contains a point, which facet is nearest |
//! | [`kernel`] | 4 | tets that can be changed: cavity, check, commit, undo |
//! | [`preflight`] | 4 | what stops closed surfaces from being meshed: found exactly, all of it |
//! | [`ops`] | 5 | operations that propose a change: split, collapse, swap, smooth, insert |
//! | [`delaunay`] | 6 | the exact Delaunay triangulation of any point set, and the constrained one of surfaces |
//! | [`refine`] | 6 | tets divided over many generations without loss of shape, and merged again |
//! | [`remesh`] | 6 | bad tets, and only those, found, classified and repaired |
//! | [`motion`] | 7 | boundary displacement in, volume mesh out |
//! | [`meshing`] | 7 | closed surfaces in, volume mesh out |
//! | [`contact`] | 7 | how far apart surfaces are, where, and when they will touch |
//! | [`implant`] | 8 | devices put into a mesh, one conforming mesh out |
//! | [`moving`] | 9 | the loop: moved, repaired, refined, watched, carried, step after step |
//!
//! A module imports only from lower floors; `tests/layers.rs` enforces this.

pub mod algebra;
pub mod base;
pub mod contact;
pub mod delaunay;
pub mod geometry;
pub mod implant;
pub mod io;
pub mod kernel;
pub mod mesh;
pub mod meshing;
pub mod motion;
pub mod moving;
pub mod ops;
pub mod preflight;
pub mod refine;
pub mod remesh;
pub mod spatial;

pub use base::{Error, ErrorKind, Result};
pub use mesh::Mesh;
