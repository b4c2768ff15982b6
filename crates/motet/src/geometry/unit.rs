//! A unit of length that suits given coordinates: a power of two, so that division by it does not round.

/// The power of two at or below the largest absolute coordinate, and its inverse. In this unit that
/// coordinate lies in [1, 2), unless it is 0, not a number, or close to the ends of the range of `f64`.
#[inline(always)]
pub(crate) fn unit_of<'a>(coordinates: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let mut largest = 0.0;
    for x in coordinates {
        // Compiled to a plain maximum, unlike `f64::max`.
        largest = if x.abs() > largest { x.abs() } else { largest };
    }
    // The exponent alone, and its negative; both must be those of normal numbers.
    let exponent = (largest.to_bits() >> 52).clamp(1, 2045);
    (f64::from_bits(exponent << 52), f64::from_bits((2046 - exponent) << 52))
}
