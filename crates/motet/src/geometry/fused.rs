//! Vector operations with the machine's fused multiply-add where `S` has one: half the instructions, and one
//! rounding instead of two. Results depend on the machine by a rounding, so they serve only for estimates
//! with an error bound; a bound that holds for separate operations holds for these.
//!
//! Call these only from code dispatched for `S` ([`pulp::WithSimd`]): elsewhere a fused multiply-add is a
//! function call.

use crate::base::Point;
use pulp::Simd;

/// `a b + c`
#[inline(always)]
pub(crate) fn multiply_add<S: Simd>(a: f64, b: f64, c: f64) -> f64 {
    if S::IS_SCALAR { a * b + c } else { a.mul_add(b, c) }
}

/// `a . b`
#[inline(always)]
pub(crate) fn dot<S: Simd>(a: Point, b: Point) -> f64 {
    multiply_add::<S>(a[0], b[0], multiply_add::<S>(a[1], b[1], a[2] * b[2]))
}

/// `a x b`
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: Point, b: Point) -> Point {
    [
        multiply_add::<S>(a[1], b[2], -(a[2] * b[1])),
        multiply_add::<S>(a[2], b[0], -(a[0] * b[2])),
        multiply_add::<S>(a[0], b[1], -(a[1] * b[0])),
    ]
}

/// `s a + b`
#[inline(always)]
pub(crate) fn scale_add<S: Simd>(a: Point, s: f64, b: Point) -> Point {
    [multiply_add::<S>(s, a[0], b[0]), multiply_add::<S>(s, a[1], b[1]), multiply_add::<S>(s, a[2], b[2])]
}
