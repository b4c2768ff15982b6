//! The mover: set up once, then milliseconds per step.

use std::sync::Arc;
use std::time::Instant;

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::{in_range, sub};
use crate::mesh::{Boundary, Connectivity, Mesh};
use crate::motion::check::Check;
use crate::motion::methods::{self, Follower, Prepare, Prepared, Reference, Scene};
use crate::motion::middles::Middles;
use crate::motion::nodes::Nodes;
use crate::motion::options::{Limits, Options};
use crate::motion::setup::{Setup, SetupSeconds};
use crate::motion::slide::{LeavesPlane, SlidingPlane};
use crate::motion::smooth::Smoother;

/// Moves the vertices of a mesh with its boundary.
///
/// It keeps the mesh as given, the reference: a step depends on the displacement alone, never on the steps
/// before it, so a wall that returns brings every vertex back to the same bits.
#[derive(Debug)]
pub struct Mover {
    pub(crate) reference: Vec<Point>,
    pub(crate) nodes: Nodes,
    /// The boundary and the tets of the mesh.
    connectivity: Arc<Connectivity>,
    /// Vertices that follow the nodes.
    free: Vec<VertexId>,
    /// Middle nodes that stay between their corners.
    middles: Middles,
    method: Box<dyn Prepare>,
    /// How vertices follow from the reference.
    follower: Box<dyn Follower>,
    pub(crate) smoother: Option<Smoother>,
    /// Tets of the graph of the reference that contain a vertex.
    pub(crate) graph_tets: Vec<[VertexId; 4]>,
    pub(crate) check: Check,
    pub(crate) limits: Limits,
    pub(crate) state: Option<State>,
    setup: Setup,
}

/// Where a call of [`Mover::advance`] left the mesh.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) points: Vec<Point>,
    /// Displacements of the driven vertices in this state.
    pub(crate) driven: Vec<Point>,
}

/// The work done in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    pub(crate) iterations: usize,
    pub(crate) smoothed: usize,
}

impl Mover {
    /// Sets up the motion of `mesh`: finds its boundary, builds the graph and locates every vertex in it.
    ///
    /// # Errors
    /// When the mesh has no volume cells, vertices without a finite position, or a boundary that does not
    /// span space; when options name something that does not exist.
    pub fn new(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Self> {
        Self::with(mesh, || Arc::new(Connectivity::of(mesh, threads)), options, threads)
    }

    /// Sets up the motion of `mesh` as [`Self::new`] does, with its connectivity.
    ///
    /// # Errors
    /// The errors of [`Self::new`].
    pub(crate) fn with(
        mesh: &Mesh,
        connectivity: impl FnOnce() -> Arc<Connectivity>,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        let begin = Instant::now();
        let mut setup = Setup::default();
        options.check()?;
        let connectivity = connectivity();
        let boundary = &connectivity.boundary;
        check_input(mesh, boundary, options)?;
        let mut clock = Instant::now();
        setup.seconds.boundary = (clock - begin).as_secs_f64();
        let is_used = used_by_volume(mesh);
        let mut nodes = Nodes::new(mesh, boundary, options, &is_used, threads)?;
        setup.seconds.layer = lap_seconds(&mut clock);
        let check = Check::new(mesh, connectivity.tets.clone(), threads);
        setup.seconds.cells = lap_seconds(&mut clock);
        let mut is_node = vec![false; mesh.points.len()];
        nodes.vertices.iter().for_each(|v| is_node[v.index()] = true);
        let is_prescribed = nodes.prescribed(mesh.points.len());
        let middles = Middles::of(mesh, &is_prescribed, options.method.places_corners_only());
        for v in middles.vertices() {
            setup.middles += usize::from(!is_node[v.index()]);
            is_node[v.index()] = true;
        }
        let follows = |v: &VertexId| !is_node[v.index()] && in_range(mesh.points[v.index()]);
        let mut free: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).filter(follows).collect();
        let corners = &check.corners.tets;
        let method =
            methods::of(&mut Reference { mesh, boundary, options, corners, free: &free, nodes: &mut nodes })?;
        threads.watch().report_and_check("setting up a motion", 0, 0)?;
        let scene = Scene { nodes: &nodes, free: &free, corners, is_used: Some(&is_used) };
        let Prepared { follower, staying, graph_tets, setup: of_method } =
            method.prepare(&scene, &mesh.points, threads)?;
        let mut i = 0u32..;
        free.retain(|_| i.next().is_none_or(|i| staying.binary_search(&i).is_err()));
        clock = Instant::now();
        let smoother = (options.smoothing > 0)
            .then(|| Smoother::new(&check.corners, &free, mesh.points.len(), options.smoothing));
        let setup = Setup {
            driven: nodes.n_driven,
            sliding: nodes.n_sliding(),
            layer: nodes.vertices.len() - nodes.n_driven,
            hanging: free.len() - of_method.solved,
            middles: setup.middles,
            left: mesh.points.len() - nodes.vertices.len() - free.len() - setup.middles,
            seconds: SetupSeconds {
                boundary: setup.seconds.boundary,
                layer: setup.seconds.layer,
                cells: setup.seconds.cells,
                smoothing: lap_seconds(&mut clock),
                total: begin.elapsed().as_secs_f64(),
                ..of_method.seconds
            },
            ..of_method
        };
        Ok(Self {
            reference: mesh.points.clone(),
            nodes,
            connectivity,
            free,
            middles,
            method,
            follower,
            smoother,
            graph_tets,
            check,
            limits: options.limits,
            state: None,
            setup,
        })
    }

