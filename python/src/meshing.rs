//! Closed surfaces filled with tets; surfaces that get even triangles.

use motet::base::{Names, Point};
use motet::mesh::history::Changed;
use motet::meshing::even::{SurfaceWords, even_surface};
use motet::meshing::layers::Stack;
use motet::meshing::{self, EdgeLength, MeshingWords, Seed, Surfaces, WallLayers, fill, sizes_by, tubes};
use motet::preflight::{Repair, Role};
use motet::{Mesh, remesh};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::convert::{MeshArg, parts};
use crate::error::{OrRaise, call};
use crate::history::History;
use crate::report::{quality, report};
use crate::watch::watched;

/// The request of a call; on Python's side a class with these attributes.
#[derive(FromPyObject)]
pub(crate) struct Request {
    size: Option<SizeArg>,
    surface: String,
    distance: Option<f64>,
    feature_angle: f64,
    growth: Option<f64>,
    size_array: Option<String>,
    seeds: Vec<(Point, String)>,
    holes: Vec<Point>,
    min_eas: Option<f64>,
    /// Each with its patch, if it has one: number, first thickness, growth.
    layers: Vec<(Option<String>, (u32, f64, f64))>,
    keep_prisms: bool,
    repair: bool,
    cut: bool,
    unite: bool,
    wrap: Option<f64>,
    voids: bool,
    merge: f64,
    hole_edges: usize,
}

/// The requested edge length, or `auto`.
#[derive(FromPyObject)]
pub(crate) enum SizeArg {
    Length(f64),
    Text(String),
}

impl SizeArg {
    fn length(self) -> motet::Result<EdgeLength> {
        match self {
            Self::Length(length) => Ok(EdgeLength::Length(length)),
            Self::Text(text) => EdgeLength::of_text(&text),
        }
    }
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
    let words = request.words().or_raise()?;
    let mut joined = Surfaces::new(&meshes).or_raise()?;
    let sizes = match &words.size_array {
        None => None,
        Some(name) => {
            let each: Vec<Vec<f64>> =
                meshes.iter().map(|(mesh, ..)| sizes_by(mesh, name).or_raise()).collect::<PyResult<_>>()?;
            Some(joined.sizes(&each))
        }
    };
    let (repaired, options, filled) = watched(py, threads, progress, |threads| {
        let (repaired, at_points) = match words.repairs() {
            Some(repairs) => {
                let repaired = joined.repair(&repairs, threads)?;
                let at_points = sizes.map(|sizes| repaired.at_points(&sizes));
                (repaired.done, at_points)
            }
            None => (Vec::new(), sizes),
        };
        let options = words.options(&joined, at_points)?;
        let filled = fill(&joined, &joined.preflight(threads), &options, threads)?;
        Ok((repaired, options, filled))
    })?;
    let (improved, layers) = (filled.improved.as_ref(), filled.layers.as_ref());
    let not_reached = filled.not_reached(&options);
    let reported = report(py, &MeshReport { report: &filled.report, improved, layers, repaired: &repaired })?;
    reported.set_item("quality", quality(py, &filled.mesh)?)?;
    Ok((parts(py, filled.mesh)?, reported, not_reached))
}

/// A radius, or the name of an array with radii.
#[derive(FromPyObject)]
pub(crate) enum RadiusArg {
    Length(f64),
    Array(String),
}

impl RadiusArg {
    fn radius(self) -> tubes::Radius {
        match self {
            Self::Length(radius) => tubes::Radius::Same(radius),
            Self::Array(name) => tubes::Radius::Array(name),
        }
    }
}

/// The parts of a surface made even; without a history if it was made of wires.
type SurfaceParts<'py> = (Bound<'py, PyDict>, Option<History>, Bound<'py, PyAny>, Option<String>);

