//! OpenFOAM's `polyMesh`: a folder of points, faces, and the cells on both sides of each face.
//!
//! The layout is that of OpenFOAM's user guide, "Mesh description": faces between cells come first, owner below neighbour and by both rising; those of
//! the boundary follow, patch after patch. A face runs counter-clockwise seen from beyond its owner. Text and binary are read, of either size of
//! labels and scalars, and files packed by gzip.
//!
//! | file | idea |
//! |---|---|
//! | `file` | one file: header, words, lists |
//! | `folder` | where the files of a case are |
//! | `read`, `write` | a mesh in, a mesh out |
//!
//! Patches become surface cells with their names, `cellZones` regions. A path may be the case, its `polyMesh` folder, or ParaView's `NAME.foam` in the
//! case. Written is a folder that is called `polyMesh`; patches whose names begin with `wall` are of type `wall`, the others `patch`.

mod file;
mod folder;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::format::Format;

pub(super) use folder::{is_case, is_to_be_one};

pub(super) const FORMAT: Format = Format {
    name: "OpenFOAM polyMesh",
    endings: &["polymesh/", ".foam"],
    read: Some(read::read),
    write: Some(write::write),
};
