//! The mean ratio in the form used in theory and by most remeshers.

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;

/// `12 (3 V)^(2/3) / sum of squared edge lengths` with the sign of V (Liu and
/// Joe 1994): 1 regular, 0 flat, negative inverted.
pub fn mean_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    from_parts(tet.volume_6(), tet.lengths_squared().iter().sum())
}

/// The mean ratio of a tet with six times this signed volume and this sum of squared edge lengths.
#[inline(always)]
pub(super) fn from_parts(volume_6: f64, sum: f64) -> f64 {
    if volume_6 == 0.0 {
        return 0.0;
    }
    (12.0 * (0.5 * volume_6.abs()).cbrt().powi(2) / sum).copysign(volume_6)
}
