//! Universal files of I-DEAS (`.unv`), as Salome and Gmsh write them, too.
//!
//! Nodes (datasets 2411, 781 and 15), elements (2412) and groups (2467, 2477, 2452, 2435) are read. Groups
//! become labels by name and number as the sets of Abaqus files do: regions for volume cells, patches for
//! surface cells; groups that overlap others become cell arrays `elset:NAME` of 0 and 1, groups of nodes
//! point arrays `nset:NAME`. In a file without groups of elements the numbers of physical properties are the
//! labels, where there are several. Coordinates keep their unit; a note says which one it is if the file has
//! units other than SI (164). Other datasets are skipped with a note.
//!
//! Nodes, elements and groups (2467) are written. Pyramids, which I-DEAS does not have, are not.
//!
//! Layout: the descriptions of universal datasets by the Structural Dynamics Research Laboratory of the
//! University of Cincinnati (sdrl.uc.edu). The nodes of elements of second order go round each face, a corner
//! and the node after it, as in files of Gmsh.

mod kinds;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "UNV",
    extensions: &[".unv"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
