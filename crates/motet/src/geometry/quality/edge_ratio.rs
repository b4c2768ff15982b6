//! The ratio of the longest edge to the shortest.

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;

/// The value for "infinite", as in Verdict (`VERDICT_DBL_MAX`).
pub(super) const LARGEST: f64 = 1e30;

/// The ratio of the longest edge to the shortest: 1 for the regular tet, at most `1e30`, which also stands
/// for a tet with an edge of no length.
pub fn edge_ratio(tet: [Point; 4]) -> f64 {
    let squares = Scaled::new(tet).lengths_squared();
    let longest = squares.iter().copied().fold(0.0, f64::max);
    let shortest = squares.iter().copied().fold(f64::INFINITY, f64::min);
    if shortest > 0.0 { (longest / shortest).sqrt().min(LARGEST) } else { LARGEST }
}
