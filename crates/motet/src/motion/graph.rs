//! The graph: the Delaunay triangulation of the nodes, and where each other vertex hangs in it.

use crate::base::{Point, Result, TetId, Threads};
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
    let corners = |tet: TetId| triangulation.tets()[tet.index()].map(|v| nodes[v.index()]);
    let weights = threads.map(points.len(), |i| weights(points[i], corners(located[i].tet())));
    let mut number = vec![0; triangulation.tets().len()];
    located.iter().for_each(|at| number[at.tet().index()] = 1);
    let mut tets = Vec::new();
    for (tet, number) in triangulation.tets().iter().zip(&mut number).filter(|(_, number)| **number == 1) {
        *number = tets.len() as u32;
        tets.push(tet.map(|v| v.0));
    }
    Hanging {
        tet: located.iter().map(|at| number[at.tet().index()]).collect(),
        outside: (0..).zip(&located).filter(|(_, at)| !at.is_inside()).map(|(i, _)| i).collect(),
        n_tets: triangulation.tets().len(),
        tets,
        weights,
    }
}
