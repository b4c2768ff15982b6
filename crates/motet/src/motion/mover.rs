//! The mover: set up once, then milliseconds per step.

use std::time::Instant;

use serde::Serialize;

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::{in_range, sub};
use crate::mesh::{Boundary, Mesh};
use crate::motion::bodies::{self, RigidBodies};
use crate::motion::check::Check;
use crate::motion::distance::{InverseDistance, Radial};
use crate::motion::graph::{Embedding, Graph, embed, triangulate};
use crate::motion::graph_map::GraphMap;
use crate::motion::guided::{self, Guided, Helpers};
use crate::motion::map::Map;
use crate::motion::middles::Middles;
use crate::motion::nodes::{Nodes, not_sliding};
use crate::motion::options::{FacetSet, Limits, Method, Options, Strain};
use crate::motion::slide::{LeavesPlane, SlidingPlane};
use crate::motion::smooth::Smoother;
use crate::motion::solve::LinearMethod;
use crate::motion::update::WeightTable;
use crate::motion::walls::{AddedPoints, Walls};

/// Moves the vertices of a mesh with its boundary.
///
/// It keeps the mesh as given, the reference: a step depends on the displacement alone, never on the steps
/// before it, so a wall that returns brings every vertex back to the same bits.
#[derive(Debug)]
pub struct Mover {
    pub(crate) reference: Vec<Point>,
    pub(crate) nodes: Nodes,
    /// Vertices that follow the nodes.
    hanging: Vec<VertexId>,
    /// Middle nodes that stay between their corners.
    middles: Middles,
    method: Method,
    strain: Strain,
    /// The vertices of each rigid body.
    bodies: Vec<Vec<VertexId>>,
    /// Where a Laplace equation is stiff, or the facets whose rotation guides.
    wall: FacetSet,
    /// How vertices follow from the reference.
    pub(crate) map: Map,
    pub(crate) smoother: Option<Smoother>,
    /// Nodes of the graph in addition to those that are given.
    helpers: Helpers,
    /// The walls that the graph stays within.
    walls: Option<Walls>,
    /// Tets of the graph of the reference that contain a vertex.
    pub(crate) tets: Vec<[VertexId; 4]>,
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

/// What setting up found, and how long it took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Setup {
    /// Vertices that the caller moves: those of the boundary, and those requested.
    pub driven: usize,
    /// Of these, vertices that slide in the plane of their patch, or on the line where two such planes meet.
    pub sliding: usize,
    /// Vertices of the rigid layer.
    pub layer: usize,
    /// Nodes of the graph: driven vertices, the outer ones of the layer, and interior ones that the method
    /// adds.
    pub graph_nodes: usize,
    /// Tets of the graph.
    pub graph_tets: usize,
    /// Tets of the graph that contain a vertex.
    pub holding_tets: usize,
    /// Vertices that follow the graph.
    pub hanging: usize,
    /// Middle nodes of quadratic cells that stay in the middle of their corners; none of them is in the layer
    /// or slides.
    #[serde(skip_serializing_if = "is_zero")]
    pub middles: usize,
    /// Vertices that a linear system is solved for.
    pub solved: usize,
    /// Bytes of the factor that is kept of this system; 0 where steps are iterated.
    pub factor_bytes: u64,
    /// Of those that follow the graph, vertices of cells that lie outside it (middle nodes of a curved
    /// boundary, vertices of inverted cells): they follow the nearest place in it.
    pub outside: usize,
    /// Vertices of no volume cell that lie outside the graph, or have no finite position: they stay.
    pub left: usize,
    /// Seconds, by stage.
    pub seconds: SetupSeconds,
}

/// Seconds that the stages of setting up took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SetupSeconds {
    /// Finding the boundary.
    pub boundary: f64,
    /// Rigid layer and sliding patches.
    pub layer: f64,
    /// Collecting the corners of the cells, and checking which are inverted at the start.
    pub cells: f64,
    /// The Delaunay triangulation of the graph's nodes.
    pub triangulation: f64,
    /// Finding the tet and the weights of every other vertex.
    pub hanging: f64,
    /// Setting up a linear system, or the shares of bodies.
    pub system: f64,
    /// Finding the tets of each vertex, for smoothing.
    pub smoothing: f64,
    /// The whole set-up.
    pub total: f64,
}

