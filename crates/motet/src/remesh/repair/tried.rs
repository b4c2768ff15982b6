//! Operations that failed and whose surroundings have not changed since: they would fail again.

use crate::base::{Changes, TetId, VertexId, entry, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::kernel::Complex;

/// The bad tets whose repair failed.
///
/// If the triangles of a surface make thousands of tets bad for good, rounds that change a few others cost
/// next to nothing with this record. It ignores that a cavity may reach beyond the tets at the vertices.
#[derive(Debug)]
pub(super) struct Tried {
    /// The target when the record began; failures for any other target are not recorded.
    target: f64,
    /// When the repair of each tet failed; 0: never.
    failed: Vec<u32>,
}

impl Tried {
    /// An empty record of failed repairs for one target.
    pub(super) fn of(target: f64) -> Self {
        Self { target, failed: Vec::new() }
    }

    /// A record that stores nothing.
    pub(super) fn nothing() -> Self {
        Self::of(f64::NAN)
    }

    /// Whether the repair of a tet failed, and nothing at its vertices has changed since.
    pub(super) fn knows(&self, changes: &Changes, complex: &Complex, tet: TetId, target: f64) -> bool {
        let Some(&time) = self.failed.get(tet.index()) else { return false };
        target == self.target && complex.vertices(tet).into_iter().all(|v| changes.none_since(v, time))
    }

    /// Records that the repair of a tet failed.
    pub(super) fn note_failure(&mut self, changes: &Changes, tet: TetId, target: f64) {
        if target == self.target {
            *entry(&mut self.failed, tet.index()) = changes.now();
        }
    }
}

/// The edges, facets and vertices at which no change improved the tets: about five tets share an edge, twenty
/// a vertex, and each would try it again.
#[derive(Debug, Default)]
pub(super) struct Settled {
    /// When the edges, then the facets, of each tet failed; 0: never.
    of_tet: Vec<[u32; 10]>,
    of_vertex: Vec<u32>,
}

impl Settled {
    /// Whether an edge of a tet, given by its index in [`EDGES`], failed, and no tet that has it has changed
    /// since.
    pub(super) fn has_edge(&self, changes: &Changes, complex: &Complex, tet: TetId, edge: usize) -> bool {
        let time = self.time(tet, edge);
        let vertices = complex.vertices(tet);
        EDGES[edge].into_iter().any(|i| changes.none_since(vertices[i], time))
    }

    /// Whether a facet of a tet failed, and no tet at the vertices has changed since.
    pub(super) fn has_facet(&self, changes: &Changes, complex: &Complex, tet: TetId, facet: usize) -> bool {
        let time = self.time(tet, EDGES.len() + facet);
        complex.vertices(tet).into_iter().all(|v| changes.none_since(v, time))
    }

    /// Whether a vertex could not be moved, and none of its tets has changed since.
    pub(super) fn has_vertex(&self, changes: &Changes, vertex: VertexId) -> bool {
        let time = self.of_vertex.get(vertex.index()).copied().unwrap_or(0);
        changes.none_since(vertex, time)
    }

    /// Records that the removal of an edge of these tets failed.
    pub(super) fn settle_edge(
        &mut self,
        changes: &Changes,
        complex: &Complex,
        tets: &[TetId],
        ends: [VertexId; 2],
    ) {
        for &tet in tets {
            let places = sorted_ids(ends.map(|v| complex.place(tet, v)));
            if let Some(edge) = EDGES.iter().position(|edge| *edge == places) {
                entry(&mut self.of_tet, tet.index())[edge] = changes.now();
            }
        }
    }

    /// Records that the removal of a facet failed.
    pub(super) fn settle_facet(&mut self, changes: &Changes, tet: TetId, facet: usize) {
        entry(&mut self.of_tet, tet.index())[EDGES.len() + facet] = changes.now();
    }

    /// Records that a vertex could not be moved.
    pub(super) fn settle_vertex(&mut self, changes: &Changes, vertex: VertexId) {
        *entry(&mut self.of_vertex, vertex.index()) = changes.now();
    }

    fn time(&self, tet: TetId, place: usize) -> u32 {
        self.of_tet.get(tet.index()).map_or(0, |times| times[place])
    }
}
