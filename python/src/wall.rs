//! Solid walls around vessels.

use motet::mesh::history::Changed;
use motet::meshing::wall::{Thickness, ThicknessWord, WallWords};
use pyo3::prelude::*;

use crate::convert::{MeshArg, parts};
use crate::error::OrRaise;
use crate::history::{ChangedParts, History};
use crate::report::report;
use crate::watch::watched;

/// How thick a wall is: a length, the name of an array, or one value for each point.
#[derive(FromPyObject)]
pub(crate) enum ThicknessArg {
    Length(f64),
    Array(String),
    AtPoints(Vec<f64>),
}

/// Returns the mesh with its wall, its history, the report, and why the requested result was not reached.
#[pyfunction]
#[pyo3(signature = (mesh, *, thickness, of_radius, layers, growth, on, keep_prisms, name, threads, progress))]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn wall<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    thickness: Option<ThicknessArg>,
    of_radius: Option<f64>,
    layers: u32,
    growth: f64,
    on: Vec<String>,
    keep_prisms: bool,
    name: String,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ChangedParts<'py>> {
    let (word, at_points) = match thickness {
        None => (None, None),
        Some(ThicknessArg::Length(length)) => (Some(ThicknessWord::Length(length)), None),
        Some(ThicknessArg::Array(name)) => (Some(ThicknessWord::Array(name)), None),
        Some(ThicknessArg::AtPoints(values)) => (Some(ThicknessWord::Length(1.0)), Some(values)),
    };
    let words = WallWords { thickness: word, of_radius, layers, growth, on, keep_prisms, name };
    let mut options = words.options(&mesh.0).or_raise()?;
    if let Some(values) = at_points {
        options.thickness = Thickness::AtPoints(values);
    }
    let made =
        watched(py, threads, progress, |threads| motet::meshing::wall::wall(&mesh.0, &options, threads))?;
    let Changed { mesh, history, report: reported, .. } = made;
    let not_reached = reported.not_reached();
    Ok((parts(py, mesh)?, History(history), report(py, &reported)?, not_reached))
}
