//! A mesh that follows its walls and stays good.

use std::collections::BTreeMap;
use std::path::PathBuf;

use motet::Mesh;
use motet::base::{Threads, Watch};
use motet::contact::GapWords;
use motet::motion::Motion;
use motet::moving::{self, Options, RepairWords, WatchWords};
use motet::refine::Wanted;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Vectors, rows, to_field, vectors};
use crate::convert::{MeshArg, parts};
use crate::error::{OrRaise, call};
use crate::history::History;
use crate::motion::extent;
use crate::refine::Criterion;
use crate::report::{report, with_not_reached};
use crate::watch::{run_watched, watched};
use crate::words::{name_of, one_of, rules, threads};

/// Options of a moving mesh; on Python's side a class with these attributes.
#[derive(FromPyObject)]
pub(crate) struct Request {
    method: String,
    bodies: Vec<String>,
    strain: Option<String>,
    within_walls: bool,
    smooth: usize,
    inside: Vec<String>,
    slide: Vec<String>,
    slide_tolerance: f64,
    rigid_layer: Option<f64>,
    rigid_layer_cells: Option<usize>,
    rigid_layer_at: Vec<String>,
    repair: bool,
    min_eas: f64,
    surface: String,
    distance: Option<f64>,
    hold_names: Vec<String>,
    margin: f64,
    floor: f64,
    improve_below: f64,
    returns: bool,
    valid_at_start: bool,
    contents: Vec<String>,
    carry: BTreeMap<String, String>,
    watch: Vec<String>,
    warn: Option<f64>,
    within: f64,
    horizon: Option<f64>,
    hold: Option<f64>,
    remembered: usize,
}

impl Request {
    fn options(&self, mesh: &Mesh) -> PyResult<Options> {
        let motion = Motion {
            method: name_of(&self.method)?,
            bodies: self.bodies.clone(),
            strain: self.strain.as_deref().map(name_of).transpose()?,
            smooth: self.smooth,
            rigid_layer: extent(self.rigid_layer, self.rigid_layer_cells),
            rigid_layer_at: self.rigid_layer_at.clone(),
            within_walls: self.within_walls,
            slide: self.slide.clone(),
            slide_tolerance: self.slide_tolerance,
            inside: self.inside.clone(),
            ..Motion::default()
        };
        let repair = RepairWords {
            off: !self.repair,
            min_eas: self.min_eas,
            surface: name_of(&self.surface)?,
            distance: self.distance,
            hold: self.hold_names.clone(),
            margin: self.margin,
            floor: self.floor,
            improve_below: self.improve_below,
            valid_at_start: self.valid_at_start,
        };
        let watch = WatchWords { patches: self.watch.clone(), horizon: self.horizon, hold: self.hold };
        let gaps = GapWords { warn: self.warn, within: Some(self.within), ..GapWords::default() };
        Ok(Options {
            motion,
            returns: self.returns,
            rules: rules(mesh, &self.carry)?,
            contents: self.contents.clone(),
            watch: watch.watching(&gaps, mesh).or_raise()?,
            remembered: self.remembered,
            ..repair.options(mesh).or_raise()?
        })
    }
}

/// A mesh that follows its walls and stays good.
#[pyclass(module = "motet._motet")]
pub(crate) struct MovingMesh {
    moving: moving::MovingMesh,
    threads: Threads,
}

impl MovingMesh {
    /// Makes a call of the handle that Ctrl-C can interrupt.
    fn watched<T: Send>(
        &mut self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        call: impl FnOnce(&mut moving::MovingMesh, &Threads) -> motet::Result<T> + Send,
    ) -> PyResult<T> {
        let watch = Watch::new();
        let threads = std::mem::take(&mut self.threads).watched(&watch);
        let moving = &mut self.moving;
        let (threads, outcome) = run_watched(py, &watch, threads, progress, |threads| call(moving, threads));
        self.threads = threads;
        outcome
    }
}

