//! Closed surfaces filled with tets.

use std::collections::BTreeMap;

use motet::base::Point;
use motet::meshing::layers::{Layers, Stack};
use motet::meshing::{self, Dividing, Options, Seed, Sizes, Surfaces, fill, sizes_by};
use motet::preflight::{Repair, Repairs, Role};
use motet::{Mesh, remesh};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::convert::{MeshArg, parts};
use crate::error::{OrRaise, call};
use crate::report::{quality, report};
use crate::watch::watched;

/// The request of a call; on Python's side a class with these attributes.
#[derive(FromPyObject)]
pub(crate) struct Request {
    size: Option<f64>,
    surface: String,
    is_graded: bool,
    growth: Option<f64>,
    size_array: Option<String>,
    seeds: Vec<(Point, String)>,
    holes: Vec<Point>,
    min_eas: Option<f64>,
    /// Layers on all walls, and by patch: number, first thickness, growth.
    layers: Option<(u32, f64, f64)>,
    layers_on: BTreeMap<String, (u32, f64, f64)>,
    keep_prisms: bool,
    repair: bool,
    cut: bool,
    voids: bool,
    merge: f64,
    hole_edges: usize,
}

/// The report of a call.
#[derive(Serialize)]
struct MeshReport<'a> {
    #[serde(flatten)]
    report: &'a motet::meshing::Report,
    improved: Option<&'a remesh::Report>,
    layers: Option<&'a motet::meshing::layers::Report>,
    repaired: &'a [Repair],
}

/// Returns the mesh, the report, and why the requested result was not reached. `surfaces`: the mesh and name
/// of each, and whether it may end inside the others.
#[pyfunction]
pub(crate) fn mesh<'py>(
    py: Python<'py>,
    surfaces: Vec<(MeshArg, String, bool)>,
    request: Request,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyAny>, Option<String>)> {
    let role = |is_membrane| if is_membrane { Role::Membrane } else { Role::Boundary };
    let meshes: Vec<(&Mesh, Role, &str)> = surfaces
        .iter()
        .map(|(mesh, name, is_membrane)| (&mesh.0, role(*is_membrane), name.as_str()))
        .collect();
    let mut joined = Surfaces::new(&meshes).or_raise()?;
    let sizes = match &request.size_array {
        None => None,
        Some(name) => {
            let each: Vec<Vec<f64>> =
                meshes.iter().map(|(mesh, ..)| sizes_by(mesh, name).or_raise()).collect::<PyResult<_>>()?;
            Some(joined.sizes(&each))
        }
    };
    let (repaired, options, filled) = watched(py, threads, progress, |threads| {
        let (repaired, at_points) = match request.repairs() {
            Some(repairs) => {
                let repaired = joined.repair(&repairs, threads)?;
                let at_points = sizes.map(|sizes| repaired.at_points(&sizes));
                (repaired.done, at_points)
            }
            None => (Vec::new(), sizes),
        };
        let options = request.options(at_points, &joined)?;
        let filled = fill(&joined, &joined.preflight(threads), &options, threads)?;
        Ok((repaired, options, filled))
    })?;
    let (improved, layers) = (filled.improved.as_ref(), filled.layers.as_ref());
    let not_reached = filled.not_reached(&options);
    let reported = report(py, &MeshReport { report: &filled.report, improved, layers, repaired: &repaired })?;
    reported.set_item("quality", quality(py, &filled.mesh)?)?;
    Ok((parts(py, filled.mesh)?, reported, not_reached))
}

/// The caps of a surface, to be put on any frame of it.
#[pyclass(frozen, module = "motet._motet")]
pub(crate) struct Caps(meshing::Caps);

#[pymethods]
impl Caps {
    #[new]
    fn new(py: Python<'_>, surface: MeshArg) -> PyResult<Self> {
        call(py, || meshing::Caps::of(&surface.0)).map(Self)
    }

    /// Closes a frame of the surface.
    fn close<'py>(&self, py: Python<'py>, frame: MeshArg) -> PyResult<Bound<'py, PyDict>> {
        parts(py, call(py, || self.0.close(&frame.0))?)
    }
}

impl Request {
    fn options(&self, at_points: Option<Vec<f64>>, surfaces: &Surfaces) -> motet::Result<Options> {
        let sizes = Sizes::of(self.size, self.is_graded, self.growth, at_points);
        let seed = |(place, name): &(Point, String)| Seed { place: *place, name: name.clone() };
        Ok(Options {
            dividing: Dividing::of_name(&self.surface)?,
            seeds: self.seeds.iter().map(seed).collect(),
            holes: self.holes.clone(),
            voids: self.voids,
            layers: self.layers(surfaces)?,
            ..Options::with_sizes(sizes, self.min_eas)
        })
    }

    fn layers(&self, surfaces: &Surfaces) -> motet::Result<Option<Layers>> {
        if self.layers.is_none() && self.layers_on.is_empty() {
            return Ok(None);
        }
        let stack = |&(count, first, growth): &(u32, f64, f64)| {
            let stack = Stack { count, first, growth };
            stack.check().map(|()| stack)
        };
        let mut all = Layers { keep_prisms: self.keep_prisms, ..Layers::default() };
        all.everywhere = self.layers.as_ref().map(stack).transpose()?;
        for (patch, layers) in &self.layers_on {
            let id = surfaces.find_patch(patch)?;
            all.by_patch.insert(id, stack(layers)?);
        }
        Ok(Some(all))
    }

    fn repairs(&self) -> Option<Repairs> {
        let all = || Repairs::all(self.merge, self.hole_edges);
        let repairs = if self.repair { all() } else { Repairs::default() };
        (self.repair || self.cut).then_some(Repairs { cut: self.cut, keep_inward: self.voids, ..repairs })
    }
}
