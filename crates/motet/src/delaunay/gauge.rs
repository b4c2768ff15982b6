//! The conflict test of a tet, prepared once and evaluated often: minors and error bound.
//!
//! One formula serves all tets. With `x` the newcomer relative to the tet's vertex 0, there is a conflict
//! when `normal . x - volume |x|^2 > 0`. For a tet, `normal` and `volume` are the minors of the in-sphere
//! determinant (see `geometry::predicates::insphere`, with the error bounds); for a ghost, `volume` is 0 and
//! `normal` is the outward normal of its hull facet. Storing the minors cuts a test from 60 operations to 12,
//! and spares the branch on ghosts.

use crate::base::Point;
use crate::geometry::fused::{cross, dot, multiply_add};
use crate::geometry::predicates::insphere::{FILTER, minors};
use crate::geometry::predicates::pair::U;
use pulp::Simd;

/// All that the conflict test needs to know of a tet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gauge {
    pub(super) normal: Point,
    pub(super) volume: f64,
    /// The tet's vertex 0, to which `x` is relative.
    pub(super) origin: u32,
    /// `4 * attempt + state` of the last insertion that met the tet, so that nothing is cleared between
    /// insertions.
    pub(super) mark: u32,
    /// Factor of the error bound of the conflict test, `error (reach |x|_1 + |x|^2)`.
    pub(super) error: f32,
    /// Length in the error bound; see `error`.
    pub(super) reach: f32,
}

impl Gauge {
    /// The number of words in which a gauge is stored.
    pub(super) const WORDS: usize = 6;
    /// The word whose lower half is the mark.
    pub(super) const MARK: usize = 5;

    /// The gauge as it is stored: memory that is all zeros need not be touched before its first use.
    #[inline(always)]
    pub(super) fn words(&self) -> [u64; Self::WORDS] {
        let pair = |low: u32, high: f32| u64::from(low) | u64::from(high.to_bits()) << 32;
        let [x, y, z] = self.normal.map(f64::to_bits);
        let volume = self.volume.to_bits();
        [x, y, z, volume, pair(self.origin, self.error), pair(self.mark, self.reach)]
    }

    #[inline(always)]
    pub(super) fn from_words([x, y, z, volume, fifth, sixth]: [u64; Self::WORDS]) -> Self {
        let high = |word: u64| f32::from_bits((word >> 32) as u32);
        Self {
            normal: [x, y, z].map(f64::from_bits),
            volume: f64::from_bits(volume),
            origin: fifth as u32,
            mark: sixth as u32,
            error: high(fifth),
            reach: high(sixth),
        }
    }

    /// Returns `normal . x - volume |x|^2` and its error bound, which excludes underflow.
    #[inline(always)]
    pub(super) fn evaluate<S: Simd>(&self, x: Point) -> (f64, f64) {
        let squared = dot::<S>(x, x);
        let determinant = multiply_add::<S>(-self.volume, squared, dot::<S>(self.normal, x));
        let absolute = x[0].abs() + x[1].abs() + x[2].abs();
        (determinant, f64::from(self.error) * multiply_add::<S>(f64::from(self.reach), absolute, squared))
    }
}

/// Error of a ghost's `normal . x` relative to `|b||c||x|_1`: 8 to 9 u by the count in `insphere`.
const GHOST_FILTER: f64 = 10.0 * U;
/// Makes the error formula for tets serve ghosts, whose bound is linear in `x`: a reach so large that its
/// product with `|x|_1` dwarfs `|x|^2`.
const GHOST_REACH: f64 = 1_099_511_627_776.0; // 2^40
/// Covers the rounding of a bound to `f32`.
const UP: f64 = 1.0 + 1e-6;
/// Replaces bounds too small for an `f32`; with points scaled to a box of 2^24 this concerns tets below 1e-14
/// of the box. Infinity in its place sends every test to exact arithmetic.
pub(super) const LEAST: f32 = f32::MIN_POSITIVE;

/// A vertex relative to vertex 0 of the tets being made.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Arm {
    pub(super) vector: Point,
    pub(super) squared: f64,
    pub(super) length: f64,
}

impl Arm {
    #[inline(always)]
    pub(super) fn new<S: Simd>(vector: Point) -> Self {
        let squared = dot::<S>(vector, vector);
        Self { vector, squared, length: squared.sqrt() }
    }
}

/// The gauge of the tet with the vertex `origin` and these three arms from it.
#[inline(always)]
pub(super) fn of_tet<S: Simd>(origin: u32, [b, c, d]: [&Arm; 3], mark: u32, least: f32) -> Gauge {
    let (normal, volume) = minors::<S>([b.vector, c.vector, d.vector], [b.squared, c.squared, d.squared]);
    let error = (FILTER * UP * (b.length * c.length * d.length)) as f32;
    let reach = ((b.length + c.length + d.length) * UP) as f32;
    Gauge { normal, volume, origin, mark, error: error.max(least), reach: reach.max(LEAST) }
}

/// The gauge of the ghost whose hull facet has the vertex `origin` and these two arms from it.
#[inline(always)]
pub(super) fn of_ghost<S: Simd>(origin: u32, [b, c]: [&Arm; 2], mark: u32, least: f32) -> Gauge {
    let error = (GHOST_FILTER * UP / GHOST_REACH * (b.length * c.length)) as f32;
    let normal = cross::<S>(b.vector, c.vector);
    Gauge { normal, volume: 0.0, origin, mark, error: error.max(least), reach: GHOST_REACH as f32 }
}
