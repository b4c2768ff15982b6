//! Devices put into a mesh.

use std::collections::BTreeMap;

use motet::base::{Choice, Threads};
use motet::implant::{Adapt, Device, ImplantWords, Implanted, Inside, InterfaceName, Outside};
use pyo3::prelude::*;

use crate::convert::{MeshArg, parts};
use crate::error::OrRaise;
use crate::history::{Changed, History};
use crate::report::{quality, report};
use crate::watch::watched;
use crate::words::rules;

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
) -> PyResult<Changed<'py>> {
    let words = ImplantWords {
        inside: Inside::of_name(inside).or_raise()?,
        interface: InterfaceName::of_name(interface).or_raise()?,
        tolerance,
        outside: Outside::of_name(outside).or_raise()?,
        stray,
        adapt: Adapt::of_name(adapt).or_raise()?,
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
    let Implanted { mesh, history, report: reported } = made;
    let not_reached = reported.not_reached();
    let reported = report(py, &reported)?;
    reported.set_item("quality", [quality(py, &host.0)?, quality(py, &mesh)?])?;
    Ok((parts(py, mesh)?, History(history), reported, not_reached))
}
