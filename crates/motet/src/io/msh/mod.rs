//! Gmsh's MSH format, versions 2.2 and 4.1, ASCII and binary in either byte order.
//!
//! Labels: physical groups of volumes are regions, those of surfaces patches, with the names of
//! `$PhysicalNames`; names of groups of curves and points become field data `curve:NAME` and `point:NAME`.
//! The groups of all cells are the array `gmsh:physical`, their entities `gmsh:geometrical`, partitions
//! `gmsh:partition`, the entities of nodes `gmsh:dim_tags` (meshio's names). A cell in several groups keeps
//! the first.
//!
//! `$NodeData` and `$ElementData` are arrays in double precision; values by element *and* node, `$Periodic`
//! and sections that Gmsh does not define are skipped with a note. Points keep the order of the file,
//! whatever their numbers. Elements up to second order are read; see `kinds` for their node orders.
//!
//! Version 4.1 is written unless 2.2 is requested, or only some cells have a label: meshio (5.3) cannot read
//! such files in version 4.1.
//!
//! Not used: `mshio` (0.4, 2020), which reads ASCII 4.1, but no binary files of meshio, no version 2.2, no
//! names and no data, and does not write.

mod data;
mod entities;
mod kinds;
mod read;
mod sink;
mod source;
mod write;

use crate::base::Result;
use crate::io::fluent;
use crate::io::format::{Format, Input, Write};
use crate::mesh::Mesh;

pub(super) const FORMAT: Format = Format {
    name: "Gmsh MSH",
    extensions: &[".msh"],
    read: Some(read),
    write: Some(Write::File(write::write)),
};

/// Reads the file, which may also be one of Fluent.
fn read(input: &Input<'_>) -> Result<Mesh> {
    if fluent::has_sections(input.bytes) { fluent::read(input) } else { read::read(input) }
}
