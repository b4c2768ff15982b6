//! The qualities of tets: measured when they are first requested, and kept.
//!
//! Threads that share a complex may measure the same tet at the same time; both then store the same bits.

use std::ops::Range;

use crate::base::{LazyNumber, TetId};

/// The quality of a tet that has not been measured.
const UNMEASURED: f64 = f64::NAN;

/// What an exempt tet counts as: better than any tet.
pub(super) const EXEMPT: f64 = f64::INFINITY;

/// The range of qualities of new tets that may be exempt when none may: empty.
const NONE_EXEMPT: Range<f64> = f64::INFINITY..f64::INFINITY;

/// The quality of each tet as far as it has been measured, and approximate ones of the first mesh.
#[derive(Clone, Debug)]
pub(super) struct Qualities {
    /// [`UNMEASURED`] until the quality is first requested.
    known: Vec<LazyNumber>,
    /// Approximate qualities of the tets of the first mesh.
    rough: Vec<f32>,
    /// Marks exempt tets; empty if there are none.
    is_exempt: Vec<bool>,
    /// New tets of these qualities are exempt if walls force them.
    exempt_range: Range<f64>,
}

/// What is recorded of the quality of a tet.
#[derive(Clone, Copy, Debug)]
pub(super) struct QualityRecord {
    /// The quality, [`UNMEASURED`] if it has not been requested.
    known: f64,
    is_exempt: bool,
}

impl Qualities {
    /// No quality of these tets is known, but for the approximate ones.
    pub(super) fn new(rough: Vec<f32>) -> Self {
        Self {
            known: vec![LazyNumber::new(UNMEASURED); rough.len()],
            rough,
            is_exempt: Vec::new(),
            exempt_range: NONE_EXEMPT,
        }
    }

    /// What a tet counts as: [`EXEMPT`] if it is exempt, otherwise its quality, from `measure` if it is not
    /// known yet.
    #[inline]
    pub(super) fn get(&self, tet: TetId, measure: impl FnOnce() -> f64) -> f64 {
        if self.is_exempt(tet) {
            return EXEMPT;
        }
        let known = &self.known[tet.index()];
        let mut quality = known.get();
        if quality.is_nan() {
            quality = measure();
            known.set(quality);
        }
        quality
    }

    /// What is recorded of a tet.
    #[inline]
    pub(super) fn record(&self, tet: TetId) -> QualityRecord {
        QualityRecord { known: self.known[tet.index()].get(), is_exempt: self.is_exempt(tet) }
    }

    /// Sets what is recorded of a tet; a slot beyond the last one is added.
    #[inline]
    pub(super) fn restore(&mut self, tet: TetId, QualityRecord { known, is_exempt }: QualityRecord) {
        match self.known.get_mut(tet.index()) {
            Some(slot) => slot.set(known),
            None => self.known.push(LazyNumber::new(known)),
        }
        if is_exempt || !self.is_exempt.is_empty() {
            self.mark(tet, is_exempt);
        }
    }

    /// Sets what a new tet counts as: its quality, or [`EXEMPT`] if it is exempt.
    #[inline]
    pub(super) fn set(&mut self, tet: TetId, counts_as: f64) {
        let is_exempt = counts_as == EXEMPT;
        let known = if is_exempt { UNMEASURED } else { counts_as };
        self.restore(tet, QualityRecord { known, is_exempt });
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
        if self.is_exempt.len() < self.known.len() {
            self.is_exempt.resize(self.known.len(), false);
        }
        self.is_exempt[tet.index()] = is_exempt;
    }

    /// The approximate quality of a tet of the first mesh.
    #[inline]
    pub(super) fn rough(&self, tet: TetId) -> f64 {
        f64::from(self.rough[tet.index()])
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
        self.known.truncate(n);
        self.is_exempt.truncate(n);
    }
}
