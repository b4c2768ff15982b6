//! Input files (`.inp`) of Abaqus and CalculiX: the mesh that they hold.
//!
//! Nodes, elements, sets and surfaces are read, from flat files or from parts with instances, which may be
//! translated and rotated, and from included files. The rest of a model (materials, loads, steps) is skipped
//! with a note.
//!
//! Element sets become labels by name: regions for volume cells, patches for surface cells. Sets
//! may overlap, labels may not. So for volume cells, and for surface cells, the first of the following kinds
//! of sets that covers all cells is taken, or else the one that covers most: sets with a section, sets of
//! `*ELSET`, sets of `*ELEMENT`, instances where there are several; sets of all cells come last. A set that
//! overlaps those before it, or that is not a label, becomes a cell array `elset:NAME` of 0 and 1; node sets
//! become point arrays `nset:NAME`. Surfaces on elements become patches: faces of volume cells that are not
//! cells yet are appended after the others. A surface that overlaps other patches becomes a cell array
//! `surface:NAME`. Of the sets that a preprocessor made for its own use (`INTERNAL`) only those with a
//! section count. With several instances, names are `INSTANCE.NAME`.
//!
//! The format has no numbers for labels: the names `REGION_3` and `PATCH_3` stand for the unnamed label 3;
//! other labels are numbered from 1.
//!
//! Nodes, elements and sets are written; patches that lie on volume cells are also written as surfaces, for
//! loads. Surface cells are written as shells (`S3` and so on): to keep only the solids, remove those blocks.
//!
//! Layout: Abaqus Keywords Guide (`*NODE`, `*ELEMENT`, `*ELSET`, `*SURFACE`, `*INSTANCE`), "Input syntax
//! rules", and the element library, whose numbering of nodes and faces the CalculiX manual repeats.

mod assemble;
mod kinds;
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

use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "Abaqus",
    extensions: &[".inp"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
