//! Devices put into a mesh.

use std::collections::BTreeMap;

use motet::base::Threads;
use motet::implant::{Device, ImplantWords};
use motet::mesh::history::Changed;
use pyo3::prelude::*;

use crate::convert::{MeshArg, parts};
use crate::error::OrRaise;
use crate::history::{ChangedParts, History};
use crate::report::{quality, report};
use crate::watch::watched;
use crate::words::{name_of, rules};

/// Returns the new mesh, its history, the report, and why the requested result was not reached.
#[pyfunction]
#[pyo3(signature = (
    host, devices, *, inside, interface, tolerance, outside, stray, adapt, size, growth, carve, reach, min_eas, values, carry, threads, progress
))]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn implant<'py>(
    py: Python<'py>,
    host: MeshArg,
    devices: Vec<(MeshArg, String)>,
    inside: &str,
    interface: &str,
    tolerance: Option<f64>,
    outside: &str,
    stray: Option<f64>,
    adapt: &str,
    size: Option<f64>,
    growth: f64,
    carve: f64,
    reach: f64,
    min_eas: f64,
    values: BTreeMap<String, Vec<f64>>,
    carry: BTreeMap<String, String>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ChangedParts<'py>> {
    let words = ImplantWords {
        inside: name_of(inside)?,
        interface: name_of(interface)?,
        tolerance,
        outside: name_of(outside)?,
        stray,
        adapt: name_of(adapt)?,
        size,
        growth,
        carve,
        reach,
        min_eas,
        values,
    };
    let options = words.options().or_raise()?;
    let devices: Vec<Device> = devices.into_iter().map(|(mesh, name)| words.device(mesh.0, name)).collect();
    let rules = rules(&host.0, &carry)?;
    let put = |threads: &Threads| motet::implant::implant(&host.0, &devices, &options, &rules, threads);
    let made = watched(py, threads, progress, put)?;
    let Changed { mesh, history, report: reported, .. } = made;
    let not_reached = reported.not_reached();
    let reported = report(py, &reported)?;
    reported.set_item("quality", [quality(py, &host.0)?, quality(py, &mesh)?])?;
    Ok((parts(py, mesh)?, History(history), reported, not_reached))
}
