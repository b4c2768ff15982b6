//! Data over time: series of meshes, and values of nodes.

use std::path::PathBuf;

use motet::io::{self, NodalSeries, WriteOptions};
use numpy::ndarray::Ix3;
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::Read;
use crate::convert::MeshArg;
use crate::error::{OrRaise, call, input};
use crate::words::threads;

/// The times and files of a series.
#[pyfunction]
pub(crate) fn read_series(path: PathBuf) -> PyResult<Vec<(f64, PathBuf)>> {
    io::read_series(path).or_raise()
}

/// Whether a path names a series, by its extension.
#[pyfunction]
pub(crate) fn is_series(path: PathBuf) -> bool {
    io::is_series(path)
}

/// A series that is being written.
#[pyclass(module = "motet._motet")]
pub(crate) struct SeriesWriter(io::SeriesWriter);

#[pymethods]
impl SeriesWriter {
    #[new]
    fn new(path: PathBuf) -> Self {
        Self(io::SeriesWriter::new(path, WriteOptions::default()))
    }

    /// Adds a mesh; returns its file, and what the format cannot hold.
    fn add(
        &mut self,
        py: Python<'_>,
        time: f64,
        mesh: MeshArg,
        threads: usize,
    ) -> PyResult<(PathBuf, Vec<String>)> {
        let threads = self::threads(threads)?;
        call(py, || self.0.add_on(time, &mesh.0, &threads))
    }
}

/// Times, ids, and values by node and time.
type Nodal<'py> = (Vec<f64>, Vec<i64>, Bound<'py, PyAny>);

/// Reads values of nodes over time.
#[pyfunction]
pub(crate) fn read_nodal(py: Python<'_>, path: PathBuf) -> PyResult<Nodal<'_>> {
    let series = call(py, || NodalSeries::read(path))?;
    let shape = [series.ids.len(), series.times.len(), series.components];
    let values = numpy::PyArray1::from_vec(py, series.values).reshape(shape)?;
    Ok((series.times, series.ids, values.into_any()))
}

/// Writes values of nodes over time.
#[pyfunction]
pub(crate) fn write_nodal(
    py: Python<'_>,
    path: PathBuf,
    times: Vec<f64>,
    ids: Vec<i64>,
    values: Read<'_, f64, Ix3>,
) -> PyResult<()> {
    let &[n_nodes, n_times, components] = values.shape() else { unreachable!("three axes by its type") };
    if (n_nodes, n_times) != (ids.len(), times.len()) {
        return Err(input(format!(
            "values of {n_nodes} nodes at {n_times} times, but {} ids and {} times",
            ids.len(),
            times.len()
        )));
    }
    let series = NodalSeries { times, ids, components, values: values.as_array().iter().copied().collect() };
    call(py, || series.write(path))
}
