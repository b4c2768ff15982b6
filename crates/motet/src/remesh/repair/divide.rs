//! Tets that no other operation repairs are divided, as long as that leaves fewer of them.

use crate::base::{Result, TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, distance, scale};
use crate::kernel::Shell;
use crate::ops::split_edge;
use crate::remesh::repair::Repair;
use crate::remesh::repair::search::{Search, Tools};
use crate::remesh::repair::trial::{Merit, Rules};
use crate::remesh::report::Operation;

/// How many rounds of splits in a row may end without progress.
const MAX_FAILED_ROUNDS: usize = 5;

/// A round makes progress if the number of bad tets falls to this fraction or below.
const PROGRESS: f64 = 0.95;
/// No more edges are split once the number of tets has grown by this factor.
const MAX_GROWTH: usize = 3;

impl Repair<'_> {
    /// Divides tets that nothing else repairs: splits the longest edge in the neighbourhood of each tet in
    /// `left`, again and again, with repairs in between, as long as that leaves fewer bad tets. Splits that
    /// do not lead to fewer are undone. Meant for flat tets between two sheets of the surface, and for tets
    /// on needles of the surface, which are too long for where they are.
    pub(super) fn divide(&mut self, mut left: Vec<TetId>, rounds: usize) -> Result<Vec<TetId>> {
        let n_bad = |repair: &Self, left: &[TetId]| left.len() + repair.complex.n_exempt();
        let mut n_least = n_bad(self, &left);
        let mut best = (left.clone(), self.complex.mark(), self.operations);
        let (mut n_failed, mut tools) = (0, self.toolbox.take());
        let max_tets = MAX_GROWTH * self.complex.n_tets();
        while !left.is_empty() && n_failed < MAX_FAILED_ROUNDS && self.complex.n_tets() < max_tets {
            let mut bad = Vec::new();
            for &tet in &left {
                if self.is_bad(tet) {
                    self.split_longest(tet, &mut tools);
                }
                bad.append(&mut self.inserted_bad);
            }
            bad.extend(left.iter().copied().filter(|&t| self.is_bad(t)));
            left = self.run(bad, rounds)?;
            n_failed += 1;
            let n = n_bad(self, &left);
            if n < n_least {
                if PROGRESS * (best.0.len() as f64) >= left.len() as f64 {
                    n_failed = 0;
                }
                n_least = n;
                best = (left.clone(), self.complex.mark(), self.operations);
            }
        }
        self.complex.undo(best.1);
        self.operations = best.2;
        self.toolbox.put_back(tools);
        Ok(best.0)
    }

    /// Splits the edge at the end of the longest-edge path from a tet, if every tet stays positive and the
    /// surface allows it, whatever the quality.
    fn split_longest(&mut self, tet: TetId, tools: &mut Tools) {
        Search::new(self, tools).split_longest(tet);
        let trial = &mut tools.first;
        if trial.commit(self) {
            let (complex, target) = (&self.complex, self.target);
            let inserted = trial.inserted().iter().copied();
            self.inserted_bad.extend(inserted.filter(|&t| complex.quality(t) < target));
        }
    }
}

impl Search<'_> {
    /// Searches for a split of the edge at the end of the longest-edge path from a tet: one that is the
    /// longest edge of every tet around it (Rivara 1984 and 1997, *New longest-edge algorithms for the
    /// refinement and/or improvement of unstructured triangulations*).
    fn split_longest(&mut self, mut tet: TetId) {
        loop {
            let (edge, length) = self.longest_edge(tet);
            let next = self.around(tet, edge, |search, shell| {
                let next = shell.tets.iter().copied().find(|&t| search.longest_edge(t).1 > length);
                if next.is_none() {
                    search.split_unjudged(shell, edge);
                }
                next
            });
            match next {
                Some(next) => tet = next,
                None => return,
            }
        }
    }

    fn longest_edge(&self, tet: TetId) -> ([VertexId; 2], f64) {
        let complex = self.complex();
        let vertices = complex.vertices(tet);
        let mut longest = ([vertices[0], vertices[1]], f64::NEG_INFINITY);
        for [a, b] in EDGES.map(|e| e.map(|i| vertices[i])) {
            let length = distance(complex.point(a), complex.point(b));
            if length > longest.1 {
                longest = ([a, b], length);
            }
        }
        longest
    }

    /// Searches for a split of an edge with the tets `shell` around it that leaves every tet positive.
    fn split_unjudged(&mut self, shell: &Shell, edge: [VertexId; 2]) {
        let Repair { complex, surface, .. } = self.repair;
        let [a, b] = edge;
        if !complex.may_divide(a, b) {
            return;
        }
        let hold = self.hold_on(shell, edge);
        let middle = scale(add(complex.point(a), complex.point(b)), 0.5);
        let (bar, trial) = (0.0, &mut self.tools.first);
        if split_edge(complex, shell, edge, (middle, hold), bar, &mut trial.proposal) {
            let rules = Rules::at_commit(complex).in_place(surface.as_ref());
            trial.offer(rules, |_, _| Some(Merit { operation: Operation::SplitEdge, score: (), bar }));
        }
    }
}
