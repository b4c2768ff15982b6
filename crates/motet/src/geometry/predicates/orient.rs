//! The exact orientation test, in three stages: on which side of a plane a point lies.

use super::exact;
use super::pair::{Pair, U, cross, difference, dot};
use crate::base::Point;
use pulp::{Scalar, Simd};

/// Error of the `f64` determinant relative to its permanent: each of the six terms has three differences, two
/// products, one subtraction and two sums, 8u; the rest covers the rounding of the permanent.
const FILTER: f64 = 9.0 * U;
/// Error of the determinant in pairs, where differences are exact, relative to its permanent: 53 u^2 by the
/// rules in `pair`.
const PAIR_FILTER: f64 = 100.0 * U * U;
/// Beyond this coordinate difference the stages before the exact one could overflow.
const LARGEST: f64 = 1.6e60; // 2^200
/// More than all underflow together can contribute: 2^-1074 times 2^200 and small factors.
const UNDERFLOW: f64 = 1e-255; // 2^-847

/// Sign of `(b - a) x (c - a) . (d - a)`: 1 when the tet a, b, c, d is positively oriented, -1 when
/// negatively, 0 exactly when the four points lie in one plane. Exact for all finite
/// coordinates (Shewchuk 1997 for the staging).
#[inline]
pub fn orient3d(a: Point, b: Point, c: Point, d: Point) -> i8 {
    let (determinant, permanent, largest) = filtered(a, b, c, d);
    // Comparisons with NaN and infinity fail, so overflow falls through.
    if largest < LARGEST && determinant.abs() > FILTER * permanent + UNDERFLOW {
        return if determinant > 0.0 { 1 } else { -1 };
    }
    beyond_filter(a, b, c, d)
}

