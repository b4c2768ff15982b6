//! What no change may touch: locked tets, fixed walls, fixed edges, and the surface as a whole.

use crate::base::{TetId, VertexId, sorted_ids};
use crate::kernel::link::WallId;

/// What must stay as it is.
#[derive(Clone, Debug)]
pub(super) struct Locks {
    /// Marks tets that no change may touch; empty if there are none.
    tets: Vec<bool>,
    /// Marks walls that no change may remove; empty if there are none.
    walls: Vec<bool>,
    /// Edges that stay although they are not on a wall, lower vertex first, sorted.
    edges: Vec<[VertexId; 2]>,
    /// Whether walls stay as they are, and the vertices on them.
    pub(super) keeps_surface: bool,
}

impl Locks {
    /// The surface and these edges stay.
    pub(super) fn new(edges: &[[VertexId; 2]]) -> Self {
        let mut locks = Self { tets: Vec::new(), walls: Vec::new(), edges: Vec::new(), keeps_surface: true };
        locks.add_edges(edges);
        locks
    }

    /// Locks a tet, one of `n` slots.
    pub(super) fn add_tet(&mut self, tet: TetId, n: usize) {
        if self.tets.is_empty() {
            self.tets = vec![false; n];
        }
        self.tets[tet.index()] = true;
    }

    /// Whether a tet is locked.
    #[inline]
    pub(super) fn has_tet(&self, tet: TetId) -> bool {
        self.tets.get(tet.index()).is_some_and(|&locked| locked)
    }

    /// Fixes a wall, one of `n` slots.
    pub(super) fn add_wall(&mut self, wall: WallId, n: usize) {
        if self.walls.is_empty() {
            self.walls = vec![false; n];
        }
        self.walls[wall.index()] = true;
    }

    /// Whether a wall is fixed.
    #[inline]
    pub(super) fn has_wall(&self, wall: WallId) -> bool {
        self.walls.get(wall.index()).is_some_and(|&fixed| fixed)
    }

    /// Fixes edges.
    pub(super) fn add_edges(&mut self, edges: &[[VertexId; 2]]) {
        self.edges.extend(edges.iter().copied().map(sorted_ids));
        self.edges.sort_unstable();
    }

    /// The fixed edges, lower vertex first, sorted.
    #[inline]
    pub(super) fn edges(&self) -> &[[VertexId; 2]] {
        &self.edges
    }

    /// Whether an edge is fixed.
    #[inline]
    pub(super) fn has_edge(&self, a: VertexId, b: VertexId) -> bool {
        !self.edges.is_empty() && self.edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }
}
