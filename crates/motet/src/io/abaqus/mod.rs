//! Input files of Abaqus and CalculiX: the mesh in them, `.inp`.
//!
//! Nodes, elements, sets and surfaces are read, flat or in parts with instances, which may be shifted and turned,
//! and from included files. The rest of a model (materials, loads, steps) is passed over with a note.
//!
//! Sets of elements are labels: those of volume cells regions, those of surface cells patches, by name. Sets may
//! overlap and labels may not. So for volume cells, and for surface cells, the first of these kinds of sets is taken
//! that reaches all cells, or the one that reaches most: sets with a section, sets of `*ELSET`, sets of `*ELEMENT`,
//! instances where there are several; sets of all cells last. A set that overlaps those before it is a cell array
//! `elset:NAME` of 0 and 1, and so is one that is no label; sets of nodes are point arrays `nset:NAME`. Surfaces on
//! elements become patches: faces of volume cells that are no cells yet are put behind the others. A surface that
//! overlaps other patches is a cell array `surface:NAME`. Of sets that a preprocessor made for itself (`INTERNAL`)
//! only those with a section count. With several instances names are `INSTANCE.NAME`.
//!
//! Labels have no numbers here: names `REGION_3` and `PATCH_3` stand for number 3 without a name, others are
//! counted from 1.
//!
//! Written are nodes, elements, sets, and the patches that lie on volume cells also as surfaces, for loads.
//! Surface cells are shells (`S3` and so on): who wants solids alone takes those blocks out.
//!
//! Layout: Abaqus Keywords Guide (`*NODE`, `*ELEMENT`, `*ELSET`, `*SURFACE`, `*INSTANCE`), "Input syntax rules", and
//! the element library, whose numbering of nodes and faces the CalculiX manual repeats.

mod assemble;
mod kinds;
mod labels;
mod line;
mod model;
mod names;
mod read;
mod scope;
mod sets;
mod surfaces;
#[cfg(test)]
mod tests;
mod write;

use crate::io::Format;

pub(super) const FORMAT: Format = Format {
    name: "Abaqus",
    endings: &[".inp"],
    read: Some(read::read),
    write: Some(|mesh, _| write::write(mesh)),
};

/// Before the name of an array that stands for a set of nodes.
const NSET: &str = "nset:";
/// Before the name of an array that stands for a set of elements.
const ELSET: &str = "elset:";
/// Before the name of an array that stands for a surface.
const SURFACE: &str = "surface:";
