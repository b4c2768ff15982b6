//! Exodus II (`.e`, `.exo`, `.ex2`), as Cubit, MOOSE, Sierra and ParaView write and read it: arrays of set
//! names in a netCDF file, either of the classic kind or HDF5.
//!
//! Blocks of elements become regions and patches by name and number, and so do side sets, whose facets become
//! cells; what overlaps becomes an array (`elset:NAME`, `surface:NAME`), node sets point arrays `nset:NAME`.
//! Variables of points and elements are read at the last step over time; three that end in X, Y and Z are a
//! vector. Other variables, maps of numbers and attributes are skipped.
//!
//! Files are written as classic netCDF with offsets of 64 bits (CDF-2; CDF-5 where an array needs it). Facets
//! of volume cells become side sets, other cells blocks; all values are of double precision.
//!
//! | file | idea |
//! |---|---|
//! | `classic`, `source` | arrays of a classic netCDF file; of either kind |
//! | `kinds` | types of elements, their nodes and sides |
//! | `sets`, `variables`, `read` | blocks and sets; values; the mesh |
//! | `layout`, `encode`, `write` | what goes into a file; its bytes; the mesh |
//!
//! Layout: EXODUS II: A Finite Element Data Model (Schoof, Yarberry, SAND92-2137, 1994; update of 2006) and
//! the NetCDF Classic Format Specification (Unidata, 2019).

mod classic;
mod encode;
mod kinds;
mod layout;
mod read;
mod sets;
mod source;
#[cfg(test)]
mod tests;
mod variables;
mod write;

use crate::io::{Format, Write};

/// The name for messages.
const NAME: &str = "Exodus II";

pub(super) const FORMAT: Format = Format {
    name: NAME,
    extensions: &[".exo", ".e", ".ex2", ".exii", ".g", ".gen"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
