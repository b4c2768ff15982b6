//! How far rounding may have moved points: told by the digits of their coordinates.

use crate::base::Point;

/// So many roundings of `f64` may have come one upon the other: a turn is five, and bodies are turned and shifted more than once.
const ROUNDINGS: f64 = 64.0;

/// A body is written with fewer digits once, and each coordinate is off by half the last one; so is the plane that it is held against.
const WRITTEN: f64 = 2.0;

/// More digits behind the point than this are as many as an `f64` has.
const MOST_DECIMALS: i32 = 12;

/// More digits than this are as many as an `f32` has.
const MOST_DIGITS: i32 = 9;

/// Last digits larger than this, beside the largest coordinate, are those of numbers that are meant so.
const COARSEST: f64 = 1e-5;

/// A bound on how far rounding has moved each coordinate. The digits of all coordinates tell what they were written with: `f64`, `f32`, a number of decimals or of digits.
pub(crate) fn of(points: &[Point]) -> f64 {
    let all = || points.as_flattened().iter().copied();
    let largest = all().fold(0.0f64, |largest, x| largest.max(x.abs()));
    let of_double = ROUNDINGS * 0.5 * f64::EPSILON * largest;
    let is_single = all().all(|x| f64::from(x as f32) == x);
    let of_single = if is_single { WRITTEN * 0.5 * f64::from(f32::EPSILON) * largest } else { 0.0 };
    let has_decimals =
        |ten: f64| all().all(|x| (x * ten - (x * ten).round()).abs() <= 2.0 * f64::EPSILON * (x * ten).abs());
    let ten = (0..=MOST_DECIMALS).map(|n| 10f64.powi(n)).find(|&ten| has_decimals(ten));
    let has_digits = |n: i32| all().all(|x| format!("{x:.*e}", n as usize - 1).parse() == Ok(x));
    let digits = (1..=MOST_DIGITS).find(|&n| has_digits(n));
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
        // Six digits of a number that is not below one are five decimals.
        let decimals = of(&[[0.333333, 0.666667, 1.0]]);
        assert!((0.9e-5..1.1e-5).contains(&decimals), "{decimals}");
        let digits = of(&[[0.00123456, 0.654321, 0.5]]);
        assert!((0.9e-6..1.1e-6).contains(&digits), "{digits}");
        // Few digits are meant so.
        assert!(of(&[[0.0, 0.25, 1.0], [100.0, 33.0, 0.0]]) < 2e-5);
    }
}
