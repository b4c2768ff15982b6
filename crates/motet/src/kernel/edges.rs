//! Edges that stay: fixed edges and lines, and the check that a change loses none of them.

use crate::base::{TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::kernel::change::{Change, NewLine};
use crate::kernel::check::Reject;
use crate::kernel::complex::Complex;
use crate::kernel::hold::Hold;
use crate::kernel::lines::{Line, rising};

impl Complex {
    /// Forbids changes to remove these edges; their vertices stay where they are.
    pub fn fix_edges(&mut self, edges: impl IntoIterator<Item = [VertexId; 2]>) {
        let edges: Vec<[VertexId; 2]> = edges.into_iter().collect();
        edges.as_flattened().iter().for_each(|&v| self.set_hold(v, Hold::Fixed));
        self.locks.add_edges(&edges);
    }

    /// Whether an edge must stay although it is not on a wall.
    #[inline]
    pub fn is_fixed_edge(&self, a: VertexId, b: VertexId) -> bool {
        self.locks.has_edge(a, b)
    }

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
        !(self.is_fixed_edge(a, b) || self.keeps_surface() && self.line(a, b).is_some())
    }

    /// Constrains the vertices of lines as features do; fixes those of lines that are not edges of a tet.
    pub(super) fn constrain_lines(&mut self, loose: &[VertexId]) {
        for v in self.lines().into_iter().flat_map(|(edge, _)| edge) {
            self.set_hold(v, self.hold(v).max(Hold::Edge));
        }
        loose.iter().for_each(|&v| self.set_hold(v, Hold::Fixed));
    }

    /// Checks that a change removes no edge that must stay; returns the edges of the lines that it removes,
    /// each once.
    pub(super) fn check_edges(&self, change: &Change) -> Result<Vec<[VertexId; 2]>, Reject> {
        let mut removed = Vec::new();
        if self.locks.edges().is_empty() && self.lines.is_empty() {
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
                if self.keeps_surface() || self.is_fixed_edge(edge[0], edge[1]) {
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
