//! What setting up a motion found, and how long it took.

use serde::Serialize;

/// What setting up found, and how long it took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
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
#[non_exhaustive]
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

fn is_zero(n: &usize) -> bool {
    *n == 0
}