/// The determinant and the permanent of the differences from `a`, and the largest difference.
#[inline(always)]
fn filtered(a: Point, b: Point, c: Point, d: Point) -> (f64, f64, f64) {
    let [bx, by, bz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let [cx, cy, cz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let [dx, dy, dz] = [d[0] - a[0], d[1] - a[1], d[2] - a[2]];
    let (x1, x2) = (by * cz, bz * cy);
    let (y1, y2) = (bz * cx, bx * cz);
    let (z1, z2) = (bx * cy, by * cx);
    let determinant = (x1 - x2) * dx + (y1 - y2) * dy + (z1 - z2) * dz;
    let permanent = (x1.abs() + x2.abs()) * dx.abs()
        + (y1.abs() + y2.abs()) * dy.abs()
        + (z1.abs() + z2.abs()) * dz.abs();
    let largest = [bx, by, bz, cx, cy, cz, dx, dy, dz].iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    (determinant, permanent, largest)
}

/// Stages two and three of [`orient3d`].
#[cold]
#[inline(never)]
pub(crate) fn beyond_filter(a: Point, b: Point, c: Point, d: Point) -> i8 {
    if vanishes_by_pattern(a, b, c, d) {
        return 0;
    }
    let (_, permanent, largest) = filtered(a, b, c, d);
    if largest < LARGEST {
        let determinant = in_pairs::<Scalar>(a, b, c, d).value();
        if determinant.abs() > PAIR_FILTER * permanent + UNDERFLOW {
            return if determinant > 0.0 { 1 } else { -1 };
        }
    }
    exact::orient3d(a, [b, c, d])
}

#[inline(always)]
fn in_pairs<S: Simd>(a: Point, b: Point, c: Point, d: Point) -> Pair {
    let (b, c, d) = (difference(b, a), difference(c, a), difference(d, a));
    dot::<S>(cross::<S>(b, c), d)
}

/// Whether each of the six terms has a factor that is exactly zero: this holds for four points of an
/// axis-parallel wall, 99 of 100 calls that get here from the boundary of a box.
#[inline(always)]
fn vanishes_by_pattern(a: Point, b: Point, c: Point, d: Point) -> bool {
    let [b, c, d] = [b, c, d].map(|p| [p[0] != a[0], p[1] != a[1], p[2] != a[2]]);
    let minor = |i: usize, j: usize| (b[i] & c[j]) | (b[j] & c[i]);
    !((minor(1, 2) & d[0]) | (minor(2, 0) & d[1]) | (minor(0, 1) & d[2]))
}

/// Whether three points are collinear. Exact for all finite coordinates.
pub fn collinear(a: Point, b: Point, c: Point) -> bool {
    // They are collinear exactly when every point makes a flat tet with them; of the three axis directions at
    // least one leads out of any plane.
    let beside = |axis: usize| {
        let mut p = a;
        let lowered = p[axis] / 2.0 - 1.0;
        p[axis] = if lowered == p[axis] { p[axis] + 1.0 } else { lowered };
        p
    };
    (0..3).all(|axis| orient3d(a, b, c, beside(axis)) == 0)
}

/// The determinant in `f64` and a bound on its error (infinite where the filter is not valid).
pub(crate) fn with_bound([a, b, c, d]: [Point; 4]) -> (f64, f64) {
    let (determinant, permanent, largest) = filtered(a, b, c, d);
    (determinant, if largest < LARGEST { FILTER * permanent + UNDERFLOW } else { f64::INFINITY })
}

/// The plane through three points, prepared for tests of many other points.
pub(crate) struct Plane {
    a: Point,
    normal: Point,
    /// The factors of the permanent that correspond to the normal in the determinant.
    magnitude: Point,
}

impl Plane {
    #[inline]
    pub(crate) fn new([a, b, c]: [Point; 3]) -> Self {
        let [bx, by, bz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let [cx, cy, cz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        let (x1, x2) = (by * cz, bz * cy);
        let (y1, y2) = (bz * cx, bx * cz);
        let (z1, z2) = (bx * cy, by * cx);
        Self {
            a,
            normal: [x1 - x2, y1 - y2, z1 - z2],
            magnitude: [x1.abs() + x2.abs(), y1.abs() + y2.abs(), z1.abs() + z2.abs()],
        }
    }

    /// [`with_bound`] for the three points of the plane and `d`, by the same operations; the bound is
    /// infinite or NaN where they overflow.
    #[inline]
    pub(crate) fn with_bound(&self, d: Point) -> (f64, f64) {
        let [dx, dy, dz] = [d[0] - self.a[0], d[1] - self.a[1], d[2] - self.a[2]];
        let determinant = self.normal[0] * dx + self.normal[1] * dy + self.normal[2] * dz;
        let permanent =
            self.magnitude[0] * dx.abs() + self.magnitude[1] * dy.abs() + self.magnitude[2] * dz.abs();
        (determinant, FILTER * permanent + UNDERFLOW)
    }
}

/// The determinant in pairs and a bound on its error, including that of its last rounding.
pub(crate) fn in_pairs_with_bound([a, b, c, d]: [Point; 4]) -> (f64, f64) {
    let (_, permanent, largest) = filtered(a, b, c, d);
    let determinant = in_pairs::<Scalar>(a, b, c, d).value();
    let bound = PAIR_FILTER * permanent + UNDERFLOW + U * determinant.abs();
    (determinant, if largest < LARGEST { bound } else { f64::INFINITY })
}

/// The parts that tests compare with rational arithmetic: the value (as a pair) and the bound of each stage.
#[cfg(test)]
pub(crate) fn stages(a: Point, b: Point, c: Point, d: Point) -> [(Pair, f64); 2] {
    let (determinant, permanent, _) = filtered(a, b, c, d);
    [
        (Pair { high: determinant, low: 0.0 }, FILTER * permanent + UNDERFLOW),
        (in_pairs::<Scalar>(a, b, c, d), PAIR_FILTER * permanent + UNDERFLOW),
    ]
}
