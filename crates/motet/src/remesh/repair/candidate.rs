//! The best of the changes that were proposed for one bad tet.

use crate::base::TetId;
use crate::kernel::{Change, Complex};
use crate::remesh::report::Operation;
use crate::remesh::surface::Surface;

/// Changes are offered one by one; the best that the kernel accepts stays.
#[derive(Debug, Default)]
pub(super) struct Candidate {
    /// Where the next proposal is written.
    pub(super) proposal: Change,
    best: Change,
    score: Option<Score>,
    operation: Operation,
    came: Vec<TetId>,
    /// A worst quality from which a change may leave more bad tets than it found.
    worth_more_bad: f64,
}

/// A worst quality this many times as high is worth more bad tets: one that is nearly flat ruins a solution, some that are only bad do not.
const MUCH_BETTER: f64 = 10.0;

#[derive(Clone, Copy, Debug)]
struct Score {
    worst: f64,
    n_touched: usize,
}

impl Candidate {
    /// `last_chance` is the quality of the bad tet when all stages are tried: then a worst quality that rises much may cost more bad tets.
    pub(super) fn begin(&mut self, last_chance: Option<f64>) {
        self.score = None;
        self.worth_more_bad =
            last_chance.map_or(f64::INFINITY, |quality| (MUCH_BETTER * quality).max(f64::MIN_POSITIVE));
    }

    /// Whether one has been found whose tets are all at least `target`.
    pub(super) fn reaches(&self, target: f64) -> bool {
        self.score.is_some_and(|s| s.worst >= target)
    }

    /// What the next proposal has to beat, given what the bad tet has.
    pub(super) fn bar(&self, quality: f64, target: f64) -> f64 {
        match self.score {
            Some(score) if score.worst >= target => below(target).max(quality),
            Some(score) => score.worst.max(quality),
            None => quality,
        }
    }

    /// Takes the proposal if it is better than the best so far. Of those that reach the target, the one that touches the fewest tets of the first
    /// mesh is best; of the others the one with the highest worst quality.
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

    /// Makes the best change; which operation it was and the tets that came.
    pub(super) fn commit(&mut self, complex: &mut Complex) -> Option<(Operation, &[TetId])> {
        self.score?;
        let checked = complex.check(&self.best).ok()?;
        complex.commit(checked, &mut self.came);
        Some((self.operation, &self.came))
    }
}

/// Just below: a proposal has to be above its bar, and at the target is good enough.
fn below(target: f64) -> f64 {
    target.next_down()
}
