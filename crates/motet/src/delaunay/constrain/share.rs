//! The position of a point along a segment, as a number with twice the digits of an `f64`.
//!
//! Facets around one edge that comes within 1e-16 of a segment meet it at places that an `f64` cannot
//! distinguish, and a point may be needed between them.

use std::cmp::Ordering;

use crate::geometry::predicates::pair::Pair;

/// A fraction of the way from the first end of a segment to its second: the nearest `f64`, and the remainder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share(Pair);

impl Share {
    pub(super) const START: Self = Self::of(0.0);
    pub(super) const END: Self = Self::of(1.0);

    pub(super) const fn of(share: f64) -> Self {
        Self(Pair { high: share, low: 0.0 })
    }

    /// The nearest `f64`.
    pub(super) fn near(self) -> f64 {
        self.0.high
    }

    /// Two numbers whose sum is the fraction.
    pub(super) fn parts(self) -> [f64; 2] {
        [self.0.high, self.0.low]
    }

    /// `self + step`, rounded to twice the digits of an `f64`.
    pub(super) fn plus(self, step: f64) -> Self {
        Self(self.0.plus(Self::of(step).0).normalized())
    }

    /// `self - other`, rounded to an `f64`.
    pub(super) fn minus(self, other: Self) -> f64 {
        self.0.minus(other.0).value()
    }

    /// Compares two fractions by value.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        self.0.high.total_cmp(&other.0.high).then(self.0.low.total_cmp(&other.0.low))
    }
}

#[cfg(test)]
mod tests {
    use super::Share;
    use std::cmp::Ordering;

    #[test]
    fn steps_far_below_the_last_place_count() {
        let third = Share::of(1.0 / 3.0);
        let beyond = third.plus(1e-30);
        assert_eq!((beyond.near(), beyond.parts()), (1.0 / 3.0, [1.0 / 3.0, 1e-30]));
        assert_eq!((beyond.minus(third), third.minus(beyond)), (1e-30, -1e-30));
        assert_eq!((third.order(&beyond), beyond.order(&third)), (Ordering::Less, Ordering::Greater));
        let across = Share::of(0.5).plus(-1e-20).plus(0.25);
        assert_eq!(across.minus(Share::of(0.75)), -1e-20);
        assert_eq!((Share::END.minus(Share::START), Share::END.parts()), (1.0, [1.0, 0.0]));
    }
}
