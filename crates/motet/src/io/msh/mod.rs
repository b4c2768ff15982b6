//! Gmsh's MSH, versions 2.2 and 4.1, ascii and binary in either order of bytes.
//!
//! Labels: physical groups of volumes are regions, those of surfaces patches, with
//! the names of `$PhysicalNames`; names of groups of curves and points become field
//! data `curve:NAME` and `point:NAME`. The groups of all cells are the array
//! `gmsh:physical`, their entities `gmsh:geometrical`, partitions
//! `gmsh:partition`, the entities of nodes `gmsh:dim_tags` (meshio's names). A cell
//! in several groups keeps the first.
//!
//! `$NodeData` and `$ElementData` are arrays in double precision; values by element
//! *and* node, `$Periodic` and sections that Gmsh does not define are passed over
//! with a note. Points keep the order of the file, whatever their numbers. Elements
//! up to the second order are read; see `kinds` for their orders of nodes.
//!
//! Version 4.1 is written unless 2.2 is asked for, or some cells have a label and
//! others none: meshio (5.3) cannot read that in 4.1.
//!
//! `mshio` (0.4, 2020) was tried: it reads 4.1 ascii, but not the binary files of
//! meshio, not 2.2, no names and no data, and writes nothing.

mod data;
mod entities;
mod kinds;
mod read;
mod sink;
mod source;
mod write;

use crate::io::Format;

pub(super) const FORMAT: Format =
    Format { name: "Gmsh MSH", endings: &[".msh"], read: Some(read::read), write: Some(write::write) };
