//! Inserted vertices that lie close to others are removed again where they are not needed.
//!
//! A repair may split an edge that a later one could have done without. If such vertices were left, a mesh
//! that is moved and repaired again and again would grow faster than necessary.

use crate::base::{Result, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::distance;
use crate::ops::collapse;
use crate::remesh::repair::Repair;
use crate::remesh::repair::trial::{Merit, Rules, Trial};
use crate::remesh::report::Operation;

/// A vertex is close to others if its edges are shorter, on average, than this fraction of the edges around
/// it. With 0.85, a mesh that is sheared repeatedly shrinks by a quarter each time; with 0.7 it grows by a
/// twentieth.
const CLOSE: f64 = 0.7;

impl Repair {
    /// Collapses each inserted vertex that is close to others, latest first, where that leaves no bad tet.
    /// Returns whether there were any.
    pub(in crate::remesh) fn thin(&mut self) -> Result<bool> {
        let (mut trial, mut were_any) = (Trial::new(), false);
        let n_slots = self.complex.n_vertex_slots();
        for vertex in (0..n_slots).rev().map(VertexId::new) {
            self.watch.report_and_check(
                "removing superfluous vertices",
                n_slots - vertex.index(),
                n_slots,
            )?;
            if self.complex.is_inserted(vertex)
                && self.complex.is_used(vertex)
                && self.closeness(vertex) < CLOSE
            {
                were_any |= self.collapse_into_best(vertex, &mut trial);
            }
        }
        Ok(were_any)
    }

    /// The mean length of the edges at a vertex, divided by that of the edges around it.
    fn closeness(&mut self, vertex: VertexId) -> f64 {
        self.star.gather(&self.complex, vertex);
        let (mut at, mut round) = ((0.0, 0), (0.0, 0));
        for tet in self.star.tets.iter().map(|&t| self.complex.vertices(t)) {
            for [a, b] in EDGES.map(|edge| edge.map(|i| tet[i])) {
                let sum = if a == vertex || b == vertex { &mut at } else { &mut round };
                *sum = (sum.0 + distance(self.complex.point(a), self.complex.point(b)), sum.1 + 1);
            }
        }
        (at.0 / f64::from(at.1)) / (round.0 / f64::from(round.1))
    }

    /// Collapses a vertex into the neighbour that gives the best tets; returns whether one was allowed.
    fn collapse_into_best(&mut self, vertex: VertexId, trial: &mut Trial) -> bool {
        self.star.gather(&self.complex, vertex);
        let mut ends: Vec<_> =
            self.star.tets.iter().flat_map(|&t| self.complex.vertices(t).map(|v| (v, t))).collect();
        ends.sort_unstable();
        ends.dedup_by_key(|end| end.0);
        for (kept, tet) in ends {
            if kept == vertex || !self.may_collapse(tet, vertex, kept) {
                continue;
            }
            let bar = trial.score().unwrap_or(self.target.next_down());
            if collapse(&self.complex, &self.star.tets, vertex, kept, bar, &mut trial.proposal) {
                trial.offer(Rules::of(&self.complex).near(self.surface.as_ref()), |proposal, _| {
                    Some(Merit { operation: Operation::Collapse, score: proposal.worst(), bar })
                });
            }
        }
        // A vertex stays if its collapse would remove all of its tets.
        if trial.best().is_some_and(|best| best.fill.is_empty()) {
            trial.give_up();
        }
        trial.commit(&mut self.complex, &mut self.operations, None)
    }
}
