//! VTKHDF (`.vtkhdf`, `.hdf`): VTK's meshes in HDF5, a single mesh or several over time.
//!
//! The layout follows VTK's documentation, "VTKHDF File Format" (docs.vtk.org, versions 1.0 to 2.7):
//!
//! ```text
//! VTKHDF  Version, Type        UnstructuredGrid or PolyData
//!   NumberOfPoints, NumberOfCells, NumberOfConnectivityIds       of each part: an array each
//!   Points, Types, Offsets, Connectivity    part after part; ids and offsets start at 0 in each
//!   FaceConnectivity, FaceOffsets, PolyhedronToFaces, PolyhedronOffsets, their counts    of polyhedra
//!   Vertices, Lines, Polygons, Strips     in polygonal data: a group each, with the cells' arrays
//!   PointData, CellData, FieldData        an array each
//!   Steps  NSteps     for each step its time, its parts, and where in each array it begins
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `frame` | the parts of a mesh, and their first rows |
//! | `lists` | lists of ids, part by part |
//! | `read` | the mesh of a frame |
//! | `series` | steps as files of a series: `flow.vtkhdf#3` |
//! | `write` | writes a mesh |
//! | `steps` | writes meshes over time |

mod frame;
mod lists;
mod read;
mod series;
mod steps;
#[cfg(test)]
mod tests;
mod write;

use crate::io::format::{Format, Write};

pub(super) use series::{StepPath, is_transient, is_vtkhdf_name, read_step, times};
pub(super) use steps::Steps;

/// Unstructured grids and polygonal data in HDF5.
pub(super) const FORMAT: Format = Format {
    name: "VTKHDF",
    extensions: &[".vtkhdf", ".hdf"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};

/// The names of the groups of polygonal data, in the order of the sections.
const SECTIONS: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];
