//! EAS, the equi-angle quality: the measure by which motet judges tets.

use crate::base::Point;
use crate::geometry::quality::equiangle_skew::skew;
use crate::geometry::quality::scaled::Scaled;

/// A tet with this EAS or more is positive by exact signs. Its angles and those of its facets exceed 1e-3, so
/// six times its volume exceeds 1e-9 times the product of three edges, whose rounding error is about 1e-15.
pub const POSITIVE_EAS: f64 = 1e-3;

/// The highest EAS of a tet with a facet that has an angle of this many degrees.
pub fn highest_eas(degrees: f64) -> f64 {
    if degrees < 60.0 { degrees / 60.0 } else { (180.0 - degrees) / 120.0 }
}

/// `sign(volume) (1 - skew)` with [`equiangle_skew`](super::equiangle_skew):
/// 1 regular, 0 degenerate, negative inverted. A tet is *bad* below 0.2.
pub fn eas(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let volume_6 = tet.volume_6();
    if volume_6 == 0.0 {
        return 0.0;
    }
    (1.0 - skew(&tet, volume_6)).copysign(volume_6)
}
