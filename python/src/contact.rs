//! Contact: distances between surfaces, and when they will touch.

use motet::base::{BodyId, Id, MaybeId, Point, Threads, VertexId};
use motet::contact::{self, Body, GapWords, Gaps, Room, set_rooms};
use numpy::PyArray1;
use numpy::ndarray::Ix2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::arrays::{Read, Vectors, ids, rows, table, vectors};
use crate::convert::MeshArg;
use crate::error::{OrRaise, call, input};
use crate::report::report;
use crate::words::threads;

/// Two or more surfaces over one list of points.
#[pyclass(module = "motet._motet")]
pub(crate) struct Contact {
    contact: contact::Contact,
    names: Vec<String>,
    threads: Threads,
}

/// A pair of bodies, as in reports.
#[derive(Serialize)]
struct Pair<'a> {
    bodies: [&'a str; 2],
    /// `None` where nothing is within reach.
    distance: Option<f64>,
    points: Option<[Point; 2]>,
    triangles: Option<[u32; 2]>,
    crossings: usize,
    vertices_beyond: [usize; 2],
    depth: f64,
    warned: [usize; 2],
}

/// A surface in a room, as in reports.
#[derive(Serialize)]
struct Within<'a> {
    room: &'a str,
    surface: &'a str,
    share: Option<f64>,
}

#[pymethods]
impl Contact {
    /// `bodies`: the name and the triangles of each. `room`: the names of those that are the wall of a room;
    /// `None` lets the library decide.
    #[new]
    #[pyo3(signature = (points, bodies, *, room, warn, own, within, facing, fold, threads))]
    #[allow(clippy::too_many_arguments, reason = "Python passes keyword arguments one by one")]
    fn new(
        py: Python<'_>,
        points: Vectors<'_>,
        bodies: Vec<(String, Read<'_, u32, Ix2>)>,
        room: Option<Vec<String>>,
        warn: Option<f64>,
        own: bool,
        within: f64,
        facing: bool,
        fold: f64,
        threads: usize,
    ) -> PyResult<Self> {
        let points = rows(&points, "points")?.to_vec();
        let threads = self::threads(threads)?;
        let body = |(name, triangles): (String, Read<'_, u32, Ix2>)| {
            let triangles = triangles.as_array();
            if triangles.ncols() != 3 {
                return Err(input(format!("{name}: triangles of {} columns, expected 3", triangles.ncols())));
            }
            let n = points.len() as u32;
            if let Some(v) = triangles.iter().find(|&&v| v >= n) {
                return Err(input(format!("{name}: vertex {v} is out of range: there are {n} points")));
            }
            let triangles = triangles.rows().into_iter().map(|t| [t[0], t[1], t[2]].map(VertexId)).collect();
            Ok(Body { name, triangles, room: Room::Found })
        };
        let mut bodies: Vec<Body> = bodies.into_iter().map(body).collect::<PyResult<_>>()?;
        if let Some(names) = room {
            set_rooms(&mut bodies, &names).or_raise()?;
        }
        let names = bodies.iter().map(|body| body.name.clone()).collect();
        let words = GapWords { warn, within: Some(within), own, facing, fold };
        let contact = call(py, || contact::Contact::new(points, bodies, words.options(), &threads))?;
        Ok(Self { contact, names, threads })
    }

    /// Which surfaces lie in which rooms, with the part of their area inside where the room was detected.
    fn rooms(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let name = |body: BodyId| self.names[body.index()].as_str();
        let within =
            |w: &contact::Within| Within { room: name(w.room), surface: name(w.body), share: w.share };
        Ok(report(py, &self.contact.rooms().iter().map(within).collect::<Vec<_>>())?.into())
    }

    fn refit(&mut self, py: Python<'_>, points: Vectors<'_>) -> PyResult<()> {
        let points = rows(&points, "points")?;
        call(py, || self.contact.refit(points, &self.threads))
    }

    fn measure<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let gaps = call(py, || Ok(self.contact.measure(&self.threads)))?;
        let all = PyDict::new(py);
        all.set_item("least", gaps.least())?;
        all.set_item("pairs", report(py, &self.pairs(&gaps))?)?;
        all.set_item("warnings", report(py, &self.contact.warned(&gaps))?)?;
        let bodies = PyDict::new(py);
        for (name, of) in self.names.iter().zip(gaps.bodies) {
            let body = PyDict::new(py);
            body.set_item("vertices", ids(py, of.vertices))?;
            body.set_item("gap", PyArray1::from_vec(py, of.gap))?;
            body.set_item("normal", vectors(py, of.normal)?)?;
            body.set_item("closest_body", signed(py, &of.closest_body))?;
            body.set_item("closest_triangle", signed(py, &of.closest_triangle))?;
            body.set_item("closest_point", vectors(py, of.closest_point)?)?;
            body.set_item("warning", PyArray1::from_vec(py, of.warning))?;
            bodies.set_item(name, body)?;
        }
        all.set_item("bodies", bodies)?;
        Ok(all)
    }

