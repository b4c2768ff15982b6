//! OpenFOAM's `polyMesh`: a folder of points, faces, and the cells on both sides of each face.
//!
//! The layout is that of OpenFOAM's user guide, "Mesh description": faces between cells come first, the owner
//! being the lower cell, sorted by owner and neighbour; boundary faces follow, patch by patch. A face runs
//! counter-clockwise seen from outside its owner. Text and binary files with either size of labels and
//! scalars are read, and gzip files.
//!
//! | file | idea |
//! |---|---|
//! | `file` | one file: header, words, lists |
//! | `folder` | locates the files of a case |
//! | `read`, `write` | read and write a mesh |
//!
//! Patches become surface cells with their names, `cellZones` regions. A path may be the case, its `polyMesh`
//! folder, or ParaView's `NAME.foam` in the case. Writing creates a folder called `polyMesh`; patches whose
//! names begin with `wall` have the type `wall`, the others `patch`.

mod file;
mod folder;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::format::{Format, Write};

pub(super) use folder::{is_case, is_polymesh_name};

pub(super) const FORMAT: Format = Format {
    name: "OpenFOAM polyMesh",
    extensions: &["polymesh/", ".foam"],
    read: Some(read::read),
    write: Some(Write::Files(|mesh, options, threads, _| write::write(mesh, options, threads))),
};
