//! CGNS (`.cgns`): meshes and solutions of computational fluid dynamics, in HDF5.
//!
//! The layout follows the CGNS documentation: "Standard Interface Data Structures" (SIDS) defines the nodes,
//! "SIDS-to-HDF5 File Mapping" their storage. Of unstructured meshes these nodes are supported:
//!
//! ```text
//! CGNSBase_t            dimensions of cells and of space
//!   Family_t            a name that sections and boundary conditions share; Ordinal: its number
//!   Zone_t              numbers of points and cells; several zones are joined
//!     GridCoordinates_t     CoordinateX, CoordinateY, CoordinateZ
//!     Elements_t            cells of one kind or several, of any dimension; numbered consecutively from 1
//!     ZoneGridConnectivity_t    points that are those of another zone
//!     ZoneBC_t  BC_t        a name for elements, or for everything on some points
//!     FlowSolution_t        arrays: a value for each point or each cell
//!     UserDefinedData_t     arrays on some elements, such as surface cells
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `node` | the tree of nodes |
//! | `kinds` | types of elements, and the order of their nodes |
//! | `elements` | the lists of a section |
//! | `zone` | points, elements, conditions of a zone |
//! | `conditions` | the elements or points of a boundary condition |
//! | `families` | names and numbers of families |
//! | `cells` | the elements of a zone as cells |
//! | `labels` | regions and patches from conditions, families, sections and zones |
//! | `arrays` | solutions as arrays |
//! | `seams` | points where zones meet |
//! | `meshio` | files written by meshio |
//! | `read` | reads a mesh |
//! | `tree` | nodes for writing, and the width of their integers |
//! | `parts` | the cells of a mesh, label by label |
//! | `faces` | a mesh with polyhedra as faces and cells of faces |
//! | `names` | names that CGNS can hold |
//! | `solutions` | arrays as solutions |
//! | `write` | writes a mesh |

mod arrays;
mod cells;
mod conditions;
mod elements;
mod faces;
mod families;
mod kinds;
mod labels;
mod meshio;
mod names;
mod node;
mod parts;
mod read;
mod seams;
mod solutions;
#[cfg(test)]
mod tests;
mod tree;
mod write;
mod zone;

use crate::io::format::{Format, Write};

/// Unstructured meshes with boundary conditions and solutions.
pub(super) const FORMAT: Format = Format {
    name: "CGNS",
    extensions: &[".cgns"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
