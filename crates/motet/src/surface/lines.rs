//! Lines that a new surface keeps, by their edges.

use hashbrown::{HashMap, HashSet};

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
#[derive(Clone, Debug)]
pub(super) struct Lines {
    edges: HashMap<[VertexId; 2], Line>,
    /// How many vertices were given; the others are new.
    n_given: usize,
    /// Given vertices that have moved.
    is_off: HashSet<VertexId>,
}

impl Lines {
    /// No lines, between so many given vertices.
    pub(super) fn new(n_given: usize) -> Self {
        Self { edges: HashMap::new(), n_given, is_off: HashSet::new() }
    }

    pub(super) fn insert(&mut self, edge: [VertexId; 2], line: Line) {
        self.edges.insert(sorted_ids(edge), line);
    }

    pub(super) fn get(&self, edge: [VertexId; 2]) -> Option<&Line> {
        self.edges.get(&sorted_ids(edge))
    }

    pub(super) fn remove(&mut self, edge: [VertexId; 2]) -> Option<Line> {
        self.edges.remove(&sorted_ids(edge))
    }

    /// Whether a vertex is one of the given line, in its place.
    pub(super) fn is_on(&self, v: VertexId) -> bool {
        v.index() < self.n_given && !self.is_off.contains(&v)
    }

    /// A vertex has moved.
    pub(super) fn set_off(&mut self, v: VertexId) {
        self.is_off.insert(v);
    }
}
