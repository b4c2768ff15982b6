//! The graph: the Delaunay triangulation of the nodes, and where every other vertex lies in it.

mod walls;
mod weights;

use std::time::Instant;

use crate::base::{Point, Result, Threads, VertexId};
use crate::delaunay::Triangulation;
use crate::motion::graph::weights::weights;
use crate::motion::setup::{Setup, SetupSeconds};

pub(crate) use walls::Walls;

/// Where points lie in the triangulation of some nodes.
#[derive(Debug, Default)]
pub(crate) struct Embedding {
    /// Corners, as indices of nodes, of the tets that contain a point.
    pub(crate) tets: Vec<[u32; 4]>,
    /// For each point, the index of its tet in [`Self::tets`].
    pub(crate) tet: Vec<u32>,
    /// For each point, the weights of the four corners.
    pub(crate) weights: Vec<[f64; 4]>,
    /// Points in no tet, in rising order: they have the weights of a nearby place on the hull.
    pub(crate) outside: Vec<u32>,
    /// The number of tets of the whole triangulation.
    pub(crate) n_tets: usize,
}

impl Embedding {
    /// Removes some points, given in rising order.
    pub(crate) fn remove(&mut self, some: &[u32]) {
        let is_kept = |i: u32| some.binary_search(&i).is_err();
        let mut i = 0u32..;
        self.tet.retain(|_| i.next().is_none_or(is_kept));
        let mut i = 0u32..;
        self.weights.retain(|_| i.next().is_none_or(is_kept));
        self.outside.retain(|&i| is_kept(i));
    }
}

/// The tets of a triangulation of nodes.
#[derive(Debug)]
pub(crate) struct Graph {
    /// Positions of the nodes: the given ones, then those that the triangulation needed in addition.
    pub(crate) places: Vec<Point>,
    pub(crate) tets: Vec<[u32; 4]>,
}

/// A graph on vertices of a mesh, and where other vertices lie in it.
pub(crate) struct BuiltGraph {
    pub(crate) graph: Graph,
    pub(crate) embedding: Embedding,
    /// Seconds for the triangulation; with walls, for all of it.
    pub(crate) triangulation_seconds: f64,
    /// Seconds for locating the vertices.
    pub(crate) locating_seconds: f64,
}

impl BuiltGraph {
    /// Builds the graph of `nodes` with the vertices at `points`, within walls where some are given, and
    /// locates `free` in it.
    ///
    /// # Errors
    /// When the nodes do not span space, or walls cross each other.
    pub(crate) fn new(
        walls: Option<&Walls>,
        nodes: &[VertexId],
        free: &[VertexId],
        points: &[Point],
        threads: &Threads,
    ) -> Result<Self> {
        let begin = Instant::now();
        let at = |v: &VertexId| points[v.index()];
        let nodes: Vec<Point> = nodes.iter().map(at).collect();
        let places = || free.iter().map(at).collect::<Vec<Point>>();
        if let Some(walls) = walls {
            let (graph, embedding) = walls.graph(nodes, &places(), threads)?;
            let triangulation_seconds = begin.elapsed().as_secs_f64();
            return Ok(Self { graph, embedding, triangulation_seconds, locating_seconds: 0.0 });
        }
        let triangulation = triangulate(&nodes, threads)?;
        let triangulation_seconds = begin.elapsed().as_secs_f64();
        let embedding = embed(&triangulation, &places(), threads);
        let tets = triangulation.tets().iter().map(|t| t.map(|v| v.0)).collect();
        let locating_seconds = begin.elapsed().as_secs_f64() - triangulation_seconds;
        Ok(Self { graph: Graph { places: nodes, tets }, embedding, triangulation_seconds, locating_seconds })
    }

    /// Removes vertices that lie outside the graph and that no cell uses from the embedding; returns their
    /// indices among the located ones, in rising order.
    pub(crate) fn leave_unused(&mut self, free: &[VertexId], is_used: Option<&[bool]>) -> Vec<u32> {
        let stays = |i: &u32| is_used.is_some_and(|is_used| !is_used[free[*i as usize].index()]);
        let staying: Vec<u32> = self.embedding.outside.iter().copied().filter(stays).collect();
        self.embedding.remove(&staying);
        staying
    }

    /// The counts and the seconds so far, of a graph on `n_nodes` vertices.
    pub(crate) fn setup(&self, n_nodes: usize) -> Setup {
        Setup {
            graph_nodes: n_nodes,
            graph_tets: self.embedding.n_tets,
            holding_tets: self.embedding.tets.len(),
            outside: self.embedding.outside.len(),
            seconds: SetupSeconds {
                triangulation: self.triangulation_seconds,
                hanging: self.locating_seconds,
                ..SetupSeconds::default()
            },
            ..Setup::default()
        }
    }

    /// The tets that contain a vertex, those whose nodes are all among `nodes`.
    pub(crate) fn holding_tets(&self, nodes: &[VertexId]) -> Vec<[VertexId; 4]> {
        let vertices = |t: &[u32; 4]| {
            let [a, b, c, d] = t.map(|i| nodes.get(i as usize).copied());
            Some([a?, b?, c?, d?])
        };
        self.embedding.tets.iter().filter_map(vertices).collect()
    }
}

/// Triangulates `nodes`.
///
/// # Errors
/// When the nodes do not span space: fewer than four, all on a line, or all in a plane.
pub(crate) fn triangulate(nodes: &[Point], threads: &Threads) -> Result<Triangulation> {
    Triangulation::new(nodes, threads).map_err(|e| {
        e.remedy("mesh motion needs boundary vertices that span space: check that the mesh is not flat")
    })
}

/// Finds the tet of each of `points`, and its weights there. The points must be finite.
pub(crate) fn embed(triangulation: &Triangulation, points: &[Point], threads: &Threads) -> Embedding {
    let located = triangulation.locator().locate_all(points, threads);
    let nodes = triangulation.points();
    let found: Vec<(u32, bool)> = located.iter().map(|at| (at.tet().0, at.is_inside())).collect();
    Embedding::new(nodes, triangulation.tets(), &found, points, threads)
}

impl Embedding {
    /// Built from `found`: the tet of each point, and whether the point lies inside it.
    pub(crate) fn new(
        nodes: &[Point],
        tets: &[[VertexId; 4]],
        found: &[(u32, bool)],
        points: &[Point],
        threads: &Threads,
    ) -> Self {
        let corners = |tet: u32| tets[tet as usize].map(|v| nodes[v.index()]);
        let weights = threads.map(points.len(), |i| weights(points[i], corners(found[i].0)));
        let mut number = vec![0; tets.len()];
        found.iter().for_each(|(tet, _)| number[*tet as usize] = 1);
        let mut holding = Vec::new();
        for (tet, number) in tets.iter().zip(&mut number).filter(|(_, number)| **number == 1) {
            *number = holding.len() as u32;
            holding.push(tet.map(|v| v.0));
        }
        Self {
            tet: found.iter().map(|(tet, _)| number[*tet as usize]).collect(),
            outside: (0..).zip(found).filter(|(_, (_, is_inside))| !is_inside).map(|(i, _)| i).collect(),
            n_tets: tets.len(),
            tets: holding,
            weights,
        }
    }
}
