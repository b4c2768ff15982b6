//! Local coordinates: points relative to one of them, in units of a power of two near the size of all
//! together.

use super::Closest;
use crate::base::Point;
use crate::geometry::unit::unit_of;
use crate::geometry::vector::{dot, scale, sub};

/// The unit of local coordinates. The largest local coordinate lies in [1, 2), unless all points coincide.
pub(super) struct Frame {
    pub(super) unit: f64,
}

impl Frame {
    /// Takes the points of both primitives relative to the first of `a`. A difference is rounded to within
    /// half a unit in its last place, so equal points stay equal, and none is off by more than 1.2e-16 of the
    /// extent along any axis.
    #[inline(always)]
    pub(super) fn around<const A: usize, const B: usize>(
        a: [Point; A],
        b: [Point; B],
    ) -> (Self, [Point; A], [Point; B]) {
        let (from_a, from_b) = (a.map(|p| sub(p, a[0])), b.map(|p| sub(p, a[0])));
        let coordinates = from_a.as_flattened().iter().chain(from_b.as_flattened());
        let (unit, per_unit) = unit_of(coordinates);
        (Self { unit }, from_a.map(|p| scale(p, per_unit)), from_b.map(|p| scale(p, per_unit)))
    }

    /// Converts a result back to the caller's units.
    #[inline(always)]
    pub(super) fn closest<const A: usize, const B: usize>(
        &self,
        on_a: [f64; A],
        on_b: [f64; B],
        offset: Point,
    ) -> Closest<A, B> {
        let distance_squared = dot(offset, offset) * self.unit * self.unit;
        Closest { distance_squared, on_a, on_b, offset: scale(offset, self.unit) }
    }
}

/// The point with these weights of the vertices.
#[inline(always)]
pub(super) fn at<const N: usize>(points: &[Point; N], weights: &[f64; N]) -> Point {
    let mut sum = [0.0; 3];
    for (p, w) in points.iter().zip(weights) {
        for (s, x) in sum.iter_mut().zip(p) {
            *s += w * x;
        }
    }
    sum
}

/// The vector from the point with weights `on_a` of `a` to the one with weights `on_b` of `b`.
#[inline(always)]
pub(super) fn offset<const A: usize, const B: usize>(
    a: &[Point; A],
    on_a: &[f64; A],
    b: &[Point; B],
    on_b: &[f64; B],
) -> Point {
    sub(at(b, on_b), at(a, on_a))
}
