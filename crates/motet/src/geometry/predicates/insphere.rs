//! Whether a point lies inside the sphere through four others: exact, in three stages.
//!
//! Relative to the first point `a`, with `x = e - a`, the determinant is `N . x - V |x|^2`,
//! where `V = b . (c x d)` is six times the volume and
//! `N = |b|^2 c x d + |c|^2 d x b + |d|^2 b x c` points at the centre (length 12 times volume times
//! distance). The Delaunay builder stores `N`, `V` and a bound for each tet.
//!
//! Error bounds, with `P = |b||c||d|`, `S = |b|+|c|+|d|`, `r = |x|`, `m = |x|_1 >= r`, `u = 2^-53`:
//! - `f64`: a component of N costs 5u (|b|^2: difference twice, square, two sums), 4u (c x d:
//!   two differences, product, subtraction), one product, two sums: 12u P S. V: 8u times
//!   2/sqrt(3) P, at most 10u P. Evaluation: 5u P S m + 7u P r^2. In all 17u P (S m + r^2); 20u is used.
//! - pairs, differences exact: by the rules in `pair` 235 u^2, times 2/sqrt(3) for sums of absolute products
//!   in V: 272 u^2 P (S m + r^2); 640 u^2 is used, so that the second bound costs one product: 32u times the first.

use super::exact;
use super::pair::{Pair, PairVector, U, cross, difference, dot};
use crate::base::Point;
use crate::geometry::vector;
use pulp::{Scalar, Simd};

/// Error of `N . x - V |x|^2` in `f64` over `P (S m + r^2)`.
pub(crate) const FILTER: f64 = 20.0 * U;
/// Error in pairs over the error in `f64`.
pub(crate) const PAIR_OVER_FILTER: f64 = 32.0 * U;
/// Beyond this difference the stages before the exact one could overflow.
const LARGEST: f64 = 1.2e30; // 2^100
/// More than all underflow together can amount to: 2^-1074 times 2^300 and small factors.
pub(crate) const UNDERFLOW: f64 = 1e-225; // 2^-747

/// Sign of the in-sphere determinant: 1 when `e` lies inside the sphere through the positively
/// oriented tet a, b, c, d, -1 when outside, 0 exactly when on it; the other way round
/// for a negatively oriented tet. Exact for all finite coordinates.
pub fn insphere(a: Point, b: Point, c: Point, d: Point, e: Point) -> i8 {
    let (determinant, bound, largest) = filtered(a, b, c, d, e);
    if largest < LARGEST {
        if determinant.abs() > bound + UNDERFLOW {
            return if determinant > 0.0 { 1 } else { -1 };
        }
        return beyond_filter::<Scalar>(a, b, c, d, e, bound);
    }
    exact::insphere(a, [b, c, d, e])
}

/// Determinant, bound of its error, largest difference to `a`.
#[inline(always)]
fn filtered(a: Point, b: Point, c: Point, d: Point, e: Point) -> (f64, f64, f64) {
    let [b, c, d, x] = [b, c, d, e].map(|p| vector::sub(p, a));
    let [b2, c2, d2, r2] = [b, c, d, x].map(|v| vector::dot(v, v));
    let cd = vector::cross(c, d);
    let (db, bc) = (vector::cross(d, b), vector::cross(b, c));
    let normal: Point = std::array::from_fn(|i| b2 * cd[i] + c2 * db[i] + d2 * bc[i]);
    let determinant = vector::dot(normal, x) - vector::dot(b, cd) * r2;
    let [lb, lc, ld] = [b2, c2, d2].map(f64::sqrt);
    let m = x[0].abs() + x[1].abs() + x[2].abs();
    let bound = FILTER * (lb * lc * ld) * ((lb + lc + ld) * m + r2);
    let largest = [b, c, d, x].iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    (determinant, bound, largest)
}

/// Stages two and three, given the error bound of the first (infinite or NaN: straight to the
/// third). Differences must stay below 2^100 unless `bound` is infinite.
#[inline(always)]
pub(crate) fn beyond_filter<S: Simd>(a: Point, b: Point, c: Point, d: Point, e: Point, bound: f64) -> i8 {
    let determinant = in_pairs::<S>(a, b, c, d, e).value();
    if determinant.abs() > bound * PAIR_OVER_FILTER + UNDERFLOW {
        return if determinant > 0.0 { 1 } else { -1 };
    }
    exact::insphere(a, [b, c, d, e])
}

#[inline(always)]
fn in_pairs<S: Simd>(a: Point, b: Point, c: Point, d: Point, e: Point) -> Pair {
    let [b, c, d, x] = [b, c, d, e].map(|p| difference(p, a));
    let [b2, c2, d2, r2] = [b, c, d, x].map(|v| dot::<S>(v, v));
    let cd = cross::<S>(c, d);
    let (db, bc) = (cross::<S>(d, b), cross::<S>(b, c));
    let component = |i: usize| -> Pair {
        let [cd, db, bc]: [&PairVector; 3] = [&cd, &db, &bc];
        b2.times::<S>(cd[i]).plus(c2.times::<S>(db[i])).plus(d2.times::<S>(bc[i]))
    };
    let normal = [component(0), component(1), component(2)];
    dot::<S>(normal, x).minus(dot::<S>(b, cd).times::<S>(r2))
}

/// The parts that tests hold against rationals: value (as a pair) and bound of each stage.
#[cfg(test)]
pub(crate) fn stages(points: [Point; 5]) -> [(Pair, f64); 2] {
    let [a, b, c, d, e] = points;
    let (determinant, bound, _) = filtered(a, b, c, d, e);
    let pairs = in_pairs::<Scalar>(a, b, c, d, e);
    let first = Pair { high: determinant, low: 0.0 };
    [(first, bound + UNDERFLOW), (pairs, bound * PAIR_OVER_FILTER + UNDERFLOW)]
}
