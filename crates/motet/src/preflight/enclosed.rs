//! The side that a closed surface faces: the sign of the volume that it encloses, proven.

use std::cmp::Ordering;

use pulp::Scalar;

use crate::base::{Point, VertexId};
use crate::geometry::predicates::pair::{Pair, U, cross, difference, dot};
use crate::geometry::unit::unit_of;
use crate::geometry::vector::in_range;
use crate::geometry::vector::scale;

/// An upper bound of the underflow per triangle, with coordinates below 2.
const UNDERFLOW: f64 = 1e-290;

/// The sign of the volume that closed triangles enclose: `Greater` if they face outward. `Equal` if it is
/// zero, or too small to be certain of (with 100,000 triangles, below 1e-21 of the summed magnitudes of the
/// volumes of the cones from one of the vertices to the triangles): then neither side is the inside. `None`
/// if a corner is not finite.
pub(super) fn volume_sign(points: &[Point], triangles: &[[VertexId; 3]]) -> Option<Ordering> {
    let at = |v: VertexId| points[v.index()];
    let all = || triangles.iter().flatten().map(|&v| at(v));
    if !all().all(in_range) {
        return None;
    }
    let Some(origin) = all().next() else { return Some(Ordering::Equal) };
    let (_, per_unit) = unit_of(triangles.iter().flatten().flat_map(|v| &points[v.index()]));
    let local = |v: VertexId| difference(scale(at(v), per_unit), scale(origin, per_unit));
    let (mut sum, mut absolute) = (Pair { high: 0.0, low: 0.0 }, 0.0);
    for &[a, b, c] in triangles {
        let [a, b, c] = [local(a), local(b), local(c)];
        let term = dot::<Scalar>(cross::<Scalar>(a, b), c);
        sum = sum.plus(term);
        absolute += permanent([a, b, c].map(|p| p.map(|x| x.high.abs())));
    }
    let value = sum.value();
    if value.abs() <= bound(triangles.len(), absolute) {
        return Some(Ordering::Equal);
    }
    Some(if value > 0.0 { Ordering::Greater } else { Ordering::Less })
}

/// The permanent: the determinant with all its six terms added.
fn permanent([a, b, c]: [Point; 3]) -> f64 {
    let minor = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
    minor(1, 2) * c[0] + minor(2, 0) * c[1] + minor(0, 1) * c[2]
}

/// A bound on the rounding error of the sum, by the rules in `pair`: a term is off by at most 53 u^2 of its
/// permanent, and each of `n` sums adds 2 k + 1 to that and 1 to k, which starts at 8; the factor 2 covers
/// the rounding of the permanents.
fn bound(n: usize, absolute: f64) -> f64 {
    let n = n as f64;
    (53.0 + n * (n + 41.0)) * 2.0 * U * U * absolute + n * UNDERFLOW
}
