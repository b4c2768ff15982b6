//! VTK's XML files: `.vtu`, `.vtp`, and the parts that both share.
//!
//! Implemented here rather than with the crate `vtkio`: its last stable version reads no compressed files,
//! and its release candidate (0.7.0-rc2) fails on raw appended data, which ParaView writes, silently loses
//! point data compressed with xz, and panics on polygonal data from PyVista. `quick-xml` reads the XML part;
//! the data after it are addressed by byte offsets.
//!
//! | file | idea |
//! |---|---|
//! | `document` | the XML as a tree, up to the appended data |
//! | `payload` | one array's bytes: header and blocks |
//! | `codec`, `xz` | zlib, lz4; xz |
//! | `tail` | large raw data, left in the file until an array is read |
//! | `file` | layout of the file; arrays as values |
//! | `pieces`, `parts` | pieces of a file, and files that refer to others, joined |
//! | `polyhedra` | faces of polyhedra, in both layouts |
//! | `vtu`, `vtp` | the two kinds of meshes |
//! | `writer` | writes elements and arrays |

mod codec;
mod document;
mod file;
mod parts;
mod payload;
mod pieces;
mod polyhedra;
mod tail;
mod vtp;
mod vtu;
mod writer;
mod xz;

use crate::base::{Error, Result, Threads};
use crate::io::format::{Format, Input, Notes, Write};
use crate::mesh::Mesh;

pub(super) use document::{Document, Element};
pub(super) use tail::Tail;
pub(super) use writer::escape_attribute;

/// Unstructured grids: cells of any kind.
pub(super) const VTU: Format = Format {
    name: "VTK XML unstructured grid",
    extensions: &[".vtu"],
    read: Some(read),
    write: Some(Write::File(vtu::write)),
};

/// Polygonal data: vertices, lines, polygons, strips.
pub(super) const VTP: Format = Format {
    name: "VTK XML polygonal data",
    extensions: &[".vtp"],
    read: Some(read),
    write: Some(Write::File(vtp::write)),
};

/// Files that refer to others, which together form a mesh.
pub(super) const PARTS: Format = Format {
    name: "VTK XML in several files",
    extensions: &[".pvtu", ".pvtp", ".vtm", ".vtmb", ".vtpd"],
    read: Some(read),
    write: None,
};

/// Kinds of VTK XML files that are recognized only to reject them with advice.
pub(super) const OTHERS: Format = Format {
    name: "VTK XML",
    extensions: &[".vti", ".vtr", ".vts", ".pvti", ".pvtr", ".pvts"],
    read: Some(read),
    write: None,
};

/// Reads the kind of mesh that the file declares.
fn read(input: &Input<'_>) -> Result<Mesh> {
    let file = file::File::open(input.bytes, input.threads, input.notes)?;
    if parts::refers_to_parts(file.kind()) { parts::read(&file, input) } else { read_file(&file) }
}

/// Reads a mesh, like [`read`], from a file whose appended data are read array by array.
pub(super) fn read_tail(tail: &Tail, threads: &Threads, notes: &Notes) -> Result<Mesh> {
    read_file(&file::File::open_tail(tail, threads, notes)?)
}

fn read_file(file: &file::File<'_>) -> Result<Mesh> {
    match file.kind() {
        "UnstructuredGrid" => vtu::read(file),
        "PolyData" => vtp::read(file),
        other => Err(Error::input(format!("expected a mesh of points and cells, found {other}"))
            .at("VTKFile")
            .remedy(remedy(other))),
    }
}

fn remedy(kind: &str) -> &'static str {
    match kind {
        "Collection" => "it is a series: read the files that it lists",
        "ImageData" | "RectilinearGrid" | "StructuredGrid" => {
            "convert it to .vtu: in ParaView, apply `Append Datasets` (vtkAppendFilter)"
        }
        _ => "save it as .vtu or .vtp",
    }
}
