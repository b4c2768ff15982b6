//! Pseudorandom numbers.

use motet::base::Point;

/// An endless stream of numbers in [0, 1), by Marsaglia's xorshift; the seed is any number but 0.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A random point in the unit cube.
    pub(crate) fn point(&mut self) -> Point {
        [self.next(), self.next(), self.next()]
    }
}
