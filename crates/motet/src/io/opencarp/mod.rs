//! openCARP's files: `.pts`, `.elem`, and `.lon` if it is present.
//!
//! Any of the names reads all files with the same stem. The region of each element is the array `elemTag`,
//! its directions are the vector arrays `fiber` and `sheet`, all as meshtool names them in VTK files. All
//! three are written; of other labels, regions and patches become the regions of elements. openCARP's
//! coordinates are in micrometres; numbers are kept as they are, in either direction.
//!
//! Layout: CARPentry's documentation, "File formats" (carp.medunigraz.at/file_formats.html); the order of
//! nodes is that in which meshtool, openCARP's converter, writes elements as VTK's.

mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};
use crate::mesh::CellKind;

pub(super) const FORMAT: Format = Format {
    name: "openCARP",
    extensions: &[".pts", ".elem", ".lon"],
    read: Some(read::read),
    write: Some(Write::Files(|mesh, options, threads, _| write::write(mesh, options, threads))),
};

/// The array of the elements' regions.
const TAG: &str = "elemTag";

/// The arrays of directions, in the order of the columns of `.lon`.
const DIRECTIONS: [&str; 2] = ["fiber", "sheet"];

/// An element type: its name, the kind of cell, and for each node in VTK's order its position in openCARP's.
type ElementType = (&'static str, CellKind, &'static [usize]);

/// The element types. `Cx` is an older name of lines, which is only read.
const TYPES: &[ElementType] = &[
    ("Tt", CellKind::TETRA, &[0, 1, 2, 3]),
    ("Tr", CellKind::TRIANGLE, &[0, 1, 2]),
    ("Ln", CellKind::LINE, &[0, 1]),
    ("Cx", CellKind::LINE, &[0, 1]),
    ("Qd", CellKind::QUAD, &[0, 1, 2, 3]),
    ("Py", CellKind::PYRAMID, &[0, 1, 2, 3, 4]),
    ("Pr", CellKind::WEDGE, &[0, 1, 2, 3, 5, 4]),
    ("Hx", CellKind::HEXAHEDRON, &[5, 6, 7, 4, 3, 2, 1, 0]),
];
