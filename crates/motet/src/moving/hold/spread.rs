//! Nodes next to one that was stopped are held back with it, so that no edge between them is lost.
//!
//! A node that stops while its neighbour moves on comes nearer to it, or is passed by it. So what stops a
//! node also holds its neighbours back: along an edge, corrections of requested places differ by no more than
//! a fraction of the edge's requested length. Edges are those of the wall's triangles, and of the Delaunay
//! tets between its nodes: otherwise the far side of a body would move on through the side that was stopped.
//! A body that is pressed on gently flattens where it is near; one that is requested to go far through a wall
//! stops as a whole.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::base::{Csr, Point, Threads, VertexId};
use crate::delaunay::Triangulation;
use crate::geometry::vector::{add, distance, norm, scale, sub};

/// Corrections may exceed their limit by this fraction.
const ROUNDING: f64 = 1e-9;

/// The largest number of passes over all nodes.
const PASSES: usize = 16;

/// The nodes of a wall, and which of them are joined by edges.
#[derive(Clone, Debug)]
pub(super) struct Slopes {
    /// All nodes, in rising order, with whether they may be held back.
    nodes: Vec<(VertexId, bool)>,
    /// Neighbours of each node, by index in [`Self::nodes`].
    neighbors: Csr<u32>,
}

impl Slopes {
    /// The edges of a wall at its first position; `free` lists the nodes that may be held back, in rising
    /// order.
    pub(super) fn new(
        triangles: &[[VertexId; 3]],
        free: &[VertexId],
        places: &[Point],
        threads: &Threads,
    ) -> Self {
        let nodes = super::nodes_of(triangles);
        let place = |v: VertexId| nodes.binary_search(&v).unwrap_or_default();
        let mut edges: Vec<(usize, u32)> = Vec::with_capacity(6 * triangles.len());
        triangles.iter().for_each(|t| pairs_of(&t.map(place), &mut edges));
        let points: Vec<Point> = nodes.iter().map(|v| places[v.index()]).collect();
        // Points in one plane have no tets, and no far side.
        if let Ok(delaunay) = Triangulation::new(&points, threads) {
            delaunay.tets().iter().for_each(|t| pairs_of(&t.map(|v| v.index()), &mut edges));
        }
        edges.sort_unstable();
        edges.dedup();
        let neighbors = Csr::from_pairs(nodes.len(), || edges.iter().copied());
        let nodes = nodes.into_iter().map(|v| (v, free.binary_search(&v).is_ok())).collect();
        Self { nodes, neighbors }
    }

    /// Holds nodes back until the corrections along each edge differ by no more than `slope` times its
    /// requested length.
    pub(super) fn limit(&self, at: &mut [Point], wanted: &[Point], slope: f64) {
        let by = |(v, _): &(VertexId, bool)| sub(at[v.index()], wanted[v.index()]);
        let before: Vec<Point> = self.nodes.iter().map(by).collect();
        if before.iter().all(|by| *by == [0.0; 3]) {
            return;
        }
        let mut by = before.clone();
        // Corrections are vectors: what a node takes over from one neighbour may be far from the correction
        // of another.
        let _ = (0..PASSES).any(|_| !self.pass(&mut by, wanted, slope));
        for (((v, _), by), _) in self.nodes.iter().zip(by).zip(before).filter(|((_, by), was)| by != was) {
            at[v.index()] = add(wanted[v.index()], by);
        }
    }

    /// Makes one pass over all nodes, largest correction first; returns whether any correction was raised.
    fn pass(&self, by: &mut [Point], wanted: &[Point], slope: f64) -> bool {
        let all = (0..by.len()).map(|node| Next { size: norm(by[node]), node });
        let mut open: BinaryHeap<Next> = all.filter(|next| next.size > 0.0).collect();
        let mut is_done = vec![false; by.len()];
        let mut is_raised = false;
        while let Some(Next { size, node }) = open.pop() {
            // Its correction was raised after it was queued.
            if is_done[node] || size != norm(by[node]) {
                continue;
            }
            is_done[node] = true;
            for &other in self.neighbors.list(node) {
                let other = other as usize;
                let [p, q] = [node, other].map(|i| wanted[self.nodes[i].0.index()]);
                let (difference, most) = (sub(by[other], by[node]), slope * distance(p, q));
                let size = norm(difference);
                if self.nodes[other].1 && !is_done[other] && size > most * (1.0 + ROUNDING) {
                    by[other] = add(by[node], scale(difference, most / size));
                    open.push(Next { size: norm(by[other]), node: other });
                    is_raised = true;
                }
            }
        }
        is_raised
    }
}

/// All ordered pairs of distinct nodes.
fn pairs_of(nodes: &[usize], pairs: &mut Vec<(usize, u32)>) {
    for &i in nodes {
        pairs.extend(nodes.iter().filter(|j| **j != i).map(|&j| (i, j as u32)));
    }
}

/// An entry of the queue: the largest correction first; among equal ones the first node.
struct Next {
    size: f64,
    node: usize,
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        self.size.total_cmp(&other.size).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Next {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Next {}
