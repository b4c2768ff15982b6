//! Bulk data of Nastran (`.bdf`, `.nas`), as MSC, NX, OptiStruct, Gmsh and COMSOL write and read them.
//!
//! Points (`GRID`) and elements are read, in fields of 8 or 16 characters and in free fields. The numbers of
//! properties are the array `nastran:ref`, as with meshio: labels of regions and patches. Their names are
//! read from the comments of ANSA, HyperMesh and Femap. Points must be in the basic coordinate system. Other
//! cards, such as materials and loads, are skipped with a note, and so are the parts before `BEGIN BULK`.
//!
//! Points are written in fields of 16 characters, which cannot hold all digits of all numbers; elements in
//! fields of 8 where their numbers fit. Cells get properties, whose names are comments as of HyperMesh.
//! Properties themselves, materials and loads are to be added, and `SOL 101` to be adapted, for a solver.
//!
//! Layout: NX Nastran 10 User's Guide and Quick Reference Guide (Siemens 2014). Middle nodes of bricks and
//! wedges go round the bottom, then up, then round the top.

mod cards;
mod kinds;
mod names;
mod number;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};

/// The array of the numbers of properties.
const REF: &str = "nastran:ref";

pub(super) const FORMAT: Format = Format {
    name: "Nastran",
    extensions: &[".bdf", ".nas", ".nastran", ".fem"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
