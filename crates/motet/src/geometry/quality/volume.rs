//! The signed volume.

use crate::base::Point;
use crate::geometry::quality::scaled::{Scaled, power_of_two};

/// The signed volume, positive for `(b - a) x (c - a) . (d - a) > 0`. Volumes beyond the largest number are
/// clamped to it.
pub fn volume(tet: [Point; 4]) -> f64 {
    let scaled = Scaled::new(tet);
    let volume = scaled.volume_6() / 6.0;
    if scaled.exponent == 0 {
        return volume;
    }
    // One factor at a time: their product may overflow where the result does not.
    let unit = power_of_two(-scaled.exponent);
    (0..3).fold(volume, |v, _| v * unit).clamp(-f64::MAX, f64::MAX)
}
