//! A unit of length that fits some coordinates: a power of two, so that dividing by it does not round.

/// The power of two below the largest coordinate, and its inverse. In this unit the largest lies in [1, 2), unless it is 0, not a
/// number, or next to the ends of the range of `f64`.
#[inline(always)]
pub(crate) fn unit_of<'a>(coordinates: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let mut largest = 0.0;
    for x in coordinates {
        // Compiled to a plain maximum, other than `f64::max`.
        largest = if x.abs() > largest { x.abs() } else { largest };
    }
    // The exponent alone, and its negative. Both have to be normal numbers.
    let exponent = (largest.to_bits() >> 52).clamp(1, 2045);
    (f64::from_bits(exponent << 52), f64::from_bits((2046 - exponent) << 52))
}