impl Mover {
    /// Sets up the motion of `mesh`: finds its boundary, builds the graph and locates every vertex in it.
    ///
    /// # Errors
    /// When the mesh has no volume cells, vertices without a finite position, or a boundary that does not
    /// span space; when options name something that does not exist.
    pub fn new(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Self> {
        let begin = Instant::now();
        let mut setup = Setup::default();
        let boundary = Boundary::of(&mesh.cells);
        options.check()?;
        check_input(mesh, &boundary, options)?;
        let mut clock = Instant::now();
        setup.seconds.boundary = (clock - begin).as_secs_f64();
        let is_used = used_by_volume(mesh);
        let mut nodes = Nodes::new(mesh, &boundary, options, &is_used, threads)?;
        let walls = options.within_walls.then(|| Walls::new(mesh, &boundary, &mut nodes));
        setup.seconds.layer = lap_seconds(&mut clock);
        let check = Check::new(mesh, threads);
        setup.seconds.cells = lap_seconds(&mut clock);
        let mut is_node = vec![false; mesh.points.len()];
        nodes.vertices.iter().for_each(|v| is_node[v.index()] = true);
        let is_prescribed = nodes.prescribed(mesh.points.len());
        let middles = Middles::of(mesh, &is_prescribed, options.method.places_corners_only());
        for v in middles.vertices() {
            setup.middles += usize::from(!is_node[v.index()]);
            is_node[v.index()] = true;
        }
        let hanging =
            (0..mesh.points.len()).filter(|&v| !is_node[v] && in_range(mesh.points[v])).map(VertexId::new);
        let mut mover = Self {
            reference: mesh.points.clone(),
            nodes,
            hanging: hanging.collect(),
            middles,
            wall: wall(&boundary, options),
            method: options.method.clone(),
            strain: options.strain,
            bodies: match &options.method {
                Method::Bodies(sets) => bodies::body_vertices(sets, mesh, &boundary, &options.also_moved)?,
                _ => Vec::new(),
            },
            map: Map::Graph(GraphMap::default()),
            smoother: None,
            helpers: Helpers::default(),
            walls,
            tets: Vec::new(),
            check,
            limits: options.limits,
            state: None,
            setup,
        };
        threads.watch().report_and_check("setting up a motion", 0, 0)?;
        match mover.method {
            Method::Delaunay | Method::Bodies(_) | Method::Guided => {
                mover.embed_reference(&is_used, threads)?;
            }
            _ => mover.assemble_reference(&is_used, threads)?,
        }
        mover.setup.seconds.smoothing = mover.set_up_smoothing(options.smoothing);
        mover.setup.seconds.total = begin.elapsed().as_secs_f64();
        Ok(mover)
    }

    /// The vertices that the caller moves, in rising order: those of the boundary, and those of
    /// [`Options::also_moved`].
    pub fn boundary(&self) -> &[VertexId] {
        &self.nodes.vertices[..self.nodes.n_driven]
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
        self.hanging.binary_search(&v).ok()?;
        let table = match &self.map {
            Map::Graph(graph_map) => &graph_map.table,
            Map::Bodies(bodies) => bodies.graph(),
            _ => return None,
        };
        let (nodes, weights) = table.of(v.index());
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
        let iterations = self.map.apply(&self.reference, &nodes, out, threads)?;
        Ok(Work { iterations, smoothed: self.finish(out, threads) })
    }

    /// Finishes a step: smooths, where that is requested, and puts middle nodes in the middle. Returns the
    /// number of vertices smoothed.
    pub(crate) fn finish(&self, out: &mut [Point], threads: &Threads) -> usize {
        let n_smoothed = self.smoother.as_ref().map_or(0, |smoother| smoother.apply(out, threads));
        self.middles.place(&self.reference, out, threads);
        n_smoothed
    }

    /// Sets up smoothing; returns the seconds that this took.
    fn set_up_smoothing(&mut self, sweeps: usize) -> f64 {
        let begin = Instant::now();
        let new = || Smoother::new(&self.check, &self.hanging, self.reference.len(), sweeps);
        self.smoother = (sweeps > 0).then(new);
        begin.elapsed().as_secs_f64()
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
        let map = self.rebuild(&self.reference, threads)?;
        let nodes = self.nodes.displacements(displacement, threads);
        map.apply(&self.reference, &nodes, out, threads)?;
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

    /// Sets the method up with the vertices at `points`.
    pub(crate) fn rebuild(&self, points: &[Point], threads: &Threads) -> Result<Map> {
        match self.method {
            Method::InverseDistance => {
                let inverse = InverseDistance::new(&self.wall, &self.nodes.vertices, &self.hanging, points);
                Ok(Map::Inverse(Box::new(inverse)))
            }
            Method::Radial => {
                Ok(Map::Radial(Box::new(Radial::new(&self.nodes.vertices, &self.hanging, points))))
            }
            Method::Elastic(_) | Method::Laplace(_) => {
                let (tets, nodes) = (&self.check.corners.tets, &self.nodes.vertices);
                let vertices = (&self.hanging[..], &nodes[..]);
                LinearMethod::new(&self.method, tets, points, vertices, &self.wall, threads)
                    .map(|linear| Map::Linear(Box::new(linear)))
            }
            _ => {
                let (graph, found, _) = self.build_graph(points, threads)?;
                self.map_on_graph(graph, &found, points, threads)
            }
        }
    }

    /// The map of displacements on a graph that was built with the vertices at `points`.
    fn map_on_graph(
        &self,
        graph: Graph,
        found: &Embedding,
        points: &[Point],
        threads: &Threads,
    ) -> Result<Map> {
        if matches!(self.method, Method::Guided) {
            let mut table = WeightTable::fixed(graph.places.len() as u32, self.reference.len());
            for (vertex, (&tet, w)) in self.hanging.iter().zip(found.tet.iter().zip(&found.weights)) {
                table.set(*vertex, found.tets[tet as usize], *w);
            }
            let guided = Guided::new(graph, table, (&self.nodes, &self.helpers), &self.wall, points)?;
            return Ok(Map::Guided(Box::new(guided)));
        }
        let added = AddedPoints::new(&graph, &self.nodes.of_graph)?;
        let n_added = added.as_ref().map_or(0, AddedPoints::len);
        let graph_map = GraphMap { table: self.weight_table(found, n_added), added: added.map(Box::new) };
        if self.bodies.is_empty() {
            return Ok(Map::Graph(graph_map));
        }
        let (tets, vertices) = (&self.check.corners.tets, (&self.hanging[..], &self.nodes));
        RigidBodies::new((&self.bodies, self.strain), tets, points, vertices, graph_map, threads)
            .map(|b| Map::Bodies(Box::new(b)))
    }

    /// The vertex of a node of the graph; `None` for a point that the graph added.
    fn vertex_of_graph(&self, i: u32) -> Option<VertexId> {
        let n_given = self.nodes.of_graph.len();
        match self.nodes.of_graph.get(i as usize) {
            Some(&node) => Some(self.nodes.vertices[node as usize]),
            None => self.helpers.vertices.get(i as usize - n_given).copied(),
        }
    }

    /// Sets up the system of the reference. Vertices that no cell uses do not take part.
    fn assemble_reference(&mut self, is_used: &[bool], threads: &Threads) -> Result<()> {
        let begin = Instant::now();
        self.hanging.retain(|v| is_used[v.index()]);
        self.map = self.rebuild(&self.reference, threads)?;
        let nodes = &self.nodes;
        let (solved, factor_bytes) = match &self.map {
            Map::Linear(linear) => (self.hanging.len(), linear.factor_bytes()),
            _ => (0, 0),
        };
        self.setup.seconds.system = begin.elapsed().as_secs_f64();
        self.setup = Setup {
            driven: nodes.n_driven,
            sliding: nodes.n_sliding(),
            layer: nodes.vertices.len() - nodes.n_driven,
            solved,
            hanging: self.hanging.len() - solved,
            factor_bytes,
            left: self.reference.len() - nodes.vertices.len() - self.hanging.len() - self.setup.middles,
            ..self.setup
        };
        Ok(())
    }

    /// Builds the graph and locates the vertices in it; also returns the seconds for each of the two.
    fn build_graph(&self, points: &[Point], threads: &Threads) -> Result<(Graph, Embedding, [f64; 2])> {
        let mut clock = Instant::now();
        let at = |v: &VertexId| points[v.index()];
        let given = self.nodes.of_graph.iter().map(|&n| &self.nodes.vertices[n as usize]);
        let graph: Vec<Point> = given.chain(&self.helpers.vertices).map(at).collect();
        if let Some(walls) = &self.walls {
            let places: Vec<Point> = self.hanging.iter().map(at).collect();
            let (graph, found) = walls.graph(graph, &places, threads)?;
            return Ok((graph, found, [lap_seconds(&mut clock), 0.0]));
        }
        let triangulation = triangulate(&graph, threads)?;
        let built = lap_seconds(&mut clock);
        let places: Vec<Point> = self.hanging.iter().map(at).collect();
        let found = embed(&triangulation, &places, threads);
        let tets = triangulation.tets().iter().map(|t| t.map(|v| v.0)).collect();
        Ok((Graph { places: graph, tets }, found, [built, lap_seconds(&mut clock)]))
    }

    /// Builds the graph of the reference. Vertices outside it that no cell uses do not take part.
    fn embed_reference(&mut self, is_used: &[bool], threads: &Threads) -> Result<()> {
        if matches!(self.method, Method::Guided) {
            self.helpers = guided::choose_helpers(
                &self.check.corners.tets,
                &self.reference,
                &self.hanging,
                HELPER_RINGS,
            );
        }
        let (graph, mut found, [triangulation, hanging]) = self.build_graph(&self.reference, threads)?;
        let stays = |i: u32| !is_used[self.hanging[i as usize].index()];
        let staying: Vec<u32> = found.outside.iter().copied().filter(|&i| stays(i)).collect();
        found.remove(&staying);
        let mut i = 0u32..;
        self.hanging.retain(|_| i.next().is_none_or(|i| staying.binary_search(&i).is_err()));
        let begin = Instant::now();
        self.map = self.map_on_graph(graph, &found, &self.reference, threads)?;
        self.setup.seconds.system = begin.elapsed().as_secs_f64();
        let vertices = |t: &[u32; 4]| {
            let [a, b, c, d] = t.map(|i| self.vertex_of_graph(i));
            Some([a?, b?, c?, d?])
        };
        self.tets = found.tets.iter().filter_map(vertices).collect();
        let nodes = &self.nodes;
        self.setup.seconds.triangulation = triangulation;
        self.setup.seconds.hanging = hanging;
        self.setup = Setup {
            driven: nodes.n_driven,
            sliding: nodes.n_sliding(),
            layer: nodes.vertices.len() - nodes.n_driven,
            graph_nodes: self.nodes.of_graph.len() + self.helpers.vertices.len(),
            graph_tets: found.n_tets,
            holding_tets: found.tets.len(),
            hanging: self.hanging.len(),
            outside: found.outside.len(),
            left: self.reference.len() - nodes.vertices.len() - self.hanging.len() - self.setup.middles,
            ..self.setup
        };
        Ok(())
    }

    /// The table for all vertices: nodes follow themselves, and vertices that stay follow the node that never
    /// moves.
    fn weight_table(&self, found: &Embedding, n_added: usize) -> WeightTable {
        let n_nodes = self.nodes.vertices.len();
        let mut table = WeightTable::fixed((n_nodes + n_added) as u32, self.reference.len());
        let (of_graph, n_given) = (&self.nodes.of_graph, self.nodes.of_graph.len());
        let node = |i: u32| {
            of_graph.get(i as usize).copied().unwrap_or_else(|| (i as usize - n_given + n_nodes) as u32)
        };
        for (node, vertex) in (0..).zip(&self.nodes.vertices) {
            table.nodes[vertex.index()] = [node; 4];
        }
        for (vertex, (&tet, w)) in self.hanging.iter().zip(found.tet.iter().zip(&found.weights)) {
            let nodes = found.tets[tet as usize].map(node);
            table.set(*vertex, nodes, *w);
        }
        table
    }
}

/// Helpers are more than this many edges apart. With 2 a step takes a third of the time on a mesh of 32,000
/// vertices, but a flap that bends by 90 degrees keeps an inverted tet through 16 sweeps of smoothing, and at
/// 60 degrees half as many bad ones again.
const HELPER_RINGS: usize = 1;

fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// The facets that guide, which are the boundary; or those where a Laplace equation is stiff: what the
/// options name, else all of the boundary that does not slide.
fn wall(boundary: &Boundary, options: &Options) -> FacetSet {
    match &options.method {
        Method::Guided | Method::InverseDistance => FacetSet::of_boundary(boundary, "boundary", |_| true),
        Method::Laplace(law) => law.wall.clone().unwrap_or_else(|| not_sliding(boundary, &options.sliding)),
        _ => FacetSet::default(),
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
