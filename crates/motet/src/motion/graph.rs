//! The graph: the Delaunay triangulation of the nodes, and where each other vertex hangs in it.

use crate::base::{Point, Result, Threads, VertexId};
use crate::delaunay::Triangulation;
use crate::motion::weights::weights;

/// Where points hang in the triangulation of some nodes.
#[derive(Debug, Default)]
pub(crate) struct Hanging {
    /// Corners, as places among the nodes, of those tets that hold a point.
    pub(crate) tets: Vec<[u32; 4]>,
    /// For each point its place among [`Self::tets`].
    pub(crate) tet: Vec<u32>,
    /// For each point the weights of the four corners.
    pub(crate) weights: Vec<[f64; 4]>,
    /// Points that no tet holds, in rising order: they have the weights of a near
    /// place on the hull.
    pub(crate) outside: Vec<u32>,
    /// How many tets the triangulation has in all.
    pub(crate) n_tets: usize,
}

impl Hanging {
    /// Takes out some points, given in rising order.
    pub(crate) fn remove(&mut self, some: &[u32]) {
        let is_kept = |i: u32| some.binary_search(&i).is_err();
        let mut i = 0u32..;
        self.tet.retain(|_| i.next().is_none_or(is_kept));
        let mut i = 0u32..;
        self.weights.retain(|_| i.next().is_none_or(is_kept));
        self.outside.retain(|&i| is_kept(i));
    }
}

/// The tets of some nodes.
#[derive(Debug)]
pub(crate) struct Graph {
    /// Where its nodes are: those that were given, then what it needed beside.
    pub(crate) places: Vec<Point>,
    pub(crate) tets: Vec<[u32; 4]>,
}

/// Triangulates `nodes`.
///
/// # Errors
/// When they do not span space: fewer than four, all in a line, all in a plane.
pub(crate) fn triangulate(nodes: &[Point], threads: &Threads) -> Result<Triangulation> {
    Triangulation::new(nodes, threads).map_err(|e| {
        e.remedy("mesh motion needs boundary vertices that span space: check that the mesh is not flat")
    })
}

/// Finds the tet of each of `points`, and its weights there. The points are finite.
pub(crate) fn hang(triangulation: &Triangulation, points: &[Point], threads: &Threads) -> Hanging {
    let located = triangulation.locator().locate_all(points, threads);
    let nodes = triangulation.points();
    let found: Vec<(u32, bool)> = located.iter().map(|at| (at.tet().0, at.is_inside())).collect();
    Hanging::new(nodes, triangulation.tets(), &found, points, threads)
}

impl Hanging {
    /// From the tet of each point, and whether it lies inside.
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
