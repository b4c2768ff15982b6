//! Decides whether a newcomer lies inside the circumsphere of a tet, or beyond the hull facet of a ghost.

use super::store::{Tets, is_ghost};
use crate::base::Point;
use crate::geometry::predicates::insphere::{UNDERFLOW, beyond_filter};
use crate::geometry::predicates::{break_tie, orient};
use crate::geometry::vector::sub;
use pulp::{Simd, WithSimd};

/// Seen but not yet tested. States of a tet are added to `4 * attempt` in its mark.
pub(super) const PENDING: u32 = 0;
/// Tested: no conflict.
pub(super) const OUT: u32 = 1;
/// Tested: in conflict, a tet of the cavity.
pub(super) const IN: u32 = 2;

/// The point that is being inserted.
#[derive(Clone, Copy)]
pub(super) struct Newcomer {
    pub(super) vertex: u32,
    pub(super) point: Point,
    /// The number of this attempt to insert a point; each has a larger one than those before that met the
    /// same tets. Points are inserted at most once, and fail at most as often: so marks fit into 32 bits.
    pub(super) attempt: u32,
}

/// The mark of tets that may not be touched: their vertices belong to different parts of space.
pub(super) const FROZEN: u32 = u32::MAX;

impl Newcomer {
    /// The least mark that belongs to this attempt.
    #[inline(always)]
    pub(super) fn mark(self) -> u32 {
        4 * self.attempt
    }
}

/// Whether `tet` is in conflict with the newcomer. Ties count as no conflict while the newcomer has the
/// highest number: it is lifted by the largest infinitesimal.
#[inline(always)]
pub(super) fn in_conflict<S: Simd>(simd: S, tets: Tets, points: &[Point], tet: u32, new: Newcomer) -> bool {
    let (determinant, bound) = estimate::<S>(tets, points, tet, new);
    // One branch, rarely taken: the sign itself is unpredictable and stays a number.
    if determinant.abs() > bound + UNDERFLOW {
        return determinant > 0.0;
    }
    simd.vectorize(Doubtful { tets, points, tet, new, bound })
}

/// The determinant whose sign decides, and a bound on its error that excludes underflow.
#[inline(always)]
fn estimate<S: Simd>(tets: Tets, points: &[Point], tet: u32, new: Newcomer) -> (f64, f64) {
    let gauge = tets.gauges.get(tet);
    gauge.evaluate::<S>(sub(new.point, points[gauge.origin as usize]))
}

/// A test that `f64` could not decide; not inlined, but compiled with the instructions of `S`.
struct Doubtful<'a> {
    tets: Tets<'a>,
    points: &'a [Point],
    tet: u32,
    new: Newcomer,
    bound: f64,
}

impl WithSimd for Doubtful<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        if is_ghost(self.tets.vertices.get(self.tet)) { self.ghost(simd) } else { self.tet::<S>() }
    }
}

impl Doubtful<'_> {
    #[inline(always)]
    fn tet<S: Simd>(&self) -> bool {
        let [a, b, c, d] = self.tets.corners(self.points, self.tet);
        match beyond_filter::<S>(a, b, c, d, self.new.point, self.bound) {
            0 => self.tie([a, b, c, d]),
            sign => sign > 0,
        }
    }

    /// Breaks the tie of five cospherical points: some seven per newcomer on a grid, hardly any elsewhere.
    fn tie(&self, [a, b, c, d]: [Point; 4]) -> bool {
        let [i, j, k, l] = self.tets.vertices.get(self.tet);
        let new = self.new;
        if new.vertex > i.max(j).max(k).max(l) {
            return false;
        }
        break_tie([a, b, c, d, new.point], [i, j, k, l, new.vertex]) > 0
    }

    /// Whether the newcomer lies beyond the hull facet; or in its plane and inside its circumcircle, that is,
    /// inside the sphere of the tet behind it.
    fn ghost<S: Simd>(&self, simd: S) -> bool {
        let [a, b, c, _] = self.tets.corners(self.points, self.tet);
        let side = orient::beyond_filter(a, b, c, self.new.point);
        if side != 0 {
            return side > 0;
        }
        let behind = self.tets.links.get(self.tet)[3] >> 2;
        match self.tets.gauges.mark(behind).wrapping_sub(self.new.mark()) {
            IN => true,
            OUT => false,
            _ => in_conflict_flat(simd, self.tets, self.points, behind, self.new),
        }
    }
}

/// Stands in for [`in_conflict`] for a tet that is not a ghost; without it the two functions would be
/// mutually recursive to the compiler.
#[inline(always)]
fn in_conflict_flat<S: Simd>(_: S, tets: Tets, points: &[Point], tet: u32, new: Newcomer) -> bool {
    let (determinant, bound) = estimate::<S>(tets, points, tet, new);
    if determinant.abs() > bound + UNDERFLOW {
        return determinant > 0.0;
    }
    Doubtful { tets, points, tet, new, bound }.tet::<S>()
}
