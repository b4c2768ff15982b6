//! Reports as dictionaries.

use motet::Mesh;
use motet::base::Threads;
use motet::mesh::Qualities;
use pyo3::prelude::*;
use serde::Serialize;

/// A report as dictionaries, lists and numbers.
pub(crate) fn report<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    Ok(pythonize::pythonize(py, value)?)
}

/// The quality of all tets of a mesh; `None` where it has none.
pub(crate) fn quality<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyAny>> {
    report(py, &Qualities::of_mesh(mesh, &Threads::single()))
}

/// A report with the key `not_reached`: why the requested result was not reached, `None` where it was.
pub(crate) fn with_not_reached<'py>(
    py: Python<'py>,
    value: &impl Serialize,
    not_reached: Option<String>,
) -> PyResult<Bound<'py, PyAny>> {
    let all = report(py, value)?;
    all.set_item("not_reached", not_reached)?;
    Ok(all)
}
