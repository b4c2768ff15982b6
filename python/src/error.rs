//! Errors of the library as Python exceptions, whose classes are those of `motet.errors`.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use motet::{Error, ErrorKind};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

static CLASSES: PyOnceLock<Vec<Py<PyType>>> = PyOnceLock::new();

/// The exception for an error, by its kind.
pub(crate) fn to_exception(error: Error) -> PyErr {
    Python::attach(|py| exception(py, &error).unwrap_or_else(|failed| failed))
}

/// An error of the input.
pub(crate) fn input(what: impl Into<String>) -> PyErr {
    to_exception(Error::input(what))
}

/// An error of the options.
pub(crate) fn options(what: impl Into<String>) -> PyErr {
    to_exception(Error::options(what))
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let place = match error.kind() {
        ErrorKind::Io | ErrorKind::Output => FILE,
        ErrorKind::Options => OPTIONS,
        _ => INPUT,
    };
    let file = error.file().map(std::path::Path::to_path_buf);
    let parts = (error.to_string(), error.what(), file, error.place(), error.remedy_text());
    Ok(PyErr::from_value(class(py, place)?.call1(parts)?))
}

const INPUT: usize = 0;
const FILE: usize = 1;
const OPTIONS: usize = 2;
const INTERNAL: usize = 3;

/// One of the classes of `motet.errors`.
fn class(py: Python<'_>, place: usize) -> PyResult<Bound<'_, PyType>> {
    let classes = CLASSES.get_or_try_init(py, || {
        let module = py.import("motet.errors")?;
        ["InputError", "FileError", "OptionsError", "InternalError"]
            .into_iter()
            .map(|name| Ok(module.getattr(name)?.cast_into::<PyType>()?.unbind()))
            .collect::<PyResult<Vec<_>>>()
    })?;
    Ok(classes[place].bind(py).clone())
}

/// Calls the library without holding Python's lock, so that other threads of Python continue.
///
/// # Errors
/// The exception for the error of the library; `InternalError` where it panics.
pub(crate) fn call<T: Send>(py: Python<'_>, call: impl FnOnce() -> motet::Result<T> + Send) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(call))) {
        Ok(outcome) => outcome.or_raise(),
        Err(panic) => Err(internal_error(&*panic)),
    }
}

/// A panic of the library as an exception.
pub(crate) fn internal_error(panic: &(dyn Any + Send)) -> PyErr {
    let what = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let what = what.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    Python::attach(|py| internal(py, &what).unwrap_or_else(|failed| failed))
}

fn internal(py: Python<'_>, what: &str) -> PyResult<PyErr> {
    let message = format!("internal error in motet: {what}");
    Ok(PyErr::from_value(class(py, INTERNAL)?.call1((message, what))?))
}

/// Lets `?` convert errors of the library.
pub(crate) trait OrRaise<T> {
    /// The value, or the exception for the error.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for motet::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(to_exception)
    }
}
