//! The best of the changes proposed for one bad tet.

use crate::base::TetId;
use crate::kernel::{Change, Complex};
use crate::remesh::report::Operation;
use crate::remesh::surface::Surface;

/// Keeps the best of the changes that are offered and that the kernel accepts.
#[derive(Debug, Default)]
pub(super) struct Candidate {
    /// Buffer for the next proposal.
    pub(super) proposal: Change,
    best: Change,
    score: Option<Score>,
    operation: Operation,
    inserted: Vec<TetId>,
    /// The worst quality from which a change may leave more bad tets than it found.
    worth_more_bad: f64,
}

/// A worst quality that rises by this factor justifies more bad tets: one that is nearly flat ruins a
/// solution, several that are merely bad do not.
const MUCH_BETTER: f64 = 10.0;

#[derive(Clone, Copy, Debug)]
struct Score {
    worst: f64,
    n_touched: usize,
}

impl Candidate {
    /// Starts a search. `last_chance` is the quality of the bad tet if all stages are tried: then a much
    /// better worst quality may cost more bad tets.
    pub(super) fn begin(&mut self, last_chance: Option<f64>) {
        self.score = None;
        self.worth_more_bad =
            last_chance.map_or(f64::INFINITY, |quality| (MUCH_BETTER * quality).max(f64::MIN_POSITIVE));
    }

    /// Whether a change was found whose tets all have at least the quality `target`.
    pub(super) fn reaches(&self, target: f64) -> bool {
        self.score.is_some_and(|s| s.worst >= target)
    }

    /// The quality that the next proposal has to exceed, given that of the bad tet.
    pub(super) fn bar(&self, quality: f64, target: f64) -> f64 {
        match self.score {
            Some(score) if score.worst >= target => below(target).max(quality),
            Some(score) => score.worst.max(quality),
            None => quality,
        }
    }

    /// Takes the proposal if it is better than the best so far. Among those that reach the target, the one
    /// that touches the fewest tets of the first mesh is best; among the others, the one with the highest
    /// worst quality.
    pub(super) fn offer(
        &mut self,
        complex: &Complex,
        surface: Option<&Surface>,
        operation: Operation,
        target: f64,
    ) {
        let worst = self.proposal.worst();
        let n_touched = self.proposal.cavity.iter().filter(|&&t| complex.is_original(t)).count();
        let is_better = match self.score {
            None => true,
            Some(s) if s.worst >= target => {
                worst >= target && (n_touched < s.n_touched || n_touched == s.n_touched && worst > s.worst)
            }
            Some(s) => worst > s.worst,
        };
        let is_bad = |quality: f64| quality < target;
        // More bad tets in place of fewer are no progress, even if the worst of them is better.
        let n_bad = self.proposal.fill.iter().filter(|tet| is_bad(tet.quality)).count();
        let n_bad_before = || self.proposal.cavity.iter().filter(|&&t| is_bad(complex.quality(t))).count();
        let is_better = is_better && (n_bad == 0 || worst >= self.worth_more_bad || n_bad <= n_bad_before());
        if is_better
            && surface.is_none_or(|s| s.accepts(complex, &self.proposal))
            && complex.check(&self.proposal).is_ok()
        {
            std::mem::swap(&mut self.proposal, &mut self.best);
            self.score = Some(Score { worst, n_touched });
            self.operation = operation;
        }
    }

    /// Commits the best change; returns its operation and the inserted tets.
    pub(super) fn commit(&mut self, complex: &mut Complex) -> Option<(Operation, &[TetId])> {
        self.score?;
        let checked = complex.check(&self.best).ok()?;
        complex.commit(checked, &mut self.inserted);
        Some((self.operation, &self.inserted))
    }
}

/// The next value below the target: a proposal has to exceed its bar, and one at the target is good enough.
fn below(target: f64) -> f64 {
    target.next_down()
}
