//! Reports as dictionaries.

use pyo3::prelude::*;
use serde::Serialize;

/// Anything that a report is made of, as dictionaries, lists and numbers.
pub(crate) fn report<'py>(py: Python<'py>, told: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    Ok(pythonize::pythonize(py, told)?)
}
