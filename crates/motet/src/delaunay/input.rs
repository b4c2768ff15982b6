//! Prepares points for the builder: checks that they are finite and scales them by a power of two into the
//! range where its filters are valid.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::is_finite;

/// The longest side of the bounding box is scaled to between 2^24 and 2^25: then the error bounds fit into
/// `f32` and no stage of the filters can overflow.
const EXPONENT: i32 = 24;

/// The largest number of points whose marks (`4 * newcomer + state`) fit into 32 bits.
const MAX_POINTS: usize = (1 << 30) - 16;

/// Points scaled by a power of two, or unscaled where scaling would lose digits.
pub(super) struct Scaled {
    pub(super) points: Vec<Point>,
    /// Whether scaling kept every digit. Where it could not (coordinates of 1e200 beside 1e-200), the points
    /// stay as given and only exact arithmetic may be trusted.
    pub(super) filtered: bool,
    /// Two powers of two whose product undoes the scaling of a coordinate.
    pub(super) back: [f64; 2],
}

/// Rejects coordinates that are not finite, and more points than [`MAX_POINTS`].
pub(super) fn check(points: &[Point]) -> Result<()> {
    if points.len() > MAX_POINTS {
        let what = format!("{} points, expected at most {MAX_POINTS}", points.len());
        return Err(Error::input(what).remedy("divide the set"));
    }
    let Some(bad) = points.iter().position(|&p| !is_finite(p)) else { return Ok(()) };
    let [x, y, z] = points[bad];
    Err(Error::input(format!("the coordinates ({x}, {y}, {z}) are not finite numbers"))
        .at(format!("point {}", VertexId::new(bad)))
        .remedy("remove the point or correct the step that produced it"))
}

/// Scales the points so that the longest side of their bounding box is about 2^24.
pub(super) fn scaled(points: Vec<Point>) -> Scaled {
    let extent = longest_side(&points);
    if !(extent > 0.0 && extent.is_finite()) {
        return Scaled { points, filtered: false, back: [1.0; 2] };
    }
    let shift = EXPONENT - exponent(extent);
    let (half, rest) = (power_of_two(shift / 2), power_of_two(shift - shift / 2));
    let (back, back_rest) = (power_of_two(-(shift / 2)), power_of_two(shift / 2 - shift));
    let scale = |x: f64| x * half * rest;
    let keeps = |x: f64| scale(x).is_finite() && scale(x) * back * back_rest == x;
    if !points.iter().flatten().all(|&x| keeps(x)) {
        return Scaled { points, filtered: false, back: [1.0; 2] };
    }
    Scaled {
        points: points.into_iter().map(|p| p.map(scale)).collect(),
        filtered: true,
        back: [back, back_rest],
    }
}

/// The longest side of the bounding box of the points.
pub(super) fn longest_side(points: &[Point]) -> f64 {
    sides(points).into_iter().fold(0.0, f64::max)
}

/// The sides of the bounding box of the points.
pub(super) fn sides(points: &[Point]) -> Point {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in points {
        for i in 0..3 {
            low[i] = low[i].min(p[i]);
            high[i] = high[i].max(p[i]);
        }
    }
    std::array::from_fn(|i| high[i] - low[i])
}

/// The exponent `e` with `2^e <= |x| < 2^(e+1)`, for nonzero `x`.
fn exponent(x: f64) -> i32 {
    let biased = ((x.to_bits() >> 52) & 0x7ff) as i32;
    if biased == 0 { exponent(x * 2f64.powi(100)) - 100 } else { biased - 1023 }
}

/// `2^e`, clamped to 2^-1022 and 2^1023. The exponents used here are below 600 in magnitude.
fn power_of_two(e: i32) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::{check, longest_side, scaled};

    #[test]
    fn scaling_is_exact_or_not_done() {
        for size in [1e-300, 1e-3, 1.0, 7.0, 1e10, 1e300, f64::MIN_POSITIVE / 1024.0] {
            let points = vec![[0.0, size, -size], [size, 0.1 * size, size]];
            let ours = scaled(points.clone());
            assert!(ours.filtered, "{size}");
            assert!((2f64.powi(24)..2f64.powi(26)).contains(&longest_side(&ours.points)), "{size}");
            let ratio = ours.points[1][0] / size;
            assert!(
                points
                    .iter()
                    .zip(&ours.points)
                    .all(|(p, q)| (0..3).all(|i| p[i] * ratio == q[i] || size < 1e-290))
            );
        }
        let mixed = vec![[1e200, 0.0, 0.0], [1.3e-200, 0.0, 0.0]];
        let kept = scaled(mixed.clone());
        assert!(!kept.filtered);
        assert_eq!(kept.points, mixed);
    }

    #[test]
    fn what_is_not_finite_is_named() {
        let points = [[0.0; 3], [1.0, f64::NAN, 0.0]];
        let error = check(&points).expect_err("NaN");
        assert_eq!(error.place(), Some("point 1"));
        assert!(check(&[[f64::INFINITY, 0.0, 0.0]]).is_err());
        assert!(check(&[[f64::MAX; 3]]).is_ok());
    }
}
