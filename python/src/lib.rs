//! The extension module that Python calls: arrays in, arrays out. The package `motet` beside this crate adds
//! names, keywords and documentation.
//!
//! | file | contents |
//! |---|---|
//! | `arrays` | conversion between numpy arrays and lists of the library |
//! | `convert` | conversion of whole meshes |
//! | `command` | the command line |
//! | `error` | errors as Python exceptions |
//! | `watch` | long calls: Ctrl-C and progress |
//! | `words` | common arguments: patches, rules of arrays, threads; defaults of the library |
//! | `shapes` | built-in meshes |
//! | `view` | the window in the browser |
//! | `files`, `meshing`, `motion`, `remesh`, `implant`, `refine`, `contact`, `moving` | one verb or handle each |

mod arrays;
mod command;
mod contact;
mod convert;
mod error;
mod files;
mod history;
mod implant;
mod meshing;
mod motion;
mod moving;
mod refine;
mod remesh;
mod report;
mod series;
mod shapes;
mod view;
mod wall;
mod watch;
mod words;

use pyo3::prelude::*;

#[pymodule]
mod _motet {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::contact::{Contact, bodies};
    #[pymodule_export]
    use crate::files::{
        cell_kinds, formats, labels, name_fields, names_of_fields, quality, read, read_segments, summary,
        write,
    };
    #[pymodule_export]
    use crate::history::History;
    #[pymodule_export]
    use crate::implant::implant;
    #[pymodule_export]
    use crate::meshing::{Caps, mesh, surface};
    #[pymodule_export]
    use crate::motion::{
        Mover, PointMover, choose, interface_vertices, mesh_velocity, patch_vertices, prescribed,
    };
    #[pymodule_export]
    use crate::moving::MovingMesh;
    #[pymodule_export]
    use crate::refine::{Criterion, Refinement, refined};
    #[pymodule_export]
    use crate::remesh::remesh;
    #[pymodule_export]
    use crate::series::{SeriesWriter, is_series, read_nodal, read_series, write_nodal};

    #[pymodule_export]
    use crate::shapes::{aneurysm, ball, box_grid, braid, coil, mixed, sphere_in_box, stent, tube};
    #[pymodule_export]
    use crate::view::View;
    #[pymodule_export]
    use crate::wall::wall;
    #[pymodule_export]
    use crate::words::defaults;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
