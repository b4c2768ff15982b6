//! The qualities of tets: measured when they are first requested, and kept.
//!
//! Threads that share a complex may measure the same tet at the same time; both then store the same bits.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::base::TetId;

/// The quality of a tet that has not been measured.
const UNMEASURED: f64 = f64::NAN;

/// The quality stored for an exempt tet: above that of any tet.
pub(super) const EXEMPT: f64 = f64::INFINITY;

/// The range of qualities of new tets that may be exempt when none may: empty.
const NONE_EXEMPT: Range<f64> = f64::INFINITY..f64::INFINITY;

/// The quality of each tet as far as it has been measured, and approximate ones of the first mesh.
#[derive(Clone, Debug)]
pub(super) struct Qualities {
    /// [`UNMEASURED`] until the quality is first requested.
    known: Vec<Kept>,
    /// Approximate qualities of the tets of the first mesh.
    rough: Vec<f32>,
    /// New tets of these qualities are exempt if walls force them.
    exempt_range: Range<f64>,
}

/// A number that threads may set while others read it.
#[derive(Debug)]
struct Kept(AtomicU64);

impl Kept {
    fn new(value: f64) -> Self {
        Self(AtomicU64::new(value.to_bits()))
    }

    #[inline]
    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Relaxed))
    }

    #[inline]
    fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Relaxed);
    }
}

impl Clone for Kept {
    fn clone(&self) -> Self {
        Self::new(self.get())
    }
}

impl Qualities {
    /// No quality of these tets is known, but for the approximate ones.
    pub(super) fn new(rough: Vec<f32>) -> Self {
        Self { known: vec![Kept::new(UNMEASURED); rough.len()], rough, exempt_range: NONE_EXEMPT }
    }

    /// The quality of a tet, from `measure` if it is not known yet.
    #[inline]
    pub(super) fn get(&self, tet: TetId, measure: impl FnOnce() -> f64) -> f64 {
        let known = &self.known[tet.index()];
        let mut quality = known.get();
        if quality.is_nan() {
            quality = measure();
            known.set(quality);
        }
        quality
    }

    /// The quality of a tet as far as it is known; NaN otherwise.
    #[inline]
    pub(super) fn known(&self, tet: TetId) -> f64 {
        self.known[tet.index()].get()
    }

    /// Sets the quality of a tet, or NaN if it is not known; a slot beyond the last one is added.
    #[inline]
    pub(super) fn set(&mut self, tet: TetId, quality: f64) {
        match self.known.get_mut(tet.index()) {
            Some(known) => known.set(quality),
            None => self.known.push(Kept::new(quality)),
        }
    }

    /// The approximate quality of a tet of the first mesh.
    #[inline]
    pub(super) fn rough(&self, tet: TetId) -> f64 {
        f64::from(self.rough[tet.index()])
    }

    /// Exempts `tets`, and allows new tets of qualities in `range` to be exempt.
    pub(super) fn exempt(&mut self, tets: &[TetId], range: Range<f64>) {
        self.exempt_range = range;
        tets.iter().for_each(|&tet| self.set(tet, EXEMPT));
    }

    /// Ends all exemptions: no tet is exempt.
    pub(super) fn end_exemptions(&mut self) {
        self.exempt_range = NONE_EXEMPT;
        let marked = self.known.iter_mut().filter(|quality| quality.get() == EXEMPT);
        marked.for_each(|quality| quality.set(UNMEASURED));
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
        self.known(tet) == EXEMPT
    }

    /// Drops all tets from the `n`-th.
    pub(super) fn truncate(&mut self, n: usize) {
        self.known.truncate(n);
    }
}
