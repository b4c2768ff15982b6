//! HDF5, the container of VTKHDF, CGNS, MED and Fluent: reads and writes groups, arrays and attributes.
//!
//! All calls to the crate `hdf5-pure` are made here, so that it can be replaced. It reads what the C library
//! writes (both kinds of groups, every chunk index, zlib, shuffle) and needs no C. Added here: an array
//! larger than the file can hold is rejected before allocation, and a panic of the library becomes an error.
//! The library skips soft and external links: their targets are not visible.
//!
//! Without the feature `hdf5` no file is opened or written: each call is refused.

#[cfg(not(feature = "hdf5"))]
mod absent;
#[cfg(feature = "hdf5")]
mod read;
mod tree;
#[cfg(feature = "hdf5")]
mod write;

#[cfg(not(feature = "hdf5"))]
pub(super) use absent::{Array, Group, is_hdf5, open, open_in_place};
#[cfg(feature = "hdf5")]
pub(super) use read::{Array, Group, is_hdf5, open, open_in_place};
pub(super) use tree::{Attribute, Node, Storage};
