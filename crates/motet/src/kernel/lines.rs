//! Lines: labelled edges, as walls are labelled facets. A line is divided with its edge and merged with its
//! neighbour, and never lost.
//!
//! Lines change only where the surface may. The lines that a change removes follow from its cavity and its
//! fill; an operation proposes those to insert. Removed and inserted lines together, label by label, must
//! meet every vertex an even number of times: then each label runs from where it began to where it ended,
//! through the same junctions.

use std::collections::BTreeMap;

use hashbrown::HashMap;

use crate::base::{TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::kernel::change::{Change, NewLine};
use crate::kernel::check::Reject;
use crate::kernel::complex::{Complex, Hold};
use crate::mesh::TetMesh;

/// An edge that is a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Identifies the lines of the first mesh on one edge, by the number of that edge; see
    /// [`Complex::lines_of_first`].
    pub source: u32,
    /// Whether the line is not one of the first mesh.
    pub is_new: bool,
}

/// All lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    /// The lines by their edges, lower vertex first.
    of_edges: HashMap<[VertexId; 2], Line>,
    /// For each edge of the first mesh that was a line, the lines on it, in rising order.
    pub(super) sources: Vec<Vec<u32>>,
    /// For each of [`Self::sources`], a number shared by all sources with the same labels.
    labels: Vec<u32>,
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

impl Complex {
    /// Whether there are any lines.
    #[inline]
    pub fn has_lines(&self) -> bool {
        !self.lines.is_empty()
    }

    /// The line on an edge, if it is one.
    #[inline]
    pub fn line(&self, a: VertexId, b: VertexId) -> Option<Line> {
        if self.lines.is_empty() {
            return None;
        }
        self.lines.of_edges.get(&rising([a, b])).copied()
    }

    /// A number shared by all lines with the same labels, given the source of a line.
    pub fn line_label(&self, source: u32) -> u32 {
        self.lines.labels[source as usize]
    }

    /// The vertices that lines join to a vertex with the tets `star`, in rising order.
    pub fn line_neighbors(&self, star: &[TetId], vertex: VertexId) -> Vec<VertexId> {
        if self.lines.is_empty() {
            return Vec::new();
        }
        let mut others: Vec<VertexId> = star.iter().flat_map(|&t| self.vertices(t)).collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|&other| self.line(vertex, other).is_some());
        others
    }

    /// All lines with their edges, sorted by vertices.
    pub fn lines(&self) -> Vec<([VertexId; 2], Line)> {
        let mut lines: Vec<_> = self.lines.of_edges.iter().map(|(&edge, &line)| (edge, line)).collect();
        lines.sort_unstable_by_key(|(edge, _)| *edge);
        lines
    }

    /// The lines of the first mesh that a line is, or is part of.
    pub fn lines_of_first(&self, line: Line) -> &[u32] {
        &self.lines.sources[line.source as usize]
    }

    /// Whether no change may remove an edge, except by dividing or merging a line where the surface may
    /// change.
    #[inline]
    pub fn is_kept_edge(&self, a: VertexId, b: VertexId) -> bool {
        self.is_fixed_edge(a, b) || self.line(a, b).is_some()
    }

    /// Whether an edge may be divided: it is not fixed, and not a line if the surface is kept.
    #[inline]
    pub fn may_divide(&self, a: VertexId, b: VertexId) -> bool {
        !(self.is_fixed_edge(a, b) || self.keeps_surface && self.line(a, b).is_some())
    }

    /// Constrains the vertices of lines as features do; fixes those of lines that are not edges of a tet.
    pub(super) fn hold_lines(&mut self, loose: &[VertexId]) {
        for v in self.lines().into_iter().flat_map(|(edge, _)| edge) {
            self.holds[v.index()] = self.holds[v.index()].max(Hold::Edge);
        }
        loose.iter().for_each(|v| self.holds[v.index()] = Hold::Fixed);
    }

    /// Checks that a change removes no edge that must stay; returns the edges of the lines that it removes,
    /// each once.
    pub(super) fn check_edges(&self, change: &Change) -> Result<Vec<[VertexId; 2]>, Reject> {
        let mut removed = Vec::new();
        if self.fixed_edges.is_empty() && self.lines.is_empty() {
            return Ok(removed);
        }
        let is_in_fill = |[a, b]: [VertexId; 2]| {
            change.fill.iter().any(|tet| tet.vertices.contains(&a) && tet.vertices.contains(&b))
        };
        for tet in change.cavity.iter().map(|&t| self.vertices(t)) {
            for edge in EDGES.map(|edge| edge.map(|i| tet[i])) {
                if !self.is_kept_edge(edge[0], edge[1]) || is_in_fill(edge) {
                    continue;
                }
                if self.keeps_surface || self.is_fixed_edge(edge[0], edge[1]) {
                    return Err(Reject::Edge(edge));
                }
                removed.push(rising(edge));
            }
        }
        removed.sort_unstable();
        removed.dedup();
        if let Some(new) = change.lines.iter().find(|new| !is_in_fill(new.vertices)) {
            return Err(Reject::Edge(new.vertices));
        }
        self.check_runs(&removed, &change.lines)?;
        Ok(removed)
    }

    /// Checks that every label still runs from where it began to where it ended: its removed and new lines
    /// meet each vertex an even number of times.
    fn check_runs(&self, removed: &[[VertexId; 2]], new: &[NewLine]) -> Result<(), Reject> {
        let mut ends: Vec<(u32, VertexId)> = Vec::new();
        for &edge in removed {
            let Some(line) = self.line(edge[0], edge[1]) else { continue };
            ends.extend(edge.map(|v| (self.line_label(line.source), v)));
        }
        for (i, line) in new.iter().enumerate() {
            let edge = rising(line.vertices);
            let is_there = self.line(edge[0], edge[1]).is_some() && removed.binary_search(&edge).is_err();
            if is_there || new[..i].iter().any(|other| rising(other.vertices) == edge) {
                return Err(Reject::Edge(edge));
            }
            ends.extend(edge.map(|v| (self.line_label(line.source), v)));
        }
        ends.sort_unstable();
        match ends.chunk_by(|x, y| x == y).find(|same| same.len() % 2 == 1) {
            Some(same) => Err(Reject::Vertex(same[0].1)),
            None => Ok(()),
        }
    }
}
