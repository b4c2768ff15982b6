//! The qualities of tets.

use std::ops::Range;

use crate::base::TetId;

/// The recorded quality of a tet that counted as exempt when it was made.
const UNMEASURED: f64 = f64::NAN;

/// What an exempt tet counts as: better than any tet.
pub(super) const EXEMPT: f64 = f64::INFINITY;

/// The range of qualities of new tets that may be exempt when none may: empty.
const NONE_EXEMPT: Range<f64> = f64::INFINITY..f64::INFINITY;

/// The quality of each tet.
#[derive(Clone, Debug)]
pub(super) struct Qualities {
    /// [`UNMEASURED`] for tets that were exempt when they were made.
    measured: Vec<f64>,
    /// Marks exempt tets; empty if there are none.
    is_exempt: Vec<bool>,
    /// New tets of these qualities are exempt if walls force them.
    exempt_range: Range<f64>,
}

/// What is recorded of the quality of a tet.
#[derive(Clone, Copy, Debug)]
pub(super) struct QualityRecord {
    measured: f64,
    is_exempt: bool,
}

impl Qualities {
    /// The qualities of the tets of a mesh; none is exempt.
    pub(super) fn new(measured: Vec<f64>) -> Self {
        Self { measured, is_exempt: Vec::new(), exempt_range: NONE_EXEMPT }
    }

    /// What a tet counts as: [`EXEMPT`] if it is exempt, otherwise its quality; `None` if that has not been
    /// measured.
    #[inline]
    pub(super) fn get(&self, tet: TetId) -> Option<f64> {
        if self.is_exempt(tet) {
            return Some(EXEMPT);
        }
        let quality = self.measured[tet.index()];
        (!quality.is_nan()).then_some(quality)
    }

    /// What is recorded of a tet.
    #[inline]
    pub(super) fn record(&self, tet: TetId) -> QualityRecord {
        QualityRecord { measured: self.measured[tet.index()], is_exempt: self.is_exempt(tet) }
    }

    /// Sets what is recorded of a tet; a slot beyond the last one is added.
    #[inline]
    pub(super) fn restore(&mut self, tet: TetId, QualityRecord { measured, is_exempt }: QualityRecord) {
        match self.measured.get_mut(tet.index()) {
            Some(slot) => *slot = measured,
            None => self.measured.push(measured),
        }
        if is_exempt || !self.is_exempt.is_empty() {
            self.mark(tet, is_exempt);
        }
    }

    /// Sets what a new tet counts as: its quality, or [`EXEMPT`] if it is exempt.
    #[inline]
    pub(super) fn set(&mut self, tet: TetId, counts_as: f64) {
        let is_exempt = counts_as == EXEMPT;
        let measured = if is_exempt { UNMEASURED } else { counts_as };
        self.restore(tet, QualityRecord { measured, is_exempt });
    }

    /// Notes that a tet is removed: its slot is not exempt.
    #[inline]
    pub(super) fn remove(&mut self, tet: TetId) {
        if let Some(is_exempt) = self.is_exempt.get_mut(tet.index()) {
            *is_exempt = false;
        }
    }

    /// Marks a tet as exempt or not.
    fn mark(&mut self, tet: TetId, is_exempt: bool) {
        if self.is_exempt.len() < self.measured.len() {
            self.is_exempt.resize(self.measured.len(), false);
        }
        self.is_exempt[tet.index()] = is_exempt;
    }

    /// Exempts `tets`, and allows new tets of qualities in `range` to be exempt.
    pub(super) fn exempt(&mut self, tets: &[TetId], range: Range<f64>) {
        self.exempt_range = range;
        tets.iter().for_each(|&tet| self.mark(tet, true));
    }

    /// Ends all exemptions: no tet is exempt.
    pub(super) fn end_exemptions(&mut self) {
        self.exempt_range = NONE_EXEMPT;
        self.is_exempt.clear();
    }

    /// Whether any tet may be exempt.
    pub(super) fn exempts(&self) -> bool {
        self.exempt_range != NONE_EXEMPT
    }

    /// Whether a new tet of this quality is exempt if walls force it.
    #[inline]
    pub(super) fn may_be_exempt(&self, quality: f64) -> bool {
        self.exempt_range.contains(&quality)
    }

    /// Whether a tet is exempt.
    #[inline]
    pub(super) fn is_exempt(&self, tet: TetId) -> bool {
        self.is_exempt.get(tet.index()).is_some_and(|&is_exempt| is_exempt)
    }

    /// Drops all tets from the `n`-th.
    pub(super) fn truncate(&mut self, n: usize) {
        self.measured.truncate(n);
        self.is_exempt.truncate(n);
    }
}
