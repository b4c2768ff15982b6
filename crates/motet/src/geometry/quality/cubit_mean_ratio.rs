//! The mean ratio as Cubit and Verdict define it.

use std::f64::consts::SQRT_2;

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;

/// `6 sqrt(2) V / (mean squared edge length)^(3/2)`, Verdict's
/// `tet_mean_ratio`: the 3/2 power of [`mean_ratio`](super::mean_ratio), with
/// the same sign; 1 regular, 0 flat, negative inverted.
pub fn cubit_mean_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let volume = tet.volume_6() / 6.0;
    let mean = tet.lengths_squared().iter().sum::<f64>() / 6.0;
    if volume == 0.0 {
        return 0.0;
    }
    6.0 * SQRT_2 * volume / (mean * mean.sqrt())
}
