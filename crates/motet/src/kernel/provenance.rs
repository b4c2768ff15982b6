//! What has changed since the first mesh: which tets, vertices and triangles are no longer what they were.

use crate::base::{TetId, VertexId};

/// What of a complex is still as in the first mesh.
#[derive(Clone, Debug)]
pub(super) struct Provenance {
    /// Whether a tet is not one of the first mesh, or has a vertex that moved.
    is_new: Vec<bool>,
    /// What became of each vertex.
    vertices: Vec<Origin>,
    /// Triangles of the first mesh that are no longer walls.
    removed_triangles: Vec<u32>,
    /// Whether most tets of the first mesh are numbered with the opposite orientation.
    pub(super) mostly_reversed: bool,
}

/// Where a vertex came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// The vertex is one of the first mesh, where it was.
    First,
    /// The vertex is one of the first mesh, and has moved.
    Moved,
    /// The vertex is not one of the first mesh.
    Inserted,
}

impl Provenance {
    /// Nothing has changed yet.
    pub(super) fn new(n_tets: usize, n_vertices: usize, mostly_reversed: bool) -> Self {
        Self {
            is_new: vec![false; n_tets],
            vertices: vec![Origin::First; n_vertices],
            removed_triangles: Vec::new(),
            mostly_reversed,
        }
    }

    /// Whether a tet is not one of the first mesh, or has a vertex that moved.
    #[inline]
    pub(super) fn is_new(&self, tet: TetId) -> bool {
        self.is_new[tet.index()]
    }

    /// Notes whether a tet is new; a slot beyond the last one is added.
    #[inline]
    pub(super) fn set_new(&mut self, tet: TetId, is_new: bool) {
        match self.is_new.get_mut(tet.index()) {
            Some(noted) => *noted = is_new,
            None => self.is_new.push(is_new),
        }
    }

    /// Where a vertex came from.
    #[inline]
    pub(super) fn origin(&self, vertex: VertexId) -> Origin {
        self.vertices[vertex.index()]
    }

    /// Notes where a vertex came from; a slot beyond the last one is added.
    #[inline]
    pub(super) fn set_origin(&mut self, vertex: VertexId, origin: Origin) {
        match self.vertices.get_mut(vertex.index()) {
            Some(noted) => *noted = origin,
            None => self.vertices.push(origin),
        }
    }

    /// Notes that a vertex has moved.
    #[inline]
    pub(super) fn set_moved(&mut self, vertex: VertexId) {
        let origin = &mut self.vertices[vertex.index()];
        if *origin == Origin::First {
            *origin = Origin::Moved;
        }
    }

    /// Triangles of the first mesh that are no longer walls.
    pub(super) fn removed_triangles(&self) -> &[u32] {
        &self.removed_triangles
    }

    /// Notes that a triangle of the first mesh is no longer a wall.
    pub(super) fn remove_triangle(&mut self, triangle: u32) {
        self.removed_triangles.push(triangle);
    }

    /// Undoes the last [`Self::remove_triangle`].
    pub(super) fn restore_triangle(&mut self) {
        self.removed_triangles.pop();
    }

    /// Drops all tets from the `n`-th.
    pub(super) fn truncate_tets(&mut self, n: usize) {
        self.is_new.truncate(n);
    }

    /// Drops all vertices from the `n`-th.
    pub(super) fn truncate_vertices(&mut self, n: usize) {
        self.vertices.truncate(n);
    }
}
