//! The graph: the Delaunay triangulation of the nodes, and where every other vertex lies in it.

use crate::base::{Point, Result, Threads, VertexId};
use crate::delaunay::Triangulation;
use crate::motion::weights::weights;

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