    /// The vertices that the caller moves, in rising order: those of the boundary, and those of
    /// [`Options::also_moved`].
    pub fn boundary(&self) -> &[VertexId] {
        &self.nodes.vertices[..self.nodes.n_driven]
    }

    /// The boundary of the mesh, and its linear tets, oriented as in the reference.
    pub(crate) fn connectivity(&self) -> &Arc<Connectivity> {
        &self.connectivity
    }

    /// The points of the mesh as it was given.
    pub fn reference(&self) -> &[Point] {
        &self.reference
    }

    /// The planes of sliding patches: how flat they are, and how many vertices slide in each.
    pub fn sliding(&self) -> &[SlidingPlane] {
        &self.nodes.planes
    }

    /// Where the rim of a sliding patch leaves its plane farthest, when the vertices of [`Self::boundary`]
    /// have these displacements; `None` where all stay within their planes.
    pub fn leaves_plane(&self, displacement: &[Point]) -> Option<LeavesPlane> {
        self.nodes.worst_departure(&self.reference, displacement)
    }

    /// What setting up found, and how long it took.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The four vertices that `v` follows in the graph, and their weights; `None` where it follows anything
    /// else.
    pub fn weights(&self, v: VertexId) -> Option<([VertexId; 4], [f64; 4])> {
        self.free.binary_search(&v).ok()?;
        let (nodes, weights) = self.follower.weights()?.of(v.index());
        let vertex = |node: u32| self.nodes.vertices.get(node as usize).copied();
        let [a, b, c, d] = nodes.map(vertex);
        Some(([a?, b?, c?, d?], weights))
    }

    /// Moves the mesh from the reference: `displacement` has an entry for each vertex of [`Self::boundary`],
    /// and `out` receives the position of every vertex of the mesh.
    ///
    /// Driven vertices arrive to the bit; cells are not checked.
    ///
    /// # Errors
    /// When a length does not fit, a displacement is not finite, or a linear system cannot be solved to its
    /// tolerance.
    pub fn step(&self, displacement: &[Point], out: &mut [Point], threads: &Threads) -> Result<()> {
        self.check_lengths(displacement, out)?;
        self.displace(displacement, out, threads).map(|_| ())
    }

    pub(crate) fn check_lengths(&self, displacement: &[Point], out: &[Point]) -> Result<()> {
        self.check_displacement(displacement)?;
        match out.len() == self.reference.len() {
            true => Ok(()),
            false => Err(Error::input(format!(
                "the output holds {} points, but the mesh has {}",
                out.len(),
                self.reference.len()
            ))),
        }
    }

