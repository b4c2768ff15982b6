//! Scales a tet to near unit size by a power of two, so that no product over- or underflows.

use crate::base::Point;
use crate::geometry::tet::{EDGES, volume_6};
use crate::geometry::vector::{dot, scale, sub};

/// Range of the largest coordinate difference in which a tet is left unscaled. The eighth power of either
/// limit, the largest power that any measure takes, is well within `f64`.
const SIZES: std::ops::Range<f64> = 1e-30..1e30;

/// A tet whose size is within [`SIZES`], or zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled {
    /// The points times `2^exponent`, translated if they were scaled.
    pub(super) points: [Point; 4],
    /// The exponent of the scaling; 0 where the points are unchanged.
    pub(super) exponent: i32,
}

impl Scaled {
    #[inline(always)]
    pub(super) fn new(points: [Point; 4]) -> Self {
        let size = size(points);
        if SIZES.contains(&size) || size == 0.0 {
            return Self { points, exponent: 0 };
        }
        Self::resized(points, size)
    }

    #[cold]
    fn resized(points: [Point; 4], size: f64) -> Self {
        // Two steps, since the difference of huge coordinates may overflow.
        let coarse = if size > 1.0 { -2 } else { 0 };
        let points = points.map(|p| scale(p, power_of_two(coarse)));
        let points = points.map(|p| sub(p, points[0]));
        let fine = -size_exponent(points);
        Self { points: points.map(|p| scale(p, power_of_two(fine))), exponent: coarse + fine }
    }

    /// Six times the signed volume of the scaled tet.
    #[inline(always)]
    pub(super) fn volume_6(&self) -> f64 {
        volume_6(self.points)
    }

    /// The squared length of each edge of the scaled tet.
    #[inline(always)]
    pub(super) fn lengths_squared(&self) -> [f64; 6] {
        let mut squares = [0.0; 6];
        for (e, [i, j]) in EDGES.into_iter().enumerate() {
            let edge = sub(self.points[j], self.points[i]);
            squares[e] = dot(edge, edge);
        }
        squares
    }
}

/// The largest coordinate difference from the first point.
#[inline(always)]
fn size([a, others @ ..]: [Point; 4]) -> f64 {
    let mut size = 0.0f64;
    for p in others {
        let edge = sub(p, a);
        for x in edge {
            size = if x.abs() > size { x.abs() } else { size };
        }
    }
    size
}

fn size_exponent(points: [Point; 4]) -> i32 {
    size(points).log2().clamp(-1022.0, 1022.0) as i32
}

/// Returns `2^e`, with `e` clamped to the exponents of normal numbers.
pub(super) fn power_of_two(e: i32) -> f64 {
    f64::from_bits((i64::from(e.clamp(-1022, 1023)) + 1023) as u64 * (1u64 << 52))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact() {
        assert!((-1022..=1023).all(|e| power_of_two(e) == 2f64.powi(e)));
    }

    #[test]
    fn any_size_comes_near_one() {
        for size_exponent in [-1070, -600, -200, 200, 600, 1023] {
            let s = if size_exponent < -1022 { f64::from_bits(16) } else { power_of_two(size_exponent) };
            let tet = Scaled::new([[0.0; 3], [s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, -s]]);
            assert!(SIZES.contains(&size(tet.points)), "{tet:?}");
            assert!(tet.volume_6() < 0.0);
        }
    }
}
