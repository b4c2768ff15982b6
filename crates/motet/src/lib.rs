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
//! | [`ops`] | 5 | operations that propose a change: split, collapse, swap, smooth, insert |
//! | [`delaunay`] | 5 | the exact Delaunay triangulation of any point set, and the constrained one of surfaces |
//! | [`preflight`] | 6 | what stops closed surfaces from being meshed: found exactly, all of it |
//! | [`refine`] | 6 | tets divided over many generations without loss of shape, and merged again |
//! | [`remesh`] | 6 | bad tets, and only those, found, classified and repaired |
//! | [`surface`] | 7 | triangle surfaces made even, within a distance of what they were |
//! | [`motion`] | 7 | boundary displacement in, volume mesh out |
//! | [`contact`] | 7 | how far apart surfaces are, where, and when they will touch |
//! | [`meshing`] | 8 | closed surfaces in, volume mesh out |
//! | [`implant`] | 9 | devices put into a mesh, one conforming mesh out |
//! | [`moving`] | 10 | the loop: moved, repaired, refined, watched, carried, step after step |
//!
//! A module imports only from lower floors; `tests/layers.rs` enforces this.
//!
//! [`algebra`], [`kernel`] and [`ops`] are internal: public for tests, benchmarks and extensions, and may
//! change with any version. The others follow semantic versioning.
//!
//! | feature | adds | crates |
//! |---|---|---|
//! | none | [`base`], [`geometry`], [`mesh`], [`spatial`] | |
//! | `delaunay` | [`kernel`], [`delaunay`] | |
//! | `io` | [`io`], without HDF5 and lzma | `quick-xml`, `flate2`, `serde`, ... |
//! | `suite` | all other modules, and `io` | `serde_json`, `strsim` |
//! | `elasticity` | motion as an elastic body and by Laplace's equation | `faer` |
//! | `hdf5` | files in VTKHDF, CGNS, MED and Fluent's HDF5, numbers of XDMF | `hdf5-pure` |
//! | `lzma` | VTK's XML files compressed with lzma | `lzma-rust2` |
//! | `parallel` | more than one thread | `rayon` |
//! | `serde` | reports, histories and ids can be stored | `serde` |
//!
//! By default all are on. `motet = { version = "0.1", default-features = false, features = ["delaunay"] }`
//! compiles the triangulations with 14 crates in all.

#![cfg_attr(
    not(all(feature = "suite", feature = "elasticity", feature = "hdf5")),
    allow(dead_code, unused_imports, reason = "used by parts of the library that are left out")
)]

#[cfg(feature = "suite")]
pub mod algebra;
pub mod base;
#[cfg(feature = "suite")]
pub mod contact;
#[cfg(feature = "delaunay")]
pub mod delaunay;
pub mod geometry;
#[cfg(feature = "suite")]
pub mod implant;
#[cfg(feature = "io")]
pub mod io;
#[cfg(feature = "delaunay")]
pub mod kernel;
pub mod mesh;
#[cfg(feature = "suite")]
pub mod meshing;
#[cfg(feature = "suite")]
pub mod motion;
#[cfg(feature = "suite")]
pub mod moving;
#[cfg(feature = "suite")]
pub mod ops;
#[cfg(feature = "suite")]
pub mod preflight;
#[cfg(feature = "suite")]
pub mod refine;
#[cfg(feature = "suite")]
pub mod remesh;
pub mod spatial;
#[cfg(feature = "suite")]
pub mod surface;

pub use base::{Error, ErrorKind, Result};
pub use mesh::Mesh;
