//! Estimates how far rounding may have moved points, from the digits of their coordinates.

use crate::base::Point;

/// The number of `f64` roundings that may have accumulated: a rotation has five, and bodies are rotated and
/// translated more than once.
const ROUNDINGS: f64 = 64.0;

/// The number of half units of the last digit by which coordinates written with fewer digits may be off: one
/// for the coordinate itself, one for the plane with which it is compared.
const WRITTEN: f64 = 2.0;

/// Points with more decimals than this count as having all the digits of an `f64`.
const MAX_DECIMALS: i32 = 12;

/// Points with more significant digits than this count as having all the digits of an `f32`.
const MAX_DIGITS: i32 = 9;

/// A unit of the last digit coarser than this, relative to the largest coordinate, is not a sign of rounding:
/// such numbers are exact as written.
const COARSEST: f64 = 1e-5;

/// Returns a bound on how far rounding has moved each coordinate. The digits of all coordinates show how they
/// were written: as `f64`, as `f32`, or with a fixed number of decimals or of significant digits.
pub(crate) fn of(points: &[Point]) -> f64 {
    let all = || points.as_flattened().iter().copied();
    let largest = all().fold(0.0f64, |largest, x| largest.max(x.abs()));
    let of_double = ROUNDINGS * 0.5 * f64::EPSILON * largest;
    let is_single = all().all(|x| f64::from(x as f32) == x);
    let of_single = if is_single { WRITTEN * 0.5 * f64::from(f32::EPSILON) * largest } else { 0.0 };
    let has_decimals =
        |ten: f64| all().all(|x| (x * ten - (x * ten).round()).abs() <= 2.0 * f64::EPSILON * (x * ten).abs());
    let ten = (0..=MAX_DECIMALS).map(|n| 10f64.powi(n)).find(|&ten| has_decimals(ten));
    let has_digits = |n: i32| all().all(|x| format!("{x:.*e}", n as usize - 1).parse() == Ok(x));
    let digits = (1..=MAX_DIGITS).find(|&n| has_digits(n));
    let last = |n: i32| 10f64.powi(largest.log10().floor() as i32 + 1 - n);
    let steps = [ten.map(f64::recip), digits.map(last)].into_iter().flatten();
    let of_text = steps.map(|step| WRITTEN * 0.5 * step).filter(|&of| of <= COARSEST * largest);
    of_text.fold(of_double.max(of_single), f64::max)
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn digits_tell_the_rounding() {
        let third = [1.0 / 3.0, 2.0 / 3.0, 1.0];
        assert!(of(&[third]) < 1e-14);
        let single = of(&[third.map(|x| f64::from(x as f32))]);
        assert!((5e-8..2e-7).contains(&single), "{single}");
        let decimals = of(&[[0.333333, 0.666667, 0.9]]);
        assert!((0.9e-6..1.1e-6).contains(&decimals), "{decimals}");
        // With one number not below one, six significant digits are five decimals.
        let decimals = of(&[[0.333333, 0.666667, 1.0]]);
        assert!((0.9e-5..1.1e-5).contains(&decimals), "{decimals}");
        let digits = of(&[[0.00123456, 0.654321, 0.5]]);
        assert!((0.9e-6..1.1e-6).contains(&digits), "{digits}");
        // Numbers with few digits are exact as written.
        assert!(of(&[[0.0, 0.25, 1.0], [100.0, 33.0, 0.0]]) < 2e-5);
    }
}
