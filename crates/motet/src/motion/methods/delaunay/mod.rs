//! By the graph alone: weighted sums for all vertices, after the points that the graph added have been placed
//! (Liu, Qin, Xia 2006).

mod added_points;

use std::time::Instant;

use crate::base::{Point, Result, Threads, VertexId};
use crate::motion::graph::{BuiltGraph, Embedding, Walls};
use crate::motion::methods::delaunay::added_points::AddedPoints;
use crate::motion::methods::{Follower, Prepare, Prepared, Reference, Scene};
use crate::motion::nodes::Nodes;
use crate::motion::update::{Displacements, WeightTable};

/// The walls that the graph stays within, if any.
#[derive(Debug)]
pub(crate) struct Delaunay {
    walls: Option<Walls>,
}

impl Delaunay {
    /// The method on a mesh: within its walls where the options say so.
    pub(crate) fn new(reference: &mut Reference<'_>) -> Self {
        Self { walls: reference.walls() }
    }

    /// Sets up a follower by the graph.
    ///
    /// # Errors
    /// When the nodes do not span space, walls cross, or an added point has only flat tets.
    pub(crate) fn on_graph(
        &self,
        scene: &Scene<'_>,
        points: &[Point],
        threads: &Threads,
    ) -> Result<Prepared<GraphFollower>> {
        let nodes = scene.nodes.graph_vertices();
        let mut built = BuiltGraph::new(self.walls.as_ref(), &nodes, scene.free, points, threads)?;
        let staying = built.leave_unused(scene.free, scene.is_used);
        let begin = Instant::now();
        let added = AddedPoints::new(&built.graph, &scene.nodes.of_graph)?;
        let n_added = added.as_ref().map_or(0, AddedPoints::len);
        let following = scene.following(&staying);
        let table = weight_table(scene.nodes, &following, &built.embedding, n_added, points.len());
        let mut setup = built.setup(nodes.len());
        setup.seconds.system = begin.elapsed().as_secs_f64();
        Ok(Prepared {
            follower: GraphFollower { table, added },
            staying,
            graph_tets: built.holding_tets(&nodes),
            setup,
        })
    }
}

impl Prepare for Delaunay {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared> {
        self.on_graph(scene, points, threads).map(Prepared::boxed)
    }
}

/// How vertices depend on the nodes of the graph.
#[derive(Debug)]
pub(crate) struct GraphFollower {
    /// The weights of each vertex; the nodes are followed by the points that the graph added.
    table: WeightTable,
    added: Option<AddedPoints>,
}

impl Follower for GraphFollower {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let Some(added) = &self.added else {
            self.table.apply(from, displacements, out, threads);
            return Ok(0);
        };
        let (all, iterations) = added.with_added(displacements, threads)?;
        self.table.apply(from, &all, out, threads);
        Ok(iterations)
    }

    fn weights(&self) -> Option<&WeightTable> {
        Some(&self.table)
    }
}

/// The table for all of `n_points` vertices: nodes follow themselves, and vertices that stay follow the node
/// that never moves.
fn weight_table(
    nodes: &Nodes,
    following: &[VertexId],
    found: &Embedding,
    n_added: usize,
    n_points: usize,
) -> WeightTable {
    let n_nodes = nodes.vertices.len();
    let mut table = WeightTable::fixed((n_nodes + n_added) as u32, n_points);
    let n_given = nodes.of_graph.len();
    let node = |i: u32| {
        let added = || (i as usize - n_given + n_nodes) as u32;
        nodes.of_graph.get(i as usize).copied().unwrap_or_else(added)
    };
    for (node, vertex) in (0..).zip(&nodes.vertices) {
        table.nodes[vertex.index()] = [node; 4];
    }
    for (vertex, (&tet, w)) in following.iter().zip(found.tet.iter().zip(&found.weights)) {
        table.set(*vertex, found.tets[tet as usize].map(node), *w);
    }
    table
}
