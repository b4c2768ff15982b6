//! A mesh in a window of the browser.

use std::sync::Arc;
use std::thread;

use motet_view::{Scene, Server};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{MeshArg, parts};
use crate::error::OrRaise;
use crate::words::threads;

/// A page that a thread serves until it is closed.
#[pyclass(frozen)]
pub(crate) struct View(Arc<Server>);

#[pymethods]
impl View {
    #[new]
    #[pyo3(signature = (mesh, *, name, port, threads))]
    fn new(py: Python<'_>, mesh: MeshArg, name: &str, port: u16, threads: usize) -> PyResult<Self> {
        let threads = self::threads(threads)?;
        let server = py.detach(|| Server::new(Scene::new(mesh.0, name, threads)?, port)).or_raise()?;
        let server = Arc::new(server);
        let served = Arc::clone(&server);
        thread::spawn(move || served.serve());
        Ok(Self(server))
    }

    #[getter]
    fn address(&self) -> String {
        self.0.address()
    }

    /// The mesh as it is.
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mesh = py.detach(|| self.0.scene().mesh().clone());
        parts(py, mesh)
    }

    fn close(&self) {
        self.0.close();
    }
}

impl Drop for View {
    fn drop(&mut self) {
        self.0.close();
    }
}
