//! Built-in meshes: for tests, documentation and first experiments.

use motet::base::Point;
use motet::geometry::vector::in_range;
use motet::mesh::shapes::{self, Aneurysm, Braid, Coil, Stent, TubeOptions, WallCells};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::parts;
use crate::error::{OrRaise, options};

#[pyfunction]
pub(crate) fn sphere_in_box(py: Python<'_>, n: usize, layers: usize) -> PyResult<Bound<'_, PyDict>> {
    at_least(n.min(layers), 1)?;
    room([n as f64, n as f64, n as f64 + 6.0 * layers as f64])?;
    parts(py, shapes::sphere_in_box(n, layers))
}

#[pyfunction]
pub(crate) fn box_grid(
    py: Python<'_>,
    n: [usize; 3],
    low: Point,
    high: Point,
) -> PyResult<Bound<'_, PyDict>> {
    at_least(n[0].min(n[1]).min(n[2]), 1)?;
    room(n.map(|n| n as f64))?;
    if !(0..3).all(|k| low[k] < high[k]) || !in_range(low) || !in_range(high) {
        return Err(options(format!(
            "a box from {low:?} to {high:?}, expected finite corners, the second above the first"
        )));
    }
    parts(py, shapes::box_grid(n, [low, high]))
}

#[pyfunction]
pub(crate) fn ball(py: Python<'_>, n: usize, layers: usize) -> PyResult<Bound<'_, PyDict>> {
    at_least(n.min(layers), 1)?;
    room([n as f64, n as f64, n as f64 + 6.0 * layers as f64])?;
    parts(py, shapes::ball(n, layers))
}

#[pyfunction]
pub(crate) fn mixed(py: Python<'_>, n: usize) -> PyResult<Bound<'_, PyDict>> {
    at_least(n, 1)?;
    room([n as f64; 3])?;
    parts(py, shapes::mixed(n))
}

#[pyfunction]
pub(crate) fn tube(
    py: Python<'_>,
    radius: f64,
    length: f64,
    n: usize,
    slices: usize,
    wall_layers: usize,
    wedges: bool,
) -> PyResult<Bound<'_, PyDict>> {
    at_least(n.min(slices), 1)?;
    let wall_cells = if wedges { WallCells::Wedges } else { WallCells::Tets };
    let options =
        TubeOptions { radius, length, n, slices, wall_layers, wall_cells, ..TubeOptions::default() };
    options.check().or_raise()?;
    parts(py, shapes::tube(&options))
}

#[pyfunction]
pub(crate) fn aneurysm(py: Python<'_>, around: usize, bend_deg: f64) -> PyResult<Bound<'_, PyDict>> {
    let mesh = Aneurysm { around, bend_deg, ..Aneurysm::default() }.mesh().or_raise()?;
    parts(py, mesh)
}

#[pyfunction]
pub(crate) fn stent(
    py: Python<'_>,
    radius: f64,
    length: f64,
    rings: usize,
    crowns: usize,
    strut_width: f64,
    thickness: f64,
) -> PyResult<Bound<'_, PyDict>> {
    let stent = Stent { length, rings, crowns, strut_width, thickness, ..Stent::default() };
    parts(py, stent.mesh(radius).or_raise()?)
}

#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn braid(
    py: Python<'_>,
    radius: f64,
    length: f64,
    wires: usize,
    pitch: f64,
    wire_radius: f64,
    gap: f64,
    over: usize,
    steps: usize,
) -> PyResult<Bound<'_, PyDict>> {
    let braid = Braid { radius, length, wires, pitch, wire_radius, gap, over };
    parts(py, braid.lines(steps).or_raise()?)
}

#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn coil(
    py: Python<'_>,
    centre: Point,
    radius: f64,
    pitch: f64,
    turns: f64,
    wire_radius: f64,
    steps: usize,
    around: usize,
) -> PyResult<Bound<'_, PyDict>> {
    let coil = Coil { centre, radius, pitch, turns, wire_radius };
    parts(py, coil.mesh(steps, around).or_raise()?)
}

/// Checks that this many points along three directions fit into memory.
fn room(n: [f64; 3]) -> PyResult<()> {
    shapes::check_count(n.iter().map(|n| n + 1.0).product()).or_raise()
}

/// The largest count along one direction, beyond which ids would not suffice.
const MOST: usize = 1000;

fn at_least(n: usize, least: usize) -> PyResult<()> {
    if (least..=MOST).contains(&n) {
        Ok(())
    } else {
        Err(options(format!("a count of {n}, expected {least} to {MOST}")))
    }
}
