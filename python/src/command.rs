//! The command line, for the `motet` installed with the package.

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::error::call;

/// Runs the command line with these arguments, the name of the program first, and returns the exit status.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    call(py, || Ok(motet_cli::run(arguments)))
}
