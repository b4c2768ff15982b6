//! Equi-angle skew: how far the worst angle is from that of the regular tet.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, PI};

use crate::base::Point;
use crate::geometry::quality::cotangents::{Extremes, Parts, angle};
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

#[inline(always)]
pub(super) fn skew(tet: &Scaled) -> f64 {
    let parts = Parts::of(tet);
    let [a, b] = terms(parts.dihedral_extremes(), REGULAR);
    let [c, d] = terms(parts.facet_extremes(), FRAC_PI_3);
    let terms = [a, b, c, d];
    // Exact angles take most of the time, and one of the four decides.
    let mut nearly = [0.0; 4];
    let mut largest = 0.0;
    for i in 0..4 {
        nearly[i] = terms[i].skew(rough_angle);
        largest = if nearly[i] > largest { nearly[i] } else { largest };
    }
    let mut skew = 0.0f64;
    for i in 0..4 {
        if nearly[i] >= largest - 2.0 * ROUGHNESS {
            skew = skew.max(terms[i].skew(angle));
        }
    }
    skew
}

/// How far an extreme angle is from the regular one, as a part of what lies between that and the limit.
#[derive(Clone, Copy)]
struct Term {
    cotangent: f64,
    regular: f64,
    limit: f64,
}

impl Term {
    #[inline(always)]
    fn skew(self, angle: impl Fn(f64) -> f64) -> f64 {
        (angle(self.cotangent) - self.regular) / (self.limit - self.regular)
    }
}

#[inline(always)]
fn terms(extremes: Extremes, regular: f64) -> [Term; 2] {
    [
        Term { cotangent: extremes.low, regular, limit: PI },
        Term { cotangent: extremes.high, regular, limit: 0.0 },
    ]
}

/// More than the error of [`rough_angle`], 0.004, makes in a skew.
const ROUGHNESS: f64 = 0.005;

/// The angle with this cotangent to 0.004: `atan x` is about
/// `x (pi / 4 + 0.273 (1 - |x|))` in [-1, 1] (Rajan, Wang, Inkol, Joyal 2006).
#[inline(always)]
fn rough_angle(cotangent: f64) -> f64 {
    let arc = |x: f64| x * (FRAC_PI_4 + 0.273 * (1.0 - x.abs()));
    let outside = cotangent.abs() > 1.0;
    let arc = arc(if outside { 1.0 / cotangent } else { cotangent });
    let of_negative = if cotangent < 0.0 { PI } else { 0.0 };
    if outside { of_negative + arc } else { FRAC_PI_2 - arc }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_angles_are_as_good_as_they_are_said_to_be() {
        for i in 0..=100_000 {
            let exact = PI * f64::from(i) / 100_000.0;
            assert!((rough_angle(exact.cos() / exact.sin()) - exact).abs() < 0.004, "{exact}");
        }
        const { assert!(0.004 / FRAC_PI_3 < ROUGHNESS) }
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY].map(rough_angle), [0.0, PI]);
    }
}
