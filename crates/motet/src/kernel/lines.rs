//! Lines: labelled edges, as walls are labelled facets. A line is divided with its edge and merged with its
//! neighbour, and never lost.
//!
//! Lines change only where the surface may. The lines that a change removes follow from its cavity and its
//! fill; an operation proposes those to insert. Removed and inserted lines together, label by label, must
//! meet every vertex an even number of times: then each label runs from where it began to where it ended,
//! through the same junctions.

use std::collections::BTreeMap;

use hashbrown::HashMap;

use crate::base::VertexId;
use crate::geometry::tet::EDGES;
use crate::mesh::TetMesh;

/// An edge that is a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Identifies the lines of the first mesh on one edge, by the number of that edge; see
    /// [`lines_of_first`](crate::kernel::Complex::lines_of_first).
    pub source: u32,
    /// Whether the line is not one of the first mesh.
    pub is_new: bool,
}

/// All lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    /// The lines by their edges, lower vertex first.
    pub(super) of_edges: HashMap<[VertexId; 2], Line>,
    /// For each edge of the first mesh that was a line, the lines on it, in rising order.
    pub(super) sources: Vec<Vec<u32>>,
    /// For each of [`Self::sources`], a number shared by all sources with the same labels.
    pub(super) labels: Vec<u32>,
    /// Sources whose line was removed or replaced.
    pub(super) removed: Vec<u32>,
}

pub(super) fn rising([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

impl Lines {
    /// The lines of a mesh, and the vertices of lines that are not edges of a tet.
    pub(super) fn of(mesh: &TetMesh) -> (Self, Vec<VertexId>) {
        let mut lines = Self::default();
        if mesh.lines.is_empty() {
            return (lines, Vec::new());
        }
        let mut by_edge: BTreeMap<[VertexId; 2], Vec<u32>> = BTreeMap::new();
        (0..).zip(&mesh.lines).for_each(|(i, &edge)| by_edge.entry(rising(edge)).or_default().push(i));
        let mut has_line = vec![false; mesh.points.len()];
        mesh.lines.iter().flatten().for_each(|v| has_line[v.index()] = true);
        let mut is_loose: HashMap<[VertexId; 2], bool> = by_edge.keys().map(|&edge| (edge, true)).collect();
        for tet in &mesh.tets {
            for edge in EDGES.map(|edge| edge.map(|i| tet[i])) {
                if edge.iter().all(|v| has_line[v.index()]) {
                    is_loose.entry(rising(edge)).and_modify(|loose| *loose = false);
                }
            }
        }
        let (mut numbers, mut loose) = (BTreeMap::new(), Vec::new());
        for (edge, of_edge) in by_edge {
            if is_loose[&edge] {
                loose.extend(edge);
                continue;
            }
            let mut labels: Vec<i32> = of_edge.iter().map(|&i| mesh.line_labels[i as usize]).collect();
            labels.sort_unstable();
            let next = numbers.len() as u32;
            lines.labels.push(*numbers.entry(labels).or_insert(next));
            lines.of_edges.insert(edge, Line { source: lines.sources.len() as u32, is_new: false });
            lines.sources.push(of_edge);
        }
        (lines, loose)
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// Sets or removes the line on an edge; returns the previous one.
    pub(super) fn set(&mut self, edge: [VertexId; 2], line: Option<Line>) -> Option<Line> {
        match line {
            Some(line) => self.of_edges.insert(edge, line),
            None => self.of_edges.remove(&edge),
        }
    }
}
