//! Files, and what a mesh is.

use std::collections::BTreeMap;
use std::path::PathBuf;

use motet::geometry::quality::{dihedral, eas, edge_ratio, mean_ratio, volume};
use motet::io::{self, WriteOptions};
use motet::mesh::{CellKind, LabelNames, Labels, Summary};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::border::{Given, parts};
use crate::error::called;
use crate::report::report;
use crate::words::one_of;

/// A mesh from a file, and what was passed over.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: PathBuf) -> PyResult<(Bound<'_, PyDict>, Vec<String>)> {
    let (mesh, notes) = called(py, || io::read_noted(&path))?;
    Ok((parts(py, mesh)?, notes))
}

/// Writes a mesh; what the format cannot hold.
#[pyfunction]
pub(crate) fn write(py: Python<'_>, path: PathBuf, mesh: Given) -> PyResult<Vec<String>> {
    called(py, || io::write(&path, &mesh.0, &WriteOptions::default()))
}

/// The label of each cell as region and as patch, 0 for cells without one; `None` where the mesh has no such labels.
#[pyfunction]
pub(crate) fn labels(py: Python<'_>, mesh: Given) -> [Option<Bound<'_, PyArray1<i32>>>; 2] {
    let ids = |labels: Option<Labels>| labels.map(|labels| PyArray1::from_vec(py, labels.ids));
    [ids(mesh.0.regions()), ids(mesh.0.patches())]
}

/// Names of regions and patches as field data, from the name of a field to the label that is its value.
#[pyfunction]
pub(crate) fn name_fields(
    regions: BTreeMap<i32, String>,
    patches: BTreeMap<i32, String>,
) -> Vec<(String, i32)> {
    LabelNames { regions, patches }.to_entries().collect()
}

/// Names of regions and of patches by their labels, of those field data that hold one.
#[pyfunction]
pub(crate) fn names_of_fields(
    fields: Vec<(String, i64)>,
) -> (BTreeMap<i32, String>, BTreeMap<i32, String>, Vec<String>) {
    let mut names = LabelNames::default();
    let taken = fields.into_iter().filter(|(name, label)| names.take_entry(name, *label));
    let taken = taken.map(|(name, _)| name).collect();
    (names.regions, names.patches, taken)
}

/// The names of kinds of cells, and VTK's numbers of them.
#[pyfunction]
pub(crate) fn cell_kinds() -> BTreeMap<&'static str, u8> {
    CellKind::NAMED.iter().filter_map(|kind| Some((kind.name()?, kind.0))).collect()
}

/// Endings of files that can be read, and whether they can be written.
#[pyfunction]
pub(crate) fn formats() -> BTreeMap<String, bool> {
    let formats = io::formats().iter();
    formats.flat_map(|f| f.endings.iter().map(|ending| ((*ending).to_owned(), f.write.is_some()))).collect()
}

/// What a mesh is, how good, and what is wrong with it.
#[pyfunction]
pub(crate) fn summary(py: Python<'_>, mesh: Given) -> PyResult<Bound<'_, PyAny>> {
    let summary = called(py, || Ok(Summary::of(&mesh.0)))?;
    report(py, &summary)
}

/// A measure of each tet; NaN for other cells.
#[pyfunction]
pub(crate) fn quality<'py>(py: Python<'py>, mesh: Given, measure: &str) -> PyResult<Bound<'py, PyAny>> {
    type Measure = fn([[f64; 3]; 4]) -> f64;
    let known: [(&str, Measure); 6] = [
        ("eas", eas),
        ("mean_ratio", mean_ratio),
        ("min_dihedral_deg", |tet| dihedral::min(tet).to_degrees()),
        ("max_dihedral_deg", |tet| dihedral::max(tet).to_degrees()),
        ("edge_ratio", edge_ratio),
        ("volume", volume),
    ];
    let of = one_of("measure", measure, &known)?;
    let field = called(py, || Ok(mesh.0.tet_field(measure, of)))?;
    Ok(PyArray1::from_vec(py, field.values.to_f64().unwrap_or_default()).into_any())
}
