//! Repair of bad tets.

use std::collections::BTreeMap;

use motet::mesh::history::Changed;
use motet::remesh::{EdgeLengths, RemeshWords, remesh_mesh};
use pyo3::prelude::*;

use crate::convert::{MeshArg, parts};
use crate::error::OrRaise;
use crate::history::{ChangedParts, History};
use crate::report::{quality, report};
use crate::watch::watched;
use crate::words::{name_of, rules};

/// The requested edge lengths: everywhere, by a point array, or at each point.
#[derive(FromPyObject)]
pub(crate) enum SizesArg {
    Uniform(f64),
    Array(String),
    Points(Vec<f64>),
}

/// Returns the new mesh, its history, the report, and why the requested result was not reached.
#[pyfunction]
#[pyo3(signature = (mesh, *, min_eas, min_dihedral_deg, goal, surface, distance, keep_layers, hold, sizes, rounds, carry, threads, progress))]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn remesh<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    min_eas: f64,
    min_dihedral_deg: f64,
    goal: &str,
    surface: &str,
    distance: Option<f64>,
    keep_layers: bool,
    hold: Vec<String>,
    sizes: Option<SizesArg>,
    rounds: usize,
    carry: BTreeMap<String, String>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ChangedParts<'py>> {
    let words = RemeshWords {
        min_eas,
        min_dihedral_deg,
        goal: name_of(goal)?,
        surface: name_of(surface)?,
        distance,
        keep_layers,
        hold,
        sizes: sizes.map(|sizes| match sizes {
            SizesArg::Uniform(h) => EdgeLengths::Everywhere(h),
            SizesArg::Array(name) => EdgeLengths::Array(name),
            SizesArg::Points(all) => EdgeLengths::Points(all),
        }),
        rounds,
    };
    let options = words.options(&mesh.0).or_raise()?;
    let rules = rules(&mesh.0, &carry)?;
    let outcome = watched(py, threads, progress, |threads| remesh_mesh(&mesh.0, &options, &rules, threads))?;
    let Changed { mesh: new, history, report: reported, .. } = outcome;
    let not_reached = reported.not_reached();
    let reported = report(py, &reported)?;
    for (state, mesh) in [("before", &mesh.0), ("after", &new)] {
        reported.get_item(state)?.set_item("quality", quality(py, mesh)?)?;
    }
    Ok((parts(py, new)?, History(history), reported, not_reached))
}
