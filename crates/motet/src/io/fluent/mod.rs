//! Meshes and cases of Ansys Fluent and of the meshers that write for it (`.msh`, `.cas`, `.cas.gz`, and in
//! HDF5 `.msh.h5`, `.cas.h5`): points and faces, each with the cells on its sides.
//!
//! Text, binary sections and HDF5 are read. Zones of cells are regions, zones of faces patches, with their
//! numbers and names; faces between cells become cells only where their zone is a wall or another border.
//! Files of two dimensions and meshes with hanging nodes are refused; so are, in HDF5, several meshes in
//! one file and interfaces of zones that do not match. `.msh` is also the extension of Gmsh: contents tell
//! which one a file is. meshio's files of this format, which list the nodes of cells, are read, too.
//!
//! The mesh is written as text; Fluent reads it as a mesh or as a case without settings. A zone of faces gets
//! its type from the start of its name: `inlet` a velocity inlet, `outlet` a pressure outlet, `symmetry`;
//! others are walls.
//!
//! Layout: the appendix "Mesh File Format" of Fluent's User's Guide; of HDF5 ("Common Fluids Format") what
//! VTK's reader takes. Faces run as VTK's readers take them: along the fingers of a right hand whose thumb
//! points into the first of the two cells.
//!
//! | file | idea |
//! |---|---|
//! | `scan` | sections, their numbers, text and binary |
//! | `read` | reads sections |
//! | `cff` | reads HDF5 |
//! | `content` | what was read as a mesh |
//! | `write` | writes a mesh |

mod cff;
#[cfg(test)]
mod cff_tests;
mod content;
mod read;
mod scan;
#[cfg(test)]
mod tests;
mod write;

use crate::io::format::{Format, Write};

pub(super) use read::read;
pub(super) use scan::has_sections;

pub(super) const FORMAT: Format = Format {
    name: "Fluent",
    extensions: &[".cas", ".cas.gz"],
    read: Some(read),
    write: Some(Write::File(write::write)),
};

/// The form in HDF5, which is not written: Fluent reads text as well.
pub(super) const HDF5: Format =
    Format { name: "Fluent (HDF5)", extensions: &[".cas.h5", ".msh.h5"], read: Some(cff::read), write: None };

/// Kinds of sections, without the thousands that tell how numbers are stored.
mod index {
    pub(super) const DIMENSION: u32 = 2;
    pub(super) const NODES: u32 = 10;
    pub(super) const CELLS: u32 = 12;
    pub(super) const FACES: u32 = 13;
    pub(super) const ZONE: u32 = 39;
    pub(super) const ZONE_OF_MESHERS: u32 = 45;
    pub(super) const CELL_TREE: u32 = 58;
    pub(super) const FACE_TREE: u32 = 59;
}

/// The type of a zone of faces between cells, which is no border.
const INTERIOR: i64 = 2;
