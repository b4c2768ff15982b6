//! Legacy VTK files (`.vtk`), as text or big-endian binary.
//!
//! Unstructured grids and polygonal data of file versions 2.0 to 5.1 are read, with cells in the layout
//! before 5.0 (`n id id ...`, cell after cell) and since (`OFFSETS`, `CONNECTIVITY`). An unstructured grid of
//! version 5.1 is written, or of 4.2 on request. Implemented here because `vtkio` 0.7.0-rc2 fails on
//! 5.1 files.
//!
//! | file | idea |
//! |---|---|
//! | `source` | words, lines and numbers of the file, with the place for messages |
//! | `arrays` | arrays of any type, their names and metadata |
//! | `read` | converts sections to a mesh |
//! | `write` | converts a mesh to sections |

mod arrays;
mod read;
mod source;
mod write;

use crate::io::format::{Format, Write};

/// Legacy VTK files.
pub(super) const VTK: Format = Format {
    name: "VTK legacy",
    extensions: &[".vtk"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
