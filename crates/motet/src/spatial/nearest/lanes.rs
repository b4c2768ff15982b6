//! Eight 32-bit numbers, processed as many at a time as the machine can.

use std::ops::{Add, Div, Mul, Sub};

use pulp::Simd;

use crate::base::lanewise;

/// A number for each of eight items.
pub(super) type Eight = [f32; 8];

/// A number for each of as many of the eight items as the machine processes at a time.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd>(S, S::f32s);

pub(super) type Vector<S> = [Lanes<S>; 3];

lanewise! {
    Add add add_f32s;
    Sub sub sub_f32s;
    Mul mul mul_f32s;
    Div div div_f32s;
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(super) fn splat(simd: S, x: f32) -> Self {
        Self(simd, simd.splat_f32s(x))
    }

    /// Part `i` of the eight.
    #[inline(always)]
    pub(super) fn load(simd: S, eight: &Eight, i: usize) -> Self {
        Self(simd, S::as_simd_f32s(eight).0[i])
    }

    #[inline(always)]
    pub(super) fn store(self, eight: &mut Eight, i: usize) {
        S::as_mut_simd_f32s(eight).0[i] = self.1;
    }

    /// The smaller; `other` where this is NaN.
    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f32s(self.1, other.1))
    }

    /// The larger; `other` where this is NaN.
    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f32s(self.1, other.1))
    }

    /// The absolute value.
    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        Self(self.0, self.0.abs_f32s(self.1))
    }

    /// `self * factor + summand`, fused where that is one instruction.
    #[inline(always)]
    pub(super) fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(self.0, self.0.mul_add_e_f32s(self.1, factor.1, summand.1))
    }

    /// The sum of this part.
    #[inline(always)]
    pub(super) fn sum(self) -> f32 {
        self.0.reduce_sum_f32s(self.1)
    }

    /// The smallest of this part.
    #[inline(always)]
    pub(super) fn reduce_min(self) -> f32 {
        self.0.reduce_min_f32s(self.1)
    }

    /// The largest of this part.
    #[inline(always)]
    pub(super) fn reduce_max(self) -> f32 {
        self.0.reduce_max_f32s(self.1)
    }

    /// `yes` where this is below `limit`; elsewhere, and where either is NaN, `no`.
    #[inline(always)]
    pub(super) fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        let mask = self.0.less_than_f32s(self.1, limit.1);
        Self(self.0, self.0.select_f32s(mask, yes.1, no.1))
    }
}

/// A bit for each of the eight that is at most `limit`. They are summed as powers of two; eight comparisons
/// would take 40 instructions.
#[inline(always)]
pub(super) fn at_most<S: Simd>(simd: S, eight: &Eight, limit: f32) -> u32 {
    const BITS: Eight = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];
    let mut bits = 0.0;
    for i in 0..parts::<S>() {
        let x = Lanes::load(simd, eight, i);
        let is_at_most = simd.less_than_or_equal_f32s(x.1, simd.splat_f32s(limit));
        let bit = Lanes::load(simd, &BITS, i);
        bits += simd.reduce_sum_f32s(simd.select_f32s(is_at_most, bit.1, simd.splat_f32s(0.0)));
    }
    bits as u32
}

/// How many parts the eight are processed in.
#[inline(always)]
pub(super) fn parts<S: Simd>() -> usize {
    8 / S::F32_LANES
}

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, p: [f32; 3]) -> Vector<S> {
    [Lanes::splat(simd, p[0]), Lanes::splat(simd, p[1]), Lanes::splat(simd, p[2])]
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, eights: &[Eight; 3], i: usize) -> Vector<S> {
    [Lanes::load(simd, &eights[0], i), Lanes::load(simd, &eights[1], i), Lanes::load(simd, &eights[2], i)]
}

#[inline(always)]
pub(super) fn sub<S: Simd>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: Vector<S>, b: Vector<S>) -> Lanes<S> {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(super) fn cross<S: Simd>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
