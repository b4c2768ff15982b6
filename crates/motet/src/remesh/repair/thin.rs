//! Inserted vertices that lie close to others are removed again where they are not needed.
//!
//! A repair may split an edge that a later one could have done without. If such vertices were left, a mesh
//! that is moved and repaired again and again would grow faster than necessary.

use crate::base::{Result, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::distance;
use crate::ops::collapse;
use crate::remesh::repair::Repair;
use crate::remesh::repair::search::{Search, Tools};
use crate::remesh::repair::trial::{Merit, Rules};
use crate::remesh::report::Operation;

/// A vertex is close to others if its edges are shorter, on average, than this fraction of the edges around
/// it. With 0.85, a mesh that is sheared repeatedly shrinks by a quarter each time; with 0.7 it grows by a
/// twentieth.
const CLOSE: f64 = 0.7;

impl Repair<'_> {
    /// Collapses each inserted vertex that is close to others, latest first, where that leaves no bad tet.
    /// Returns whether there were any.
    pub(in crate::remesh) fn thin(&mut self) -> Result<bool> {
        let (mut tools, mut were_any) = (self.toolbox.take(), false);
        let n_slots = self.complex.n_vertex_slots();
        for vertex in (0..n_slots).rev().map(VertexId::new) {
            let n_done = n_slots - vertex.index();
            self.threads.watch().report_and_check("removing superfluous vertices", n_done, n_slots)?;
            if !self.complex.is_inserted(vertex) || !self.complex.is_used(vertex) {
                continue;
            }
            let mut search = Search::new(self, &mut tools);
            if search.closeness(vertex) < CLOSE {
                search.collapse_into_best(vertex);
                were_any |= tools.best.commit(self);
            }
        }
        self.toolbox.put_back(tools);
        Ok(were_any)
    }
}

impl Search<'_> {
    /// The mean length of the edges at a vertex, divided by that of the edges around it.
    fn closeness(&mut self, vertex: VertexId) -> f64 {
        let complex = self.complex();
        self.gather(vertex);
        let (mut at, mut round) = ((0.0, 0), (0.0, 0));
        for tet in self.tools.star.tets.iter().map(|&t| complex.vertices(t)) {
            for [a, b] in EDGES.map(|edge| edge.map(|i| tet[i])) {
                let sum = if a == vertex || b == vertex { &mut at } else { &mut round };
                *sum = (sum.0 + distance(complex.point(a), complex.point(b)), sum.1 + 1);
            }
        }
        (at.0 / f64::from(at.1)) / (round.0 / f64::from(round.1))
    }

    /// Searches for the neighbour into which to collapse a vertex so that the tets are best.
    fn collapse_into_best(&mut self, vertex: VertexId) {
        let repair = self.repair;
        let complex = &repair.complex;
        self.gather(vertex);
        let star = &self.tools.star.tets;
        let mut ends: Vec<_> = star.iter().flat_map(|&t| complex.vertices(t).map(|v| (v, t))).collect();
        ends.sort_unstable();
        ends.dedup_by_key(|end| end.0);
        for (kept, tet) in ends {
            if kept == vertex || !self.may_collapse(tet, vertex, kept) {
                continue;
            }
            let Tools { star, best, .. } = &mut *self.tools;
            let bar = best.score().unwrap_or(repair.target.next_down());
            if collapse(complex, &star.tets, vertex, kept, bar, &mut best.proposal) {
                best.offer(Rules::of(complex).near(repair.surface.as_ref()), |proposal, _| {
                    Some(Merit { operation: Operation::Collapse, score: proposal.worst(), bar })
                });
            }
        }
        // A vertex stays if its collapse would remove all of its tets.
        if self.tools.best.best().is_some_and(|best| best.fill.is_empty()) {
            self.tools.best.give_up();
        }
    }
}
