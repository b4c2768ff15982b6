//! HDF5, the container of VTKHDF and CGNS: groups, arrays and attributes in, and out.
//!
//! All that the crate `hdf5-pure` does is called from here, and nowhere else, so that another could take its place. It reads
//! what the C library writes (both kinds of groups, every chunk index, zlib, shuffle) and needs no C. What is added: an array
//! that is larger than the file can hold is refused before it is allocated, and a panic of the library becomes an error.
//! Links to other places, soft ones and those to other files, are passed over by the library: what stands behind them is not there.

mod read;
mod write;

pub(super) use read::{Array, Group, is_hdf5, open, open_in_place};
pub(super) use write::{Attribute, Node, Packing};
