//! Integers wide enough for the exact stage: of fixed width, and of any width.
//!
//! An `f64` is an integer times a power of two, so a determinant of coordinates is a determinant of integers
//! times a power of two, and its sign needs no rounding at all. [`Fixed`] serves where the numbers fit (as on
//! every grid), [`Big`] always.

use std::cmp::Ordering;

/// A signed integer of `64 N` bits (two's complement). The caller must ensure that results fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fixed<const N: usize>([u64; N]);

impl<const N: usize> Fixed<N> {
    /// Widens the number to `M` limbs, or narrows it if it fits.
    #[inline]
    pub(crate) fn resized<const M: usize>(self) -> Fixed<M> {
        let fill = if self.0[N - 1] >> 63 == 1 { u64::MAX } else { 0 };
        Fixed(std::array::from_fn(|i| if i < N { self.0[i] } else { fill }))
    }

    #[inline]
    pub(crate) fn plus(self, other: Self) -> Self {
        let mut carry = false;
        Self(std::array::from_fn(|i| {
            let (sum, c1) = self.0[i].overflowing_add(other.0[i]);
            let (sum, c2) = sum.overflowing_add(u64::from(carry));
            carry = c1 | c2;
            sum
        }))
    }

    #[inline]
    pub(crate) fn minus(self, other: Self) -> Self {
        let mut borrow = false;
        Self(std::array::from_fn(|i| {
            let (rest, b1) = self.0[i].overflowing_sub(other.0[i]);
            let (rest, b2) = rest.overflowing_sub(u64::from(borrow));
            borrow = b1 | b2;
            rest
        }))
    }

    /// The product modulo `2^(64 N)`: in two's complement the signs need no special treatment.
    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        let mut product = [0u64; N];
        for i in 0..N {
            let mut carry = 0u64;
            for j in 0..N - i {
                let term = u128::from(self.0[i]) * u128::from(other.0[j])
                    + u128::from(product[i + j])
                    + u128::from(carry);
                product[i + j] = term as u64;
                carry = (term >> 64) as u64;
            }
        }
        Self(product)
    }

    /// -1, 0 or 1
    #[inline]
    pub(crate) fn sign(self) -> i8 {
        if self.0[N - 1] >> 63 == 1 { -1 } else { i8::from(self.0.iter().any(|&limb| limb != 0)) }
    }
}

impl From<i128> for Fixed<2> {
    #[inline]
    fn from(x: i128) -> Self {
        Self([x as u64, (x >> 64) as u64])
    }
}

/// A signed integer of any size: sign and magnitude, least limb first, without leading zero limbs.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(crate) struct Big {
    negative: bool,
    limbs: Vec<u64>,
}

impl Big {
    /// `mantissa * 2^shift`
    pub(crate) fn shifted(mantissa: i64, shift: u32) -> Self {
        let bits = u128::from(mantissa.unsigned_abs()) << (shift % 64);
        let mut limbs = vec![0; (shift / 64) as usize];
        limbs.extend([bits as u64, (bits >> 64) as u64]);
        Self::trimmed(mantissa < 0, limbs)
    }

    fn trimmed(negative: bool, mut limbs: Vec<u64>) -> Self {
        while limbs.last() == Some(&0) {
            limbs.pop();
        }
        Self { negative: negative && !limbs.is_empty(), limbs }
    }

    /// `self + other`
    pub(crate) fn plus(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            return Self::trimmed(self.negative, add(&self.limbs, &other.limbs));
        }
        match compare(&self.limbs, &other.limbs) {
            Ordering::Less => Self::trimmed(other.negative, subtract(&other.limbs, &self.limbs)),
            _ => Self::trimmed(self.negative, subtract(&self.limbs, &other.limbs)),
        }
    }

    /// `-self`
    pub(crate) fn negated(mut self) -> Self {
        self.negative = !self.negative && !self.limbs.is_empty();
        self
    }

    /// `self - other`
    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.clone().negated())
    }

    /// `self * other`
    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut product = vec![0u64; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u64;
            for (j, &b) in other.limbs.iter().enumerate() {
                let term = u128::from(a) * u128::from(b) + u128::from(product[i + j]) + u128::from(carry);
                product[i + j] = term as u64;
                carry = (term >> 64) as u64;
            }
            product[i + other.limbs.len()] = carry;
        }
        Self::trimmed(self.negative != other.negative, product)
    }

    /// -1, 0 or 1
    pub(crate) fn sign(&self) -> i8 {
        if self.limbs.is_empty() { 0 } else { 1 - 2 * i8::from(self.negative) }
    }

    /// The number of bits of the magnitude.
    pub(crate) fn bits(&self) -> u32 {
        self.limbs.last().map_or(0, |top| self.limbs.len() as u32 * 64 - top.leading_zeros())
    }

    /// Returns `self / 2^bits` to the precision of an `f64` (the last digit truncated, not rounded); meant
    /// for `bits` of about [`Self::bits`].
    pub(crate) fn ratio_to_power(&self, bits: u32) -> f64 {
        let magnitude: f64 = self.limbs.iter().enumerate().rev().take(3).fold(0.0, |sum, (i, &limb)| {
            let exponent = (i as i32 * 64 - bits as i32).max(-1100);
            sum + limb as f64 * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
        });
        if self.negative { -magnitude } else { magnitude }
    }
}