#[pymethods]
impl MovingMesh {
    #[new]
    fn new(
        py: Python<'_>,
        mesh: MeshArg,
        request: Request,
        threads: usize,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let options = request.options(&mesh.0)?;
        let new = |threads: &Threads| moving::MovingMesh::new(&mesh.0, options, threads);
        Ok(Self { moving: watched(py, threads, progress, new)?, threads: self::threads(threads)? })
    }

    /// Continues from what `save` wrote, with the same options.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, request: Request, threads: usize) -> PyResult<Self> {
        let mesh = call(py, || motet::io::read(&path))?;
        let options = request.options(&mesh)?;
        let load = |threads: &Threads| moving::MovingMesh::load(&path, options, threads);
        Ok(Self { moving: watched(py, threads, None, load)?, threads: self::threads(threads)? })
    }

    fn copy(&self, py: Python<'_>) -> PyResult<Self> {
        let threads = threads(self.threads.count())?;
        Ok(Self { moving: py.detach(|| self.moving.clone()), threads })
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        call(py, || self.moving.save(&path))
    }

    #[getter]
    fn driven_places<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(vectors(py, self.moving.driven_places().to_vec())?.into_any())
    }

    #[getter]
    fn time(&self) -> f64 {
        self.moving.time()
    }

    #[getter]
    fn step(&self) -> usize {
        self.moving.step()
    }

    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        parts(py, self.moving.mesh().clone())
    }

    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(vectors(py, self.moving.mesh().points.clone())?.into_any())
    }

    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(vectors(py, self.moving.velocity())?.into_any())
    }

    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(vectors(py, self.moving.displacement())?.into_any())
    }

    fn set_array(&mut self, name: String, array: &Bound<'_, PyAny>, on: &str) -> PyResult<()> {
        let field = to_field(name, array)?;
        match one_of("on", on, &[("points", true), ("cells", false)])? {
            true => self.moving.set_point_field(field),
            false => self.moving.set_cell_field(field),
        }
        .or_raise()
    }

    fn advance<'py>(
        &mut self,
        py: Python<'py>,
        time: f64,
        displacement: Vectors<'_>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let displacement = rows(&displacement, "displacement")?;
        let step =
            self.watched(py, progress, |moving, threads| moving.advance(time, displacement, threads))?;
        with_not_reached(py, &step, step.not_reached())
    }

    fn preview<'py>(&self, py: Python<'py>, displacement: Vectors<'_>) -> PyResult<Bound<'py, PyAny>> {
        let displacement = rows(&displacement, "displacement")?;
        let points = call(py, || self.moving.preview(displacement, &self.threads))?;
        Ok(vectors(py, points)?.into_any())
    }

    fn refine<'py>(
        &mut self,
        py: Python<'py>,
        criteria: Vec<Criterion>,
        generations: Option<u32>,
        coarsen: bool,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let criteria = criteria.into_iter().map(|criterion| criterion.0).collect();
        let wanted = Wanted { criteria, generations, coarsen, ..Wanted::default() };
        let changes = self.watched(py, None, |moving, threads| moving.refine(&wanted, threads))?;
        changes.iter().map(|change| report(py, change)).collect()
    }

    fn coarsen<'py>(&mut self, py: Python<'py>, smallest: f64) -> PyResult<Option<Bound<'py, PyAny>>> {
        let change = self.watched(py, None, |moving, threads| moving.coarsen(smallest, threads))?;
        change.map(|change| report(py, &change)).transpose()
    }

    fn repair<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let change = self.watched(py, None, |moving, threads| moving.repair(threads))?;
        change.map(|change| report(py, &change)).transpose()
    }

    fn remembers(&self, step: usize) -> bool {
        self.moving.remembers(step)
    }

    fn history_since(&self, py: Python<'_>, step: usize) -> PyResult<Option<History>> {
        Ok(call(py, || self.moving.history_since(step))?.map(History))
    }
}
