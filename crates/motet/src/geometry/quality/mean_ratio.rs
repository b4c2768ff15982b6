//! The mean ratio in the form used in theory and by most remeshers.

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;

/// `12 (3 V)^(2/3) / sum of squared edge lengths` with the sign of V (Liu and
/// Joe 1994): 1 regular, 0 flat, negative inverted.
pub fn mean_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let volume = tet.volume_6() / 6.0;
    let sum: f64 = tet.lengths_squared().iter().sum();
    if volume == 0.0 {
        return 0.0;
    }
    (12.0 * (3.0 * volume.abs()).cbrt().powi(2) / sum).copysign(volume)
}
