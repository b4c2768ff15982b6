//! The conflict test of a tet, prepared once and asked often: minors and error bound.
//!
//! One formula for all tets, with `x` the newcomer relative to the tet's vertex 0: conflict when
//! `normal . x - volume |x|^2 > 0`. For a tet these are the minors of the in-sphere determinant (see
//! `geometry::predicates::insphere`, with the error bounds); for a ghost `volume = 0` and `normal` that of its hull facet,
//! outward. Storing the minors replaces 60 operations a test by 12, and a branch on ghosts by none.

use crate::base::Point;
use crate::geometry::predicates::insphere::FILTER;
use crate::geometry::predicates::pair::U;
use crate::geometry::vector::{cross, dot};

/// The stored part of the in-sphere determinant.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Minors {
    pub(super) normal: Point,
    pub(super) volume: f64,
}

impl Minors {
    pub(super) const ZERO: Self = Self { normal: [0.0; 3], volume: 0.0 };
}

/// What the conflict test finds out about a tet, and how sure the test is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gauge {
    /// `4 * newcomer + state` of the last newcomer that met the tet: no clearing between insertions.
    pub(super) mark: u32,
    /// Error bound of the conflict test is `error (reach |x|_1 + |x|^2)`.
    pub(super) error: f32,
    /// See `error`.
    pub(super) reach: f32,
}

impl Gauge {
    pub(super) const FREE: Self = Self { mark: 0, error: 0.0, reach: 0.0 };
}

/// Error of `normal . x` of a ghost over `|b||c||x|_1`: 8 to 9 u by the count in `insphere`.
const GHOST_FILTER: f64 = 10.0 * U;
/// Makes a ghost's bound, which is linear in `x`, out of the formula for tets: a reach so large that
/// its product with `|x|_1` dwarfs `|x|^2`.
const GHOST_REACH: f64 = 1_099_511_627_776.0; // 2^40
/// Covers the rounding of a bound to `f32`.
const UP: f64 = 1.0 + 1e-6;
/// Stands in for bounds too small for an `f32`; with points scaled to a box of 2^24 that concerns tets
/// below 1e-14 of the box. Infinity in its place sends every test to exact arithmetic.
pub(super) const LEAST: f32 = f32::MIN_POSITIVE;

/// A vertex relative to vertex 0 of the tets being made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    pub(super) vector: Point,
    pub(super) squared: f64,
    pub(super) length: f64,
}

impl Arm {
    #[inline(always)]
    pub(super) fn new(vector: Point) -> Self {
        let squared = dot(vector, vector);
        Self { vector, squared, length: squared.sqrt() }
    }
}

/// Minors and gauge of the tet with these three arms.
#[inline(always)]
pub(super) fn of_tet([b, c, d]: [&Arm; 3], mark: u32, least: f32) -> (Minors, Gauge) {
    let cd = cross(c.vector, d.vector);
    let db = cross(d.vector, b.vector);
    let bc = cross(b.vector, c.vector);
    let normal = std::array::from_fn(|i| b.squared * cd[i] + c.squared * db[i] + d.squared * bc[i]);
    let volume = dot(b.vector, cd);
    let error = (FILTER * UP * (b.length * c.length * d.length)) as f32;
    let reach = ((b.length + c.length + d.length) * UP) as f32;
    (Minors { normal, volume }, Gauge { mark, error: error.max(least), reach: reach.max(LEAST) })
}

/// Minors and gauge of the ghost whose hull facet has these two arms.
#[inline(always)]
pub(super) fn of_ghost([b, c]: [&Arm; 2], mark: u32, least: f32) -> (Minors, Gauge) {
    let error = (GHOST_FILTER * UP / GHOST_REACH * (b.length * c.length)) as f32;
    let minors = Minors { normal: cross(b.vector, c.vector), volume: 0.0 };
    (minors, Gauge { mark, error: error.max(least), reach: GHOST_REACH as f32 })
}

/// `normal . x - volume |x|^2` and its error bound without underflow.
#[inline(always)]
pub(super) fn evaluate(minors: &Minors, gauge: &Gauge, x: Point) -> (f64, f64) {
    let squared = dot(x, x);
    let reach = f64::from(gauge.reach) * (x[0].abs() + x[1].abs() + x[2].abs());
    (dot(minors.normal, x) - minors.volume * squared, f64::from(gauge.error) * (reach + squared))
}