fn compare(a: &[u64], b: &[u64]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn add(a: &[u64], b: &[u64]) -> Vec<u64> {
    let (long, short) = if a.len() < b.len() { (b, a) } else { (a, b) };
    let mut sum = Vec::with_capacity(long.len() + 1);
    let mut carry = 0u128;
    for (i, &limb) in long.iter().enumerate() {
        carry += u128::from(limb) + u128::from(short.get(i).copied().unwrap_or(0));
        sum.push(carry as u64);
        carry >>= 64;
    }
    sum.push(carry as u64);
    sum
}

/// `a - b` for `a >= b`.
fn subtract(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    let rest = a.iter().enumerate().map(|(i, &limb)| {
        let (rest, b1) = limb.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (rest, b2) = rest.overflowing_sub(u64::from(borrow));
        borrow = b1 | b2;
        rest
    });
    rest.collect()
}

#[cfg(test)]
mod tests {
    use super::{Big, Fixed};
    use num_bigint::BigInt;
    use proptest::prelude::*;

    fn oracle(x: &Big) -> BigInt {
        let magnitude = x.limbs.iter().rev().fold(BigInt::from(0), |sum, &limb| (sum << 64) + limb);
        if x.negative { -magnitude } else { magnitude }
    }

    fn any_big() -> impl Strategy<Value = Big> {
        (any::<bool>(), prop::collection::vec(prop_oneof![any::<u64>(), Just(0), Just(u64::MAX)], 0..5))
            .prop_map(|(negative, limbs)| Big::trimmed(negative, limbs))
    }

    proptest! {
        #[test]
        fn big_agrees_with_another_library(a in any_big(), b in any_big()) {
            prop_assert_eq!(oracle(&a.plus(&b)), oracle(&a) + oracle(&b));
            prop_assert_eq!(oracle(&a.minus(&b)), oracle(&a) - oracle(&b));
            prop_assert_eq!(oracle(&a.times(&b)), oracle(&a) * oracle(&b));
            prop_assert_eq!(a.minus(&a).sign(), 0);
        }

        #[test]
        fn shifting_multiplies_by_a_power_of_two(m in any::<i64>(), shift in 0u32..300) {
            prop_assert_eq!(oracle(&Big::shifted(m, shift)), BigInt::from(m) << shift);
        }

        #[test]
        fn fixed_agrees_with_big(a in any::<i64>(), b in any::<i128>(), c in any::<i128>()) {
            let big = |x: i128| {
                let high = Big::shifted((x >> 64) as i64, 64);
                high.plus(&Big { negative: false, limbs: vec![x as u64] }).plus(&Big::default())
            };
            let wide = |x: i128| Fixed::<2>::from(x).resized::<5>();
            let fixed = wide(a.into()).times(wide(b)).times(wide(c)).minus(wide(b)).plus(wide(c));
            let same = big(a.into()).times(&big(b)).times(&big(c)).minus(&big(b)).plus(&big(c));
            prop_assert_eq!(fixed.sign(), same.sign());
            let mut limbs = same.limbs.clone();
            limbs.resize(5, 0);
            let magnitude = Fixed::<5>(limbs.try_into().expect("five limbs"));
            let expected = if same.negative { wide(0).minus(magnitude) } else { magnitude };
            prop_assert_eq!(fixed, expected);
        }

        #[test]
        fn a_ratio_has_the_precision_of_a_float(m in 1i64..i64::MAX, shift in 0u32..3000) {
            let big = Big::shifted(m, shift);
            let truth = m as f64 / 2f64.powi(63);
            prop_assert!((big.ratio_to_power(shift + 63) / truth - 1.0).abs() <= f64::EPSILON);
        }
    }
}