    /// A step without a check of the lengths.
    pub(crate) fn displace(
        &self,
        displacement: &[Point],
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<Work> {
        let nodes = self.nodes.displacements(displacement, threads);
        let iterations = self.follower.follow(&self.reference, &nodes, out, threads)?;
        Ok(Work { iterations, smoothed: self.finish(out, threads) })
    }

    /// Finishes a step: smooths, where that is requested, and puts middle nodes in the middle. Returns the
    /// number of vertices smoothed.
    pub(crate) fn finish(&self, out: &mut [Point], threads: &Threads) -> usize {
        let n_smoothed = self
            .smoother
            .as_ref()
            .map_or(0, |smoother| smoother.apply(&self.check.corners.tets, out, threads));
        self.middles.place(&self.reference, out, threads);
        n_smoothed
    }

    /// Rebuilds the graph and locates every vertex in it, then does a [`Self::step`]: the cost of a sub-step
    /// without the check for inverted cells.
    ///
    /// # Errors
    /// The errors of [`Self::step`].
    pub fn rebuild_and_step(
        &self,
        displacement: &[Point],
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<()> {
        self.check_displacement(displacement)?;
        let follower = self.follower_at(&self.reference, threads)?;
        let nodes = self.nodes.displacements(displacement, threads);
        follower.follow(&self.reference, &nodes, out, threads)?;
        self.middles.place(&self.reference, out, threads);
        Ok(())
    }

    pub(crate) fn check_displacement(&self, displacement: &[Point]) -> Result<()> {
        if displacement.len() != self.nodes.n_driven {
            return Err(Error::input(format!(
                "{} displacements are given, but {} vertices are to be moved",
                displacement.len(),
                self.nodes.n_driven
            )));
        }
        match displacement.iter().position(|&d| !in_range(d)) {
            None => Ok(()),
            Some(i) => {
                Err(Error::input("the displacement is not finite")
                    .at(format!("vertex {}", self.boundary()[i])))
            }
        }
    }

    /// A follower by the method, set up with the vertices at `points`.
    pub(crate) fn follower_at(&self, points: &[Point], threads: &Threads) -> Result<Box<dyn Follower>> {
        let corners = &self.check.corners.tets;
        let scene = Scene { nodes: &self.nodes, free: &self.free, corners, is_used: None };
        Ok(self.method.prepare(&scene, points, threads)?.follower)
    }
}

fn lap_seconds(clock: &mut Instant) -> f64 {
    let now = Instant::now();
    let seconds = (now - *clock).as_secs_f64();
    *clock = now;
    seconds
}

/// Which vertices a volume cell uses.
fn used_by_volume(mesh: &Mesh) -> Vec<bool> {
    let mut is_used = vec![false; mesh.points.len()];
    let volumes = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3));
    volumes.flat_map(|(_, _, vertices)| vertices).for_each(|v| is_used[v.index()] = true);
    is_used
}

fn check_input(mesh: &Mesh, boundary: &Boundary, options: &Options) -> Result<()> {
    if boundary.n_unknown > 0 {
        return Err(Error::input(format!(
            "{} volume cells are of an unsupported kind: their facets are not known",
            boundary.n_unknown
        ))
        .remedy("write the mesh with linear or quadratic cells in place of Lagrange ones"));
    }
    if boundary.is_empty() {
        let what = match mesh.cells.dim() {
            Some(3) => "the volume cells have no boundary to move".into(),
            dim => format!("volume cells are needed, but the cells have dimension {}", dim.unwrap_or(0)),
        };
        return Err(Error::input(what).remedy("give a volume mesh: a surface has no inside to move"));
    }
    let named = options.also_moved.iter().chain(options.sliding.iter().flat_map(|s| &s.vertices));
    if let Some(v) = named.clone().find(|v| v.index() >= mesh.points.len()) {
        return Err(Error::input(format!(
            "vertex {v} is to be moved, but there are {} points",
            mesh.points.len()
        )));
    }
    let volumes = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3));
    let needed = volumes.flat_map(|(_, _, vertices)| vertices).chain(named);
    match needed.copied().find(|v| !in_range(mesh.points[v.index()])) {
        None => Ok(()),
        Some(v) => {
            Err(Error::input(format!("has coordinates that are not finite: {:?}", mesh.points[v.index()]))
                .at(format!("vertex {v}"))
                .remedy("repair the coordinates in the file"))
        }
    }
}

/// `(to - from) / dt` for every vertex: the velocity of the mesh, by backward difference.
///
/// # Errors
/// When the lengths differ, or `dt` is not a positive number.
pub fn mesh_velocity(from: &[Point], to: &[Point], dt: f64) -> Result<Vec<Point>> {
    if from.len() != to.len() {
        return Err(Error::input(format!("{} points before, {} after", from.len(), to.len())));
    }
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(Error::options(format!("the time step must be positive and finite; got {dt}"))
            .remedy("give a positive time step"));
    }
    Ok(from.iter().zip(to).map(|(&a, &b)| sub(b, a).map(|x| x / dt)).collect())
}
