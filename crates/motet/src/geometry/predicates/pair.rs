//! Arithmetic with twice the digits of an `f64`: unevaluated sums of two, without renormalising.
//!
//! A [`Pair`] `(h, l)` stands for `h + l`. Sums and differences of plain numbers and products of plain
//! numbers are exact pairs (Knuth 1969; Dekker 1971); further operations drop the smallest terms and, unlike
//! double-double arithmetic, let `h` and `l` overlap (Lange and Rump 2020, *Faithfully rounded floating-point
//! computations*). That saves a third of the additions.
//!
//! Error bounds, with `u = 2^-53`, `A` a bound on the same expression with all terms replaced by their
//! absolute values, `|l| <= k u A` and an error of at most `e u^2 A`:
//!
//! | operation | k | e |
//! |---|---|---|
//! | difference of two numbers | 1 | 0 |
//! | product | 1 + k1 + k2 | e1 + e2 + k1 k2 + k1 + 2 k2 + 2 |
//! | sum | 1 + max k | max e + 2 max k + 1 |

use pulp::Simd;

/// The unit of rounding of an `f64`, 2^-53.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// An unevaluated sum of a number and its (much smaller) correction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    /// The leading part.
    pub(crate) high: f64,
    /// The correction.
    pub(crate) low: f64,
}

impl Pair {
    /// `a - b`, exactly (Knuth's two-sum).
    #[inline(always)]
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let back = high - a;
        Self { high, low: (a - (high - back)) - (b + back) }
    }

    /// The sum of both parts, rounded.
    #[inline(always)]
    pub(crate) fn value(self) -> f64 {
        self.high + self.low
    }

    /// Moves the correction below the last place of the leading part; the sum stays.
    #[inline(always)]
    pub(crate) fn normalized(self) -> Self {
        let high = self.high + self.low;
        let back = high - self.high;
        Self { high, low: (self.high - (high - back)) + (self.low - back) }
    }

    /// `self + other`
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        let high = self.high + other.high;
        let back = high - self.high;
        let rest = (self.high - (high - back)) + (other.high - back);
        Self { high, low: (self.low + other.low) + rest }
    }

    /// `self - other`
    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    /// `self * other`, with the machine's fused multiply-add where `S` has one.
    #[inline(always)]
    pub(crate) fn times<S: Simd>(self, other: Self) -> Self {
        let high = self.high * other.high;
        if S::IS_SCALAR {
            let rest = product_error(self.high, other.high, high);
            Self { high, low: other.high * self.low + (self.high * other.low + rest) }
        } else {
            let rest = self.high.mul_add(other.high, -high);
            Self { high, low: other.high.mul_add(self.low, self.high.mul_add(other.low, rest)) }
        }
    }
}

/// `a * b - product` where `product` is the rounded `a * b`: Dekker's splitting, for
/// machines where a fused multiply-add would be a library call.
#[inline(always)]
fn product_error(a: f64, b: f64, product: f64) -> f64 {
    let (a1, a2) = split(a);
    let (b1, b2) = split(b);
    a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)
}

/// The upper 26 bits of `a`, and the rest (Veltkamp).
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

/// A vector of pairs.
pub(crate) type PairVector = [Pair; 3];

/// `a - b`, exactly.
#[inline(always)]
pub(crate) fn difference(a: [f64; 3], b: [f64; 3]) -> PairVector {
    [Pair::difference(a[0], b[0]), Pair::difference(a[1], b[1]), Pair::difference(a[2], b[2])]
}

/// `a . b`
#[inline(always)]
pub(crate) fn dot<S: Simd>(a: PairVector, b: PairVector) -> Pair {
    a[0].times::<S>(b[0]).plus(a[1].times::<S>(b[1])).plus(a[2].times::<S>(b[2]))
}

/// `a x b`
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: PairVector, b: PairVector) -> PairVector {
    let minor = |i: usize, j: usize| a[i].times::<S>(b[j]).minus(a[j].times::<S>(b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::{Pair, product_error};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_splitting_finds_what_the_fused_multiply_finds(a in -1e100..1e100f64, b in -1e-30..1e30f64) {
            prop_assert_eq!(product_error(a, b, a * b), a.mul_add(b, -(a * b)));
        }

        #[test]
        fn a_difference_loses_nothing(a in -1.0..1.0f64, b in -1e-9..1e-9f64) {
            let pair = Pair::difference(a, b);
            prop_assert_eq!(pair.high, a - b);
            prop_assert_eq!(Pair::difference(pair.high, a).plus(Pair { high: b, low: pair.low }).value(), 0.0);
        }
    }
}
