//! XDMF (`.xdmf`, `.xmf`): meshes and arrays described in XML, with the numbers in the same file or in an
//! HDF5 file beside it, as FEniCS, dolfinx and meshio write them.
//!
//! The mesh is the first uniform grid of the domain. Grids of the same points that follow add to it: their
//! arrays, or their cells where they have some of their own. So the tags of dolfinx become labels: those of
//! facets are cells more with the array `patch`, those of cells the array `region`. Of a collection over time
//! the first grid is read, with a note. Names of labels are those that meshio puts into `Information`.
//! Structured grids, functions of arrays and other collections are refused or skipped with a note.
//!
//! A mesh whose cells of the highest dimension are of one kind is written as dolfinx reads it: a grid `mesh`
//! of these, and further grids of the same points, `facet_tags` for those of the next dimension, with their
//! arrays, labels first. An array that is zero in a grid is left out there. Where this changes the order of
//! the cells, the array `motet:cell` says where each was. Other meshes are one grid of mixed cells.
//!
//! Files are written in version 3, with the numbers in `NAME.h5` beside `NAME.xdmf`, or as text in the file
//! itself for the encoding `ascii` and without the feature `hdf5`.
//!
//! Layout: "XDMF Model and Format" (xdmf.org), and files of dolfinx 0.9 (2024). The nodes of cells are in
//! VTK's order.

mod data;
mod grid;
mod kinds;
mod parts;
mod read;
mod tags;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "XDMF",
    extensions: &[".xdmf", ".xmf", ".xdmf3"],
    read: Some(read::read),
    write: Some(Write::Files(write::write)),
};
