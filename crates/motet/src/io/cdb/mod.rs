//! Archives of Ansys Mechanical APDL (`.cdb`), as its command CDWRITE writes them, and input files of Ansys
//! Mechanical with the same blocks.
//!
//! Nodes (NBLOCK), elements (EBLOCK, with the element types of ET and ETBLOCK) and components (CMBLOCK) are
//! read. Bricks and quads that repeat nodes are the wedges, pyramids, tets and triangles that they stand for.
//! An element that lacks some of its middle nodes is read without them.
//!
//! Components become labels by name as the sets of Abaqus files do: regions for volume cells, patches for
//! surface cells; components that overlap others become cell arrays `elset:NAME` of 0 and 1, components of
//! nodes point arrays `nset:NAME`. Where elements have several materials, the numbers of these are the
//! labels; a component of exactly the elements of a material gives its name. Contact elements, springs,
//! materials and loads are skipped with a note. Files with a command for each node and element are refused.
//!
//! Nodes, elements and components are written. Regions and patches are both the material and a component of
//! their elements. Tets are written as SOLID285 and SOLID187, other volume cells as SOLID185 and SOLID186.
//! Surface cells are written as SHELL181 and SHELL281, in a mesh with volume cells as MESH200, which
//! contributes nothing to a solution; so are lines.
//!
//! Layout: Ansys Mechanical APDL Command Reference (CDWRITE, NBLOCK, EBLOCK, ETBLOCK, CMBLOCK) and Element
//! Reference, whose order of nodes is VTK's.

mod columns;
mod commands;
mod kinds;
mod labels;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "Ansys archive",
    extensions: &[".cdb"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
