//! Numbers that are computed when they are first needed, by whichever thread needs them.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A number that threads may set while others read it. All that set it at the same time must set the same
/// bits.
#[derive(Debug)]
pub(crate) struct LazyNumber(AtomicU64);

impl LazyNumber {
    pub(crate) fn new(value: f64) -> Self {
        Self(AtomicU64::new(value.to_bits()))
    }

    #[inline]
    pub(crate) fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Relaxed))
    }

    #[inline]
    pub(crate) fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Relaxed);
    }
}

impl Clone for LazyNumber {
    fn clone(&self) -> Self {
        Self::new(self.get())
    }
}
