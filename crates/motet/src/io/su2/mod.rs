//! Meshes of SU2 (`.su2`).
//!
//! The cells of markers follow the others. Their markers are the array `su2:tag` (meshio's name), and patches
//! with their names; a marker whose name is a number has this number, others are numbered from 1. Meshes of
//! two dimensions are read as surfaces in the plane z = 0, whose markers label lines. SU2 has no regions.
//!
//! A mesh without volume cells in the plane z = 0 is written in two dimensions. Cells of markers that have no
//! label are in a marker `unlabelled`. Files of several zones and parts of a partitioned mesh are refused;
//! boxes for free-form deformation and other keys are skipped with a note.
//!
//! Layout: SU2's documentation, "Mesh File" (su2code.github.io/docs_v7/Mesh-File). Elements have VTK's
//! numbers and its order of nodes; the triangles of prisms have the orientation of VTK's older documentation,
//! as in files of Gmsh.

mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};
use crate::mesh::CellKind;

pub(super) const FORMAT: Format = Format {
    name: "SU2",
    extensions: &[".su2"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};

/// The array of the markers' numbers.
const TAG: &str = "su2:tag";

/// The name of the marker of cells without a label.
const UNLABELLED: &str = "unlabelled";

/// The kinds of elements of SU2, by dimension.
const KINDS: [&[CellKind]; 4] = [
    &[CellKind::VERTEX],
    &[CellKind::LINE],
    &[CellKind::TRIANGLE, CellKind::QUAD],
    &[CellKind::TETRA, CellKind::HEXAHEDRON, CellKind::WEDGE, CellKind::PYRAMID],
];

/// For each node of a cell, its position in the file.
fn order_of(kind: CellKind) -> &'static [usize] {
    const AS_HERE: &[usize; 8] = &[0, 1, 2, 3, 4, 5, 6, 7];
    match kind {
        CellKind::WEDGE => &[0, 2, 1, 3, 5, 4],
        _ => &AS_HERE[..kind.n_vertices().unwrap_or(0)],
    }
}