    /// When surfaces will touch, by a velocity for each point, up to the horizon.
    fn look_ahead<'py>(
        &self,
        py: Python<'py>,
        velocity: Vectors<'_>,
        horizon: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let velocity = rows(&velocity, "velocity")?;
        let ahead = call(py, || self.contact.look_ahead(velocity, horizon, &self.threads))?;
        self.ahead(py, ahead)
    }

    /// When surfaces will touch, with points that reach the given positions after a time.
    fn look_ahead_to<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'_>,
        dt: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let points = rows(&points, "points")?;
        let ahead = call(py, || self.contact.look_ahead_to(points, dt, &self.threads))?;
        self.ahead(py, ahead)
    }
}

impl Contact {
    fn ahead<'py>(&self, py: Python<'py>, ahead: contact::Ahead) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        all.set_item("first", report(py, &ahead.first)?)?;
        let times = PyDict::new(py);
        for (name, of) in self.names.iter().zip(ahead.times) {
            times.set_item(name, PyArray1::from_vec(py, of))?;
        }
        all.set_item("times", times)?;
        Ok(all)
    }

    fn pairs<'a>(&'a self, gaps: &Gaps) -> Vec<Pair<'a>> {
        let pair = |pair: &contact::PairGap| Pair {
            bodies: pair.bodies.map(|body| self.names[body.index()].as_str()),
            distance: pair.nearest.map(|nearest| nearest.distance),
            points: pair.nearest.map(|nearest| nearest.points),
            triangles: pair.nearest.map(|nearest| nearest.triangles),
            crossings: pair.crossings.len(),
            vertices_beyond: pair.n_wrong,
            depth: pair.depth,
            warned: pair.n_warned,
        };
        gaps.pairs.iter().map(pair).collect()
    }
}

/// Ids as signed integers, with -1 for none.
fn signed<'py, I: Id>(py: Python<'py>, ids: &[MaybeId<I>]) -> Bound<'py, PyArray1<i64>> {
    PyArray1::from_vec(py, ids.iter().map(|id| id.get().map_or(-1, |id| id.place() as i64)).collect())
}

/// The surfaces of a mesh by their names: patches, or the whole surface. Points of the mesh start at index
/// `first`.
#[pyfunction]
pub(crate) fn bodies<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    name: &str,
    patches: Vec<String>,
    first: usize,
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let bodies = Body::of_mesh(&mesh.0, name, &patches, first);
    let bodies = bodies.map_err(|error| error.at(format!("surface {name}"))).or_raise()?;
    let one = |(body, _): (Body, _)| {
        let flat: Vec<u32> = body.triangles.as_flattened().iter().map(|v| v.0).collect();
        Ok((body.name, table(py, flat, 3)?.into_any()))
    };
    bodies.into_iter().map(one).collect()
}
