//! The exact in-sphere test, in three stages: whether a point lies inside the sphere through four others.
//!
//! Relative to the first point `a`, with `x = e - a`, the determinant is `N . x - V |x|^2`, where `V = b x c
//! . d` is six times the volume and `N = |b|^2 c x d + |c|^2 d x b + |d|^2 b x c` points towards the centre
//! (its length is 12 times the volume times the distance to the centre). `N` is computed as `(|b|^2 c - |c|^2
//! b) x d + |d|^2 b x c`, which saves a cross product. The Delaunay builder stores `N`, `V` and a bound for
//! each tet.
//!
//! Error bounds, with `P = |b||c||d|`, `S = |b|+|c|+|d|`, `r = |x|`, `m = |x|_1 >= r`, `u = 2^-53`:
//! - `f64`: a component of N costs 5u (|b|^2: difference twice, square, two sums), 1u (c: difference),
//!   product, subtraction: 8u; 1u (d), product, subtraction: 11u; one sum: 12u P S. (The second term: 5u, 4u
//!   for b x c, product, sum.) V: 8u times 2/sqrt(3) P, at most 10u P. Evaluation: 5u P S m + 7u P r^2. In
//!   all 17u P (S m + r^2); 20u is used.
//! - pairs, differences exact: by the rules in `pair` 236 u^2, times 2/sqrt(3) for sums of absolute products
//!   in V: 273 u^2 P (S m + r^2); 640 u^2 is used, so that the second bound costs one product: 32u times the
//!   first.

use super::exact;
use super::pair::{Pair, U, cross, difference, dot};
use crate::base::Point;
use crate::geometry::{fused, vector};
use pulp::{Scalar, Simd};

/// Error of `N . x - V |x|^2` in `f64`, relative to `P (S m + r^2)`.
pub(crate) const FILTER: f64 = 20.0 * U;
/// Ratio of the error bound in pairs to that in `f64`.
pub(crate) const PAIR_OVER_FILTER: f64 = 32.0 * U;
/// Beyond this coordinate difference the stages before the exact one could overflow.
const LARGEST: f64 = 1.2e30; // 2^100
/// More than all underflow together can contribute: 2^-1074 times 2^300 and small factors.
pub(crate) const UNDERFLOW: f64 = 1e-225; // 2^-747

/// Sign of the in-sphere determinant: 1 when `e` lies inside the sphere through the positively oriented tet
/// a, b, c, d, -1 when outside, 0 exactly when on it; reversed for a negatively oriented tet. Exact for all
/// finite coordinates.
pub fn insphere(a: Point, b: Point, c: Point, d: Point, e: Point) -> i8 {
    let (determinant, bound, largest) = filtered::<Scalar>(a, b, c, d, e);
    if largest < LARGEST {
        if determinant.abs() > bound + UNDERFLOW {
            return if determinant > 0.0 { 1 } else { -1 };
        }
        return beyond_filter::<Scalar>(a, b, c, d, e, bound);
    }
    exact::insphere(a, [b, c, d, e])
}

/// The determinant, a bound on its error, and the largest difference from `a`.
#[inline(always)]
fn filtered<S: Simd>(a: Point, b: Point, c: Point, d: Point, e: Point) -> (f64, f64, f64) {
    let [b, c, d, x] = [b, c, d, e].map(|p| vector::sub(p, a));
    let [b2, c2, d2, r2] = [b, c, d, x].map(|v| fused::dot::<S>(v, v));
    let (normal, volume) = minors::<S>([b, c, d], [b2, c2, d2]);
    let determinant = fused::multiply_add::<S>(-volume, r2, fused::dot::<S>(normal, x));
    let [lb, lc, ld] = [b2, c2, d2].map(f64::sqrt);
    let m = x[0].abs() + x[1].abs() + x[2].abs();
    let bound = FILTER * (lb * lc * ld) * ((lb + lc + ld) * m + r2);
    let largest = [b, c, d, x].iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    (determinant, bound, largest)
}

/// `N` and `V` for three differences and their squared lengths.
#[inline(always)]
pub(crate) fn minors<S: Simd>([b, c, d]: [Point; 3], [b2, c2, d2]: [f64; 3]) -> (Point, f64) {
    let w = fused::scale_add::<S>(c, b2, vector::scale(b, -c2));
    let bc = fused::cross::<S>(b, c);
    (fused::scale_add::<S>(bc, d2, fused::cross::<S>(w, d)), fused::dot::<S>(bc, d))
}

/// Stages two and three, given the error bound of the first (infinite or NaN goes straight to the third).
/// Differences must stay below 2^100 unless `bound` is infinite.
#[inline(always)]
pub(crate) fn beyond_filter<S: Simd>(a: Point, b: Point, c: Point, d: Point, e: Point, bound: f64) -> i8 {
    let determinant = in_pairs::<S>(a, b, c, d, e).value();
    if determinant.abs() > bound * PAIR_OVER_FILTER + UNDERFLOW {
        return if determinant > 0.0 { 1 } else { -1 };
    }
    exact::insphere(a, [b, c, d, e])
}

/// The determinant in pairs. Written out: a closure given to `map` would be compiled without the instructions
/// of `S`, and call a function for each fused multiply-add (a sixth of all time on boundary points).
#[inline(always)]
fn in_pairs<S: Simd>(a: Point, b: Point, c: Point, d: Point, e: Point) -> Pair {
    let (b, c, d, x) = (difference(b, a), difference(c, a), difference(d, a), difference(e, a));
    let (b2, c2, d2, x2) = (dot::<S>(b, b), dot::<S>(c, c), dot::<S>(d, d), dot::<S>(x, x));
    let bc = cross::<S>(b, c);
    let w = [
        b2.times::<S>(c[0]).minus(c2.times::<S>(b[0])),
        b2.times::<S>(c[1]).minus(c2.times::<S>(b[1])),
        b2.times::<S>(c[2]).minus(c2.times::<S>(b[2])),
    ];
    let wd = cross::<S>(w, d);
    let normal = [
        wd[0].plus(d2.times::<S>(bc[0])),
        wd[1].plus(d2.times::<S>(bc[1])),
        wd[2].plus(d2.times::<S>(bc[2])),
    ];
    dot::<S>(normal, x).minus(dot::<S>(bc, d).times::<S>(x2))
}

/// The parts that tests compare with rational arithmetic: the value (as a pair) and the bound of each stage.
#[cfg(test)]
pub(crate) fn stages<S: Simd>(points: [Point; 5]) -> [(Pair, f64); 2] {
    let [a, b, c, d, e] = points;
    let (determinant, bound, _) = filtered::<S>(a, b, c, d, e);
    let pairs = in_pairs::<S>(a, b, c, d, e);
    let first = Pair { high: determinant, low: 0.0 };
    [(first, bound + UNDERFLOW), (pairs, bound * PAIR_OVER_FILTER + UNDERFLOW)]
}
