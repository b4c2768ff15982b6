//! Errors of the library as exceptions of Python: the classes are those of `motet.errors`.

use motet::{Error, ErrorKind};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

static CLASSES: PyOnceLock<Vec<Py<PyType>>> = PyOnceLock::new();

/// An error as the exception that fits its kind.
pub(crate) fn raised(error: Error) -> PyErr {
    Python::attach(|py| exception(py, &error).unwrap_or_else(|failed| failed))
}

/// An error of the input.
pub(crate) fn input(what: impl Into<String>) -> PyErr {
    raised(Error::input(what))
}

/// An error of the options.
pub(crate) fn options(what: impl Into<String>) -> PyErr {
    raised(Error::options(what))
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let classes = CLASSES.get_or_try_init(py, || {
        let module = py.import("motet.errors")?;
        ["InputError", "FileError", "OptionsError"]
            .into_iter()
            .map(|name| Ok(module.getattr(name)?.cast_into::<PyType>()?.unbind()))
            .collect::<PyResult<Vec<_>>>()
    })?;
    let place = match error.kind() {
        ErrorKind::Io | ErrorKind::Output => 1,
        ErrorKind::Options => 2,
        _ => 0,
    };
    let file = error.file().map(std::path::Path::to_path_buf);
    let parts = (error.to_string(), error.what(), file, error.place(), error.remedy_text());
    Ok(PyErr::from_value(classes[place].bind(py).call1(parts)?))
}

/// `?` for results of the library.
pub(crate) trait OrRaise<T> {
    /// The value, or the exception that fits the error.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for motet::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(raised)
    }
}
