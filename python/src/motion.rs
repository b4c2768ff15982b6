//! Motion: boundary displacements in, volume mesh out.

use motet::Mesh;
use motet::base::{Point, Threads, VertexId, Watch};
use motet::mesh::Boundary;
use motet::motion::{self, BoundaryMotion, Extent, FacetSet, Interface, MotionParts, Options, Prescribed};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::{Ids, Vectors, VectorsOut, ids, rows, rows_mut, vectors, vertices};
use crate::convert::MeshArg;
use crate::error::{OrRaise, call, input};
use crate::report::{report, with_not_reached};
use crate::watch::{run_watched, watched};
use crate::words::{Facets, all_facets, name_of, threads};

/// Options of a mover; on Python's side a class with these attributes.
#[derive(FromPyObject)]
pub(crate) struct Request<'py> {
    method: String,
    bodies: Vec<Facets<'py>>,
    within_walls: bool,
    smooth: usize,
    also_moved: Option<Ids<'py>>,
    rigid_layer: Option<f64>,
    rigid_layer_cells: Option<usize>,
    rigid_layer_at: Vec<Facets<'py>>,
    slide: Vec<Facets<'py>>,
    slide_tolerance: f64,
    residual: f64,
    factor_gib: f64,
    substeps: usize,
}

impl Request<'_> {
    fn options(&self, mesh: &Mesh) -> PyResult<Options> {
        let also_moved = match &self.also_moved {
            Some(array) => vertices(array, mesh.points.len())?,
            None => Vec::new(),
        };
        let motion = motion::Motion {
            method: name_of(&self.method)?,
            within_walls: self.within_walls,
            smooth: self.smooth,
            rigid_layer: extent(self.rigid_layer, self.rigid_layer_cells),
            slide_tolerance: self.slide_tolerance,
            residual: self.residual,
            factor_gib: self.factor_gib,
            substeps: self.substeps,
            ..motion::Motion::default()
        };
        let parts = MotionParts {
            bodies: all_facets(mesh, &self.bodies)?,
            wall: FacetSet::joined(all_facets(mesh, &self.rigid_layer_at)?),
            sliding: all_facets(mesh, &self.slide)?,
            also_moved,
        };
        motion.options_on(parts).or_raise()
    }
}

/// The extent of a rigid layer that is given by a distance or by a number of cells.
pub(crate) fn extent(distance: Option<f64>, cells: Option<usize>) -> Option<Extent> {
    distance.map(Extent::Distance).or(cells.map(Extent::Cells))
}

/// Moves the vertices of a mesh so that they follow its boundary.
#[pyclass(module = "motet._motet")]
pub(crate) struct Mover {
    mover: motion::Mover,
    threads: Threads,
}

#[pymethods]
impl Mover {
    #[new]
    fn new(
        py: Python<'_>,
        mesh: MeshArg,
        request: Request<'_>,
        threads: usize,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let options = request.options(&mesh.0)?;
        let new = |threads: &Threads| motion::Mover::new(&mesh.0, &options, threads);
        Ok(Self { mover: watched(py, threads, progress, new)?, threads: self::threads(threads)? })
    }

    #[getter]
    fn boundary<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        ids(py, self.mover.boundary().to_vec()).into_any()
    }

    #[getter]
    fn reference<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(vectors(py, self.mover.reference().to_vec())?.into_any())
    }

    #[getter]
    fn setup<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        report(py, self.mover.setup())
    }

    fn weights(&self, vertex: u32) -> PyResult<Option<([u32; 4], [f64; 4])>> {
        if vertex as usize >= self.mover.reference().len() {
            return Err(input(format!("there is no vertex {vertex}")));
        }
        Ok(self.mover.weights(VertexId(vertex)).map(|(ids, weights)| (ids.map(|v| v.0), weights)))
    }

    /// Makes a step; reads and writes the arrays in place.
    fn step(&self, py: Python<'_>, displacement: Vectors<'_>, mut out: VectorsOut<'_>) -> PyResult<()> {
        let (displacement, out) = (rows(&displacement, "displacement")?, rows_mut(&mut out, "out")?);
        call(py, || self.mover.step(displacement, out, &self.threads))
    }

    fn advance<'py>(
        &mut self,
        py: Python<'py>,
        displacement: Vectors<'_>,
        mut out: VectorsOut<'_>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (displacement, out) = (rows(&displacement, "displacement")?, rows_mut(&mut out, "out")?);
        let watch = Watch::new();
        let threads = std::mem::take(&mut self.threads).watched(&watch);
        let advance = |threads: &Threads| self.mover.advance(displacement, out, threads);
        let (threads, certificate) = run_watched(py, &watch, threads, None, advance);
        self.threads = threads;
        let certificate = certificate?;
        with_not_reached(py, &certificate, certificate.not_reached())
    }
}

/// Moves points so that they follow nodes, without a mesh.
#[pyclass(frozen, module = "motet._motet")]
pub(crate) struct PointMover {
    mover: motion::PointMover,
    threads: Threads,
}

