//! MED (`.med`), the format of Salome and Code_Aster, in HDF5.
//!
//! Points, cells and the groups of both are read from the first mesh, and fields on all points or cells of it
//! at their last step. Groups become labels by name as the sets of Abaqus files do: regions for volume cells,
//! patches for surface cells; groups that overlap others become cell arrays `elset:NAME` of 0 and 1, groups
//! of nodes point arrays `nset:NAME`. A group that is a family of its own has the number of that; in a file
//! without groups the numbers of families are the labels. Cells come in the order of their numbers, where
//! these differ, otherwise kind by kind. Fields on parts of a mesh, on Gauss points and on the nodes of each
//! element are skipped with a note; structured meshes are refused.
//!
//! Points, cells, groups and arrays are written as version 3.0, which lacks wedges of 18 nodes: numbers of
//! double precision and whole numbers of 32 and 64 bits as they are, others in double precision.
//!
//! Layout: the documentation of MED file, "Format de fichier" and "Numérotation des éléments" (Salome), as
//! read and written by MED 3 and 4. Volume cells run the other way round than VTK's. meshio does not turn
//! them; its files tell that they are meshio's.
//!
//! | file | idea |
//! |---|---|
//! | `kinds` | types of cells, and the order of their nodes |
//! | `families` | families and their groups |
//! | `fields` | fields as arrays |
//! | `read` | reads points and cells |
//! | `write` | writes a mesh |

mod families;
mod fields;
mod kinds;
mod read;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "MED",
    extensions: &[".med"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};

/// The profile of fields on all points or cells of a type.
const WHOLE: &str = "MED_NO_PROFILE_INTERNAL";

/// Width of the name of a group.
const GROUP_NAME: usize = 80;
