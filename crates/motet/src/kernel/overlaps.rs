//! Tets that may overlap, as tets of a tangled mesh do: what walks through facets cannot find there.

use crate::base::{TetId, VertexId};
use crate::kernel::tets::FREE;

/// Whether tets may overlap, and what has to be known of them then.
#[derive(Clone, Debug)]
pub(super) struct Overlaps {
    /// How many tets each vertex has: where tets overlap, more than are connected through facets at it.
    n_tets: Vec<u32>,
    /// Tets of the first mesh that are folded over others, in rising order.
    pub(super) folded: Vec<TetId>,
    /// Whether a tet of the first mesh was flat or inverted, or the tets of a vertex were not all connected
    /// through facets: then tets may overlap.
    pub(super) is_tangled: bool,
}

impl Overlaps {
    /// The number of tets of each vertex, counted in `tets`.
    pub(super) fn new(tets: &[[VertexId; 4]], n_vertices: usize, folded: Vec<TetId>) -> Self {
        let mut n_tets = vec![0u32; n_vertices];
        tets.as_flattened().iter().for_each(|v| n_tets[v.index()] += 1);
        Self { n_tets, folded, is_tangled: false }
    }

    /// How many tets a vertex has.
    #[inline]
    pub(super) fn n_tets(&self, vertex: VertexId) -> usize {
        self.n_tets[vertex.index()] as usize
    }

    /// Counts a slot whose vertices change; [`FREE`] stands for no tet.
    pub(super) fn replace(&mut self, before: [VertexId; 4], after: [VertexId; 4]) {
        if before != FREE {
            before.iter().for_each(|v| self.n_tets[v.index()] -= 1);
        }
        if after != FREE {
            after.iter().for_each(|v| self.n_tets[v.index()] += 1);
        }
    }

    /// Sets the number of vertices; new ones have no tet.
    pub(super) fn resize(&mut self, n: usize) {
        self.n_tets.resize(n, 0);
    }
}
