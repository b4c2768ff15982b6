//! Four numbers processed at once, with SIMD instructions or without; the results are the same to the bit.

use std::ops::{Add, Div, Mul, Sub};

/// Four numbers.
pub(crate) trait FourLanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A token that proves that the machine has the instructions.
    type Machine: Copy;

    fn load(machine: Self::Machine, numbers: &[f64; 4]) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// `self * factor + term`, rounded once. Slow where the machine has no such instruction.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// The smaller of each pair; that of `self` where either is not a number. Of 0 and -0 either.
    fn min(self, other: Self) -> Self;
    /// The larger of each pair, with the same rules as [`Self::min`].
    fn max(self, other: Self) -> Self;
    /// `yes` where this is positive, else `no`.
    fn select_positive(self, yes: Self, no: Self) -> Self;
    /// `self`, or `other` where `self` is not a number.
    fn or_if_nan(self, other: Self) -> Self;
    fn stored(self) -> [f64; 4];

    #[inline(always)]
    fn splat(machine: Self::Machine, x: f64) -> Self {
        Self::load(machine, &[x; 4])
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d] = self.stored();
        (a + b) + (c + d)
    }

    #[inline(always)]
    fn min_lane(self) -> f64 {
        let [a, b, c, d] = self.stored();
        smaller(smaller(a, b), smaller(c, d))
    }

    #[inline(always)]
    fn max_lane(self) -> f64 {
        let [a, b, c, d] = self.stored();
        larger(larger(a, b), larger(c, d))
    }
}

/// One comparison; `f64::min` needs two more to handle what is not a number.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Four points or vectors, coordinate by coordinate.
pub(crate) type FourVectors<F> = [F; 3];

/// Four numbers processed one by one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain([f64; 4]);

#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide(pulp::x86::V3, pulp::f64x4);

/// The token for [`Wide`], where the machine has the instructions; detected once.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn wide_machine() -> Option<pulp::x86::V3> {
    static FOUND: std::sync::LazyLock<Option<pulp::x86::V3>> =
        std::sync::LazyLock::new(pulp::x86::V3::try_new);
    *FOUND
}

macro_rules! by_each {
    ($($trait:ident $method:ident $operator:tt $simd:ident;)*) => {
        $(impl $trait for Plain {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b, c, d], [p, q, r, s]) = (self.0, other.0);
                Self([a $operator p, b $operator q, c $operator r, d $operator s])
            }
        }

        #[cfg(target_arch = "x86_64")]
        impl $trait for Wide {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0, self.0.$simd(self.1, other.1))
            }
        })*
    };
}

by_each! {
    Add add + add_f64x4;
    Sub sub - sub_f64x4;
    Mul mul * mul_f64x4;
    Div div / div_f64x4;
}

impl FourLanes for Plain {
    type Machine = ();

    #[inline(always)]
    fn load(_: (), numbers: &[f64; 4]) -> Self {
        Self(*numbers)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt()])
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([a.abs(), b.abs(), c.abs(), d.abs()])
    }

    #[inline(always)]
    fn mul_add(mut self, factor: Self, term: Self) -> Self {
        for i in 0..4 {
            self.0[i] = self.0[i].mul_add(factor.0[i], term.0[i]);
        }
        self
    }

    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for i in 0..4 {
            self.0[i] = smaller(other.0[i], self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for i in 0..4 {
            self.0[i] = larger(other.0[i], self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        let mut chosen = no;
        for i in 0..4 {
            chosen.0[i] = if self.0[i] > 0.0 { yes.0[i] } else { no.0[i] };
        }
        chosen
    }

    #[inline(always)]
    fn or_if_nan(mut self, other: Self) -> Self {
        for i in 0..4 {
            self.0[i] = if self.0[i].is_nan() { other.0[i] } else { self.0[i] };
        }
        self
    }

    #[inline(always)]
    fn stored(self) -> [f64; 4] {
        self.0
    }
}

#[cfg(target_arch = "x86_64")]
impl FourLanes for Wide {
    type Machine = pulp::x86::V3;

    #[inline(always)]
    fn load(machine: pulp::x86::V3, &[a, b, c, d]: &[f64; 4]) -> Self {
        Self(machine, pulp::f64x4(a, b, c, d))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64x4(self.1))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0, self.0.abs_f64x4(self.1))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0, self.0.mul_add_f64x4(self.1, factor.1, term.1))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f64x4(other.1, self.1))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f64x4(other.1, self.1))
    }

    #[inline(always)]
    fn select_positive(self, yes: Self, no: Self) -> Self {
        let is_positive = self.0.cmp_gt_f64x4(self.1, self.0.splat_f64x4(0.0));
        Self(self.0, self.0.select_f64x4(is_positive, yes.1, no.1))
    }

    #[inline(always)]
    fn or_if_nan(self, other: Self) -> Self {
        let is_number = self.0.cmp_eq_f64x4(self.1, self.1);
        Self(self.0, self.0.select_f64x4(is_number, self.1, other.1))
    }

    #[inline(always)]
    fn stored(self) -> [f64; 4] {
        let pulp::f64x4(a, b, c, d) = self.1;
        [a, b, c, d]
    }
}

#[inline(always)]
pub(crate) fn sub<F: FourLanes>(a: FourVectors<F>, b: FourVectors<F>) -> FourVectors<F> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn dot<F: FourLanes>(a: FourVectors<F>, b: FourVectors<F>) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross<F: FourLanes>(a: FourVectors<F>, b: FourVectors<F>) -> FourVectors<F> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
