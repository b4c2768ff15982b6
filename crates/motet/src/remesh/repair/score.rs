//! Which of the changes proposed for one bad tet is the best.

use crate::kernel::{Change, Complex};
use crate::remesh::repair::trial::Trial;

/// A worst quality that rises by this factor justifies more bad tets: one that is nearly flat ruins a
/// solution, several that are merely bad do not.
const MUCH_BETTER: f64 = 10.0;

/// What counts of a change for a bad tet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Score {
    worst: f64,
    /// How many tets of the first mesh it touches.
    n_touched: usize,
}

/// The limits for the changes of one bad tet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) target: f64,
    /// The worst quality from which a change may leave more bad tets than it found.
    pub(super) worth_more_bad: f64,
}

impl Score {
    /// The score of a proposal, if it is better than that of the best so far, and does not leave more bad
    /// tets for too little: that would be no progress, even if the worst of them is better.
    pub(super) fn of_better(
        complex: &Complex,
        proposal: &Change,
        best: Option<Self>,
        limits: Limits,
    ) -> Option<Self> {
        let Limits { target, worth_more_bad } = limits;
        let n_touched = proposal.cavity.iter().filter(|&&t| complex.is_original(t)).count();
        let score = Self { worst: proposal.worst(), n_touched };
        let is_better = best.is_none_or(|best| score.beats(best, target))
            && (score.worst >= worth_more_bad || !adds_below(complex, proposal, target));
        is_better.then_some(score)
    }

    /// Among changes that reach the target, the one that touches the fewest tets of the first mesh is best;
    /// among the others, the one with the highest worst quality.
    fn beats(self, best: Self, target: f64) -> bool {
        if best.worst < target {
            return self.worst > best.worst;
        }
        let touches_fewer = self.n_touched < best.n_touched;
        self.worst >= target && (touches_fewer || self.n_touched == best.n_touched && self.worst > best.worst)
    }
}

impl Trial<Score> {
    /// Whether a change was found whose tets all have at least the quality `target`.
    pub(super) fn reaches(&self, target: f64) -> bool {
        self.score().is_some_and(|s| s.worst >= target)
    }

    /// The quality that the next proposal has to exceed, given that of the bad tet.
    pub(super) fn bar(&self, quality: f64, target: f64) -> f64 {
        match self.score() {
            Some(score) if score.worst >= target => below(target).max(quality),
            Some(score) => score.worst.max(quality),
            None => quality,
        }
    }
}

/// The worst quality from which a change may leave more bad tets than it found. `last_chance` is the quality
/// of the bad tet if all stages are tried: then a much better worst quality may cost more bad tets.
pub(super) fn worth_more_bad(last_chance: Option<f64>) -> f64 {
    last_chance.map_or(f64::INFINITY, |quality| (MUCH_BETTER * quality).max(f64::MIN_POSITIVE))
}

/// Whether a change leaves more tets below a quality than it found.
pub(super) fn adds_below(complex: &Complex, change: &Change, quality: f64) -> bool {
    let n_after = change.fill.iter().filter(|tet| tet.quality < quality).count();
    n_after > 0 && n_after > change.cavity.iter().filter(|&&t| complex.quality(t) < quality).count()
}

/// The next value below the target: a proposal has to exceed its bar, and one at the target is good enough.
fn below(target: f64) -> f64 {
    target.next_down()
}
