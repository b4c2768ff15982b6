//! Reading and writing of files, and summaries of meshes.

use std::collections::BTreeMap;
use std::path::PathBuf;

use motet::base::{Names as _, Threads};
use motet::geometry::quality::Measure;
use motet::io::{self, WriteOptions};
use motet::mesh::{CellKind, LabelNames, Labels, Summary};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{MeshArg, parts};
use crate::error::call;
use crate::report::report;
use crate::words::{name_of, threads};

/// Reads a mesh from a file; also returns notes on what the reader skipped.
#[pyfunction]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    threads: usize,
) -> PyResult<(Bound<'_, PyDict>, Vec<String>)> {
    let threads = self::threads(threads)?;
    let (mesh, notes) = call(py, || io::read_on(&path, &threads))?;
    Ok((parts(py, mesh)?, notes))
}

/// Reads centre lines from a text of positions and one of segments.
#[pyfunction]
pub(crate) fn read_segments(
    py: Python<'_>,
    positions: PathBuf,
    segments: PathBuf,
) -> PyResult<Bound<'_, PyDict>> {
    parts(py, call(py, || io::read_segments(&positions, &segments))?)
}

/// Writes a mesh; returns what the format cannot hold.
#[pyfunction]
pub(crate) fn write(py: Python<'_>, path: PathBuf, mesh: MeshArg, threads: usize) -> PyResult<Vec<String>> {
    let threads = self::threads(threads)?;
    call(py, || io::write_on(&path, &mesh.0, &WriteOptions::default(), &threads))
}

/// The region label and the patch label of each cell, 0 for cells without one; `None` where the mesh has no
/// such labels.
#[pyfunction]
pub(crate) fn labels(py: Python<'_>, mesh: MeshArg) -> [Option<Bound<'_, PyArray1<i32>>>; 2] {
    let ids = |labels: Option<Labels>| labels.map(|labels| PyArray1::from_vec(py, labels.ids));
    [ids(mesh.0.regions()), ids(mesh.0.patches())]
}

/// The names of regions and patches as field data, each with its label as the value.
#[pyfunction]
pub(crate) fn name_fields(
    regions: BTreeMap<i32, String>,
    patches: BTreeMap<i32, String>,
) -> Vec<(String, i32)> {
    LabelNames { regions, patches }.to_entries().collect()
}

/// The names of regions and of patches by their labels, from the field data that contain one, and the names
/// of these fields.
#[pyfunction]
pub(crate) fn names_of_fields(
    fields: Vec<(String, i64)>,
) -> (BTreeMap<i32, String>, BTreeMap<i32, String>, Vec<String>) {
    let mut names = LabelNames::default();
    let taken = fields.into_iter().filter(|(name, label)| names.take_entry(name, *label));
    let taken = taken.map(|(name, _)| name).collect();
    (names.regions, names.patches, taken)
}

/// The names of cell kinds, with VTK's numbers.
#[pyfunction]
pub(crate) fn cell_kinds() -> BTreeMap<&'static str, u8> {
    CellKind::NAMED.iter().filter_map(|kind| Some((kind.name()?, kind.0))).collect()
}

/// File extensions that can be read, and whether they can be written.
#[pyfunction]
pub(crate) fn formats() -> BTreeMap<String, bool> {
    let formats = io::formats().iter();
    formats
        .flat_map(|f| f.extensions.iter().map(|extension| ((*extension).to_owned(), f.write.is_some())))
        .collect()
}

/// The content, quality and defects of a mesh.
#[pyfunction]
pub(crate) fn summary(py: Python<'_>, mesh: MeshArg) -> PyResult<Bound<'_, PyAny>> {
    let of = || Summary::with_measures(&mesh.0, Measure::ALL, &Threads::single());
    let (summary, measures) = call(py, || Ok(of()))?;
    let all = report(py, &summary)?;
    all.set_item("measures", report(py, &measures.into_iter().collect::<BTreeMap<_, _>>())?)?;
    Ok(all)
}

/// A quality measure of each tet; NaN for other cells.
#[pyfunction]
pub(crate) fn quality<'py>(py: Python<'py>, mesh: MeshArg, measure: &str) -> PyResult<Bound<'py, PyAny>> {
    let measure: Measure = name_of(measure)?;
    let field = call(py, || Ok(mesh.0.tet_field(measure.as_str(), |tet| measure.of_tet(tet))))?;
    Ok(PyArray1::from_vec(py, field.values.to_f64().unwrap_or_default()).into_any())
}
