//! Equi-angle skew: how far the worst angle is from that of the regular tet.

use std::f64::consts::{FRAC_PI_3, PI};

use crate::base::Point;
use crate::geometry::quality::cotangents::{self, angle, extremes};
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::quality::scaled::Scaled;

/// 0 for the regular tet, 1 for a degenerate one, whichever way it is turned:
/// Verdict's `tet_equiangle_skew`, over the 6 dihedral and the 12 face angles.
///
/// `max of (Dmax - T)/(pi - T), (T - Dmin)/T, (Fmax - pi/3)/(2 pi/3), (pi/3 - Fmin)/(pi/3)`
/// with `T = acos(1/3)`.
pub fn equiangle_skew(tet: [Point; 4]) -> f64 {
    skew(&Scaled::new(tet))
}

pub(super) fn skew(tet: &Scaled) -> f64 {
    let dihedral = of_range(extremes(&cotangents::dihedral(tet)), REGULAR);
    let face = of_range(extremes(cotangents::facets(tet).as_flattened()), FRAC_PI_3);
    dihedral.max(face)
}

/// The skew of angles whose cotangents span this range, with respect to the regular angle.
fn of_range([low, high]: [f64; 2], regular: f64) -> f64 {
    let (largest, smallest) = (angle(low), angle(high));
    ((largest - regular) / (PI - regular)).max((regular - smallest) / regular)
}