#[pymethods]
impl PointMover {
    #[new]
    fn new(py: Python<'_>, nodes: Vectors<'_>, points: Vectors<'_>, threads: usize) -> PyResult<Self> {
        let (nodes, points) = (rows(&nodes, "nodes")?, rows(&points, "points")?);
        let threads = self::threads(threads)?;
        let mover = call(py, || motion::PointMover::new(nodes, points, &threads))?;
        Ok(Self { mover, threads })
    }

    /// Number of points that lie outside the graph.
    #[getter]
    fn n_outside(&self) -> usize {
        self.mover.n_outside()
    }

    /// Makes a step; reads and writes the arrays in place.
    fn step(&self, py: Python<'_>, displacement: Vectors<'_>, mut out: VectorsOut<'_>) -> PyResult<()> {
        let (displacement, out) = (rows(&displacement, "displacement")?, rows_mut(&mut out, "out")?);
        call(py, || self.mover.step(displacement, out, &self.threads))
    }
}

/// A motion of some vertices.
#[derive(FromPyObject)]
pub(crate) enum Motion {
    /// Axis, angle in degrees, and centre.
    Turn((Point, f64, Option<Point>)),
    Shift(Point),
}

/// Displacements of the boundary by patches that turn and shift, at several fractions (`parts`) of the whole
/// motion. A vertex follows the first motion prescribed for it.
#[pyfunction]
pub(crate) fn prescribed<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    boundary: Ids<'_>,
    motions: Vec<(Facets<'_>, Vec<Motion>)>,
    fractions: Vec<f64>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let mesh = mesh.0;
    let boundary = vertices(&boundary, mesh.points.len())?;
    let mut requested = BoundaryMotion::still(&boundary);
    for (word, motions) in &motions {
        let set = crate::words::facets(&mesh, word)?;
        let all = motions.iter().map(|motion| of(motion, &mesh, &set.vertices)).collect();
        let motion = Prescribed::sequence(all);
        requested.check_alike(&mesh.points, &set.name, &set.vertices, &motion).or_raise()?;
        requested.follow(&set.vertices, motion).or_raise()?;
    }
    fractions.iter().map(|&f| Ok(vectors(py, requested.displacements(&mesh.points, f))?.into_any())).collect()
}

fn of(motion: &Motion, mesh: &Mesh, vertices: &[VertexId]) -> Prescribed {
    match *motion {
        Motion::Shift(by) => Prescribed::Shift(by),
        Motion::Turn((axis, degrees, centre)) => Prescribed::Turn {
            axis,
            angle: degrees.to_radians(),
            centre: centre.unwrap_or_else(|| Prescribed::middle(&mesh.points, vertices)),
        },
    }
}

/// The cheapest method that keeps the worst cell above a bound for all of these displacements, and the
/// methods tried.
#[pyfunction]
pub(crate) fn choose<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    request: Request<'_>,
    least: Option<f64>,
    frames: Vec<Vectors<'_>>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, f64, Bound<'py, PyAny>)> {
    let options = request.options(&mesh.0)?;
    let frames: Vec<Vec<Point>> =
        frames.iter().map(|frame| Ok(rows(frame, "displacement")?.to_vec())).collect::<PyResult<_>>()?;
    let all = || Ok(frames.iter().map(|frame| Ok(frame.clone())));
    let choice =
        watched(py, threads, progress, |threads| motion::choose(&mesh.0, &options, least, all, threads))?;
    Ok((choice.method.name().to_string(), choice.least, report(py, &choice.tried)?))
}

/// Velocities by the difference of two positions.
#[pyfunction]
pub(crate) fn mesh_velocity<'py>(
    py: Python<'py>,
    before: Vectors<'_>,
    points: Vectors<'_>,
    dt: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let velocity =
        motion::mesh_velocity(rows(&before, "points before")?, rows(&points, "points")?, dt).or_raise()?;
    Ok(vectors(py, velocity)?.into_any())
}

/// The vertices of the interfaces inside that a displacement of all points moves, ascending.
#[pyfunction]
pub(crate) fn interface_vertices<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    displacement: Vectors<'_>,
) -> PyResult<Bound<'py, PyArray1<u32>>> {
    let boundary = Boundary::of(&mesh.0.cells);
    let moved = Interface::moved(&mesh.0, &boundary, rows(&displacement, "displacement")?).or_raise()?;
    let mut vertices: Vec<VertexId> = moved.into_iter().flat_map(|interface| interface.vertices).collect();
    vertices.sort_unstable();
    vertices.dedup();
    Ok(ids(py, vertices))
}

/// The vertices of patches, ascending.
#[pyfunction]
pub(crate) fn patch_vertices<'py>(
    py: Python<'py>,
    mesh: MeshArg,
    patches: Vec<Facets<'_>>,
) -> PyResult<Bound<'py, PyArray1<u32>>> {
    let joined = FacetSet::joined(all_facets(&mesh.0, &patches)?);
    Ok(ids(py, joined.map_or_else(Vec::new, |set| set.vertices)))
}
