//! Angles from their cotangents, four at a time, each accurate to the last bits.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use crate::base::four::FourLanes;

/// `atan t / t - 1` is `t^2` times this polynomial in `t^2`, lowest power first, within 1.3e-18 for
/// `|t| <= tan(pi / 8)`: the minimax polynomial, by the exchange algorithm of Remez (1934) in 50 digits.
const ARCTANGENT: [f64; 11] = [
    -0.333_333_333_333_332,
    0.199_999_999_999_540_82,
    -0.142_857_142_802_485_27,
    0.111_111_107_861_383_08,
    -0.090_908_978_364_557_52,
    0.076_920_616_371_478_84,
    -0.066_631_203_835_019_11,
    0.058_480_089_093_668_13,
    -0.050_398_454_677_094_806,
    0.038_078_319_638_034_54,
    -0.017_922_277_711_718_365,
];

/// The angles in [0, pi] with these cotangents, which may be infinite: within two units in the last place of
/// the angle, or of the angle to pi where that is smaller.
///
/// With `s` the size of the cotangent, the acute angle is `atan(1 / s)`, `pi / 4 - atan((s - 1) / (s + 1))`
/// or `pi / 2 - atan s`, whichever needs the arctangent of the smallest number (Hart et al. 1968, chapter 6).
#[inline(always)]
pub(super) fn angles<F: FourLanes>(machine: F::Machine, cotangents: F) -> F {
    let (zero, one) = (F::splat(machine, 0.0), F::splat(machine, 1.0));
    let size = cotangents.abs();
    let is_large = size - F::splat(machine, 1.0 + SQRT_2);
    let is_middle = size - F::splat(machine, SQRT_2 - 1.0);
    let numerator = is_large.select_positive(zero - one, is_middle.select_positive(size - one, size));
    let denominator = is_large.select_positive(size, is_middle.select_positive(size + one, one));
    let start = is_large.select_positive(
        zero,
        is_middle.select_positive(F::splat(machine, FRAC_PI_4), F::splat(machine, FRAC_PI_2)),
    );
    let t = numerator / denominator;
    let square = t * t;
    let mut series = F::splat(machine, ARCTANGENT[ARCTANGENT.len() - 1]);
    for coefficient in ARCTANGENT[..ARCTANGENT.len() - 1].iter().rev() {
        series = series.mul_add(square, F::splat(machine, *coefficient));
    }
    let acute = start - (t * square).mul_add(series, t);
    (zero - cotangents).select_positive(F::splat(machine, PI) - acute, acute)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::four::Plain;
    use crate::geometry::quality::cotangents::angle;

    fn found(cotangent: f64) -> f64 {
        let all = angles::<Plain>((), Plain::splat((), cotangent)).stored();
        assert!(all.iter().all(|x| x.to_bits() == all[0].to_bits()));
        all[0]
    }

    #[test]
    fn angles_are_those_of_the_standard_library() {
        let mut cotangents: Vec<f64> = (1..200_000).map(|i| f64::from(i) * 1e-4).collect();
        cotangents.extend((-300..300).map(|e| 10f64.powi(e)));
        for limit in [SQRT_2 - 1.0, 1.0, SQRT_2 + 1.0] {
            cotangents.extend([limit, limit.next_up(), limit.next_down()]);
        }
        for cotangent in cotangents {
            let exact = angle(cotangent);
            assert!((found(cotangent) - exact).abs() <= 2.0 * f64::EPSILON * exact, "{cotangent}");
            let exact = angle(-cotangent);
            assert!((found(-cotangent) - exact).abs() <= 2.0 * f64::EPSILON * exact, "{cotangent}");
        }
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0].map(found), [0.0, PI, FRAC_PI_2, FRAC_PI_2]);
    }
}