/// Returns the new surface, its history, the report, and why the requested result was not reached.
#[pyfunction]
#[pyo3(signature = (surface, *, size, distance, feature_angle, growth, size_array, clip, repair, unite, wrap, merge, hole_edges, smooth, tubes, sides, join, threads, progress))]
#[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
pub(crate) fn surface<'py>(
    py: Python<'py>,
    surface: MeshArg,
    size: Option<SizeArg>,
    distance: Option<f64>,
    feature_angle: f64,
    growth: Option<f64>,
    size_array: Option<String>,
    clip: Vec<Vec<f64>>,
    repair: bool,
    unite: bool,
    wrap: Option<f64>,
    merge: f64,
    hole_edges: usize,
    smooth: usize,
    tubes: Option<RadiusArg>,
    sides: Option<usize>,
    join: Option<f64>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<SurfaceParts<'py>> {
    let size = size.map(SizeArg::length).transpose().or_raise()?;
    let words = SurfaceWords {
        size,
        distance,
        feature_angle,
        growth,
        size_array,
        clip,
        repair,
        unite,
        wrap,
        hole_edges,
        merge,
        smooth,
    };
    if let Some(radius) = tubes {
        let options = tubes::Options { sides, join, repair, ..tubes::Options::of(radius.radius()) };
        let made = watched(py, threads, progress, |threads| {
            tubes::even_tubes(&surface.0, &options, &words, threads)
        })?;
        let not_reached = made.report.surface.not_reached();
        return Ok((parts(py, made.mesh)?, None, report(py, &made.report)?, not_reached));
    }
    let options = words.options(&surface.0).or_raise()?;
    let made = watched(py, threads, progress, |threads| even_surface(&surface.0, &options, threads))?;
    let Changed { mesh, history, report: reported, .. } = made;
    let not_reached = reported.not_reached();
    Ok((parts(py, mesh)?, Some(History(history)), report(py, &reported)?, not_reached))
}

/// The caps of a surface, to be put on any frame of it.
#[pyclass(frozen, module = "motet._motet")]
pub(crate) struct Caps(meshing::Caps);

#[pymethods]
impl Caps {
    /// `inlet`: whether ends are named by size, and the place of the inlet, if given; `extend`: lengths of
    /// extensions, each with its end, or for all without one of their own.
    #[new]
    fn new(
        py: Python<'_>,
        surface: MeshArg,
        inlet: Option<(Option<Point>,)>,
        extend: Vec<(Option<String>, f64)>,
    ) -> PyResult<Self> {
        let made = call(py, || {
            let mut caps = meshing::Caps::of(&surface.0)?;
            if let Some((place,)) = inlet {
                caps.name_ends(&surface.0, place)?;
            }
            for (end, length) in extend {
                caps.extend(&surface.0, end.as_deref(), length)?;
            }
            Ok(caps)
        });
        made.map(Self)
    }

    /// Closes a frame of the surface.
    fn close<'py>(&self, py: Python<'py>, frame: MeshArg) -> PyResult<Bound<'py, PyDict>> {
        parts(py, call(py, || self.0.close(&frame.0))?)
    }
}

impl Request {
    fn words(self) -> motet::Result<MeshingWords> {
        let layers = |(patch, (count, first, growth))| {
            let stack = Stack { count, first, growth };
            WallLayers { patch, stack }
        };
        Ok(MeshingWords {
            size: self.size.map(SizeArg::length).transpose()?,
            surface: Names::of(&self.surface)?,
            distance: self.distance,
            feature_angle: self.feature_angle,
            growth: self.growth,
            size_array: self.size_array,
            seeds: self.seeds.into_iter().map(|(place, name)| Seed { place, name }).collect(),
            holes: self.holes,
            voids: self.voids,
            min_eas: self.min_eas,
            layers: self.layers.into_iter().map(layers).collect(),
            keep_prisms: self.keep_prisms,
            repair: self.repair,
            cut: self.cut,
            unite: self.unite,
            wrap: self.wrap,
            hole_edges: self.hole_edges,
            merge: self.merge,
            ..MeshingWords::default()
        })
    }
}
