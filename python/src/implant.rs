//! Devices put into a mesh.

use std::collections::BTreeMap;

use motet::base::Threads;
use motet::implant::{Adapt, Device, Inside, Interface, Options, Outside};
use motet::mesh::history::Changed;
use motet::remesh;
use pyo3::prelude::*;

use crate::convert::{MeshArg, parts};
use crate::history::{ChangedParts, History};
use crate::report::{quality, report};
use crate::watch::watched;
use crate::words::{one_of, rules};

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
    let insides = [("own", None), ("fill", Some(Inside::Filled)), ("hollow", Some(Inside::Hollow))];
    let inside = one_of("inside", inside, &insides)?;
    let device = |(mesh, name): (MeshArg, String)| {
        let device = Device::new(mesh.0, name);
        Device { inside: inside.unwrap_or(device.inside), ..device }
    };
    let devices: Vec<Device> = devices.into_iter().map(device).collect();
    let interfaces = [("match", Interface::Match), ("conform", Interface::Conform { tolerance })];
    let options = Options {
        interface: one_of("interface", interface, &interfaces)?,
        outside: one_of("outside", outside, &[("cut", Outside::Cut), ("keep", Outside::Keep)])?,
        stray,
        size,
        growth,
        adapt: one_of("adapt", adapt, &[("none", Adapt::No), ("walls", Adapt::Walls), ("all", Adapt::All)])?,
        carve,
        reach,
        starts: values,
        improve: remesh::Options { min_eas, ..remesh::Options::default() },
    };
    let rules = rules(&host.0, &carry)?;
    let put = |threads: &Threads| motet::implant::implant(&host.0, &devices, &options, &rules, threads);
    let made = watched(py, threads, progress, put)?;
    let Changed { mesh, history, report: reported, .. } = made;
    let not_reached = reported.not_reached();
    let reported = report(py, &reported)?;
    reported.set_item("quality", [quality(py, &host.0)?, quality(py, &mesh)?])?;
    Ok((parts(py, mesh)?, History(history), reported, not_reached))
}
