//! Lines that a new surface keeps, by their edges.

use hashbrown::HashMap;

use crate::base::{Point, VertexId, sorted_ids};

/// An edge of a line.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// The vertices of the given line between the ends of the edge.
    pub(super) places: Vec<Point>,
    /// Whether the line is there for the angle of its triangles alone: neither a border of labels nor a rim.
    pub(super) is_crease: bool,
}

/// Edges of lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    edges: HashMap<[VertexId; 2], Line>,
}

impl Lines {
    pub(super) fn insert(&mut self, edge: [VertexId; 2], line: Line) {
        self.edges.insert(sorted_ids(edge), line);
    }

    pub(super) fn get(&self, edge: [VertexId; 2]) -> Option<&Line> {
        self.edges.get(&sorted_ids(edge))
    }

    pub(super) fn remove(&mut self, edge: [VertexId; 2]) -> Option<Line> {
        self.edges.remove(&sorted_ids(edge))
    }
}
