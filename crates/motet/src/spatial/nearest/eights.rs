//! Eight boxes or eight triangles at a time, and lower bounds of their distances from a point.
//!
//! Everything here is in 32 bits, in units in which the surface fits between -1 and 1. So an instruction
//! processes eight numbers instead of four, and half as much memory is read. Rounding changes a distance by
//! at most [`ROUNDING`] per unit.

use pulp::Simd;

use super::lanes::{Eight, Lanes, Vector, cross, dot, load, parts, splat, sub};

/// The unit round-off: half the distance from 1 to the next `f32`.
const U: f64 = 1.0 / 16_777_216.0;

/// How far a lower bound can exceed the distance, or an upper one fall below it, relative to 1 + the largest
/// coordinate of the point. Coordinates are rounded: `sqrt(3) U` for the point and for the surface. A
/// triangle: three scalar products of vectors up to `3 sqrt(3)` long in all, 5 U of that, `26 U`; with the
/// point at `s`, its difference to a point of the triangle is off by `(3 s + 11) U` per axis, and that point
/// lies off the triangle by `6 U` per axis. An oriented box: 3 U of `sqrt(3)` for the point and as much for
/// its sides, `18 U` along the three axes.
pub(super) const ROUNDING: f64 = 32.0 * U;

/// The relative rounding error of the square of a bound.
pub(super) const SQUARE_ROUNDING: f64 = 16.0 * U;

/// The largest coordinate for slabs: the square of a normal times a corner, `24 x^3`, must not overflow 32
/// bits.
pub(super) const MAX_SLAB_COORDINATE: f64 = 1e5;

/// Eight axis-aligned boxes. A box with `low` above `high` is empty.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Boxes {
    pub(super) low: [Eight; 3],
    pub(super) high: [Eight; 3],
}

impl Boxes {
    pub(super) const EMPTY: Self = Self { low: [[f32::INFINITY; 8]; 3], high: [[f32::NEG_INFINITY; 8]; 3] };

    /// Squared distances from `p` to each box: 0 inside, infinite for an empty box.
    #[inline(always)]
    pub(super) fn distances_squared<S: Simd>(&self, simd: S, p: [f32; 3]) -> Eight {
        self.distances_squared_to(simd, [p, p])
    }

    /// Squared distances from a box, given by its corners, to each box: 0 where they touch, infinite for an
    /// empty box.
    #[inline(always)]
    pub(super) fn distances_squared_to<S: Simd>(&self, simd: S, [low, high]: [[f32; 3]; 2]) -> Eight {
        let mut out = [0.0; 8];
        let zero = Lanes::splat(simd, 0.0);
        let (to_low, to_high) = (splat(simd, low), splat(simd, high));
        for i in 0..parts::<S>() {
            let (low, high) = (load(simd, &self.low, i), load(simd, &self.high, i));
            let mut outside = [zero; 3];
            for axis in 0..3 {
                outside[axis] = (low[axis] - to_high[axis]).max(to_low[axis] - high[axis]).max(zero);
            }
            dot(outside, outside).store(&mut out, i);
        }
        out
    }

    /// The box around all of them.
    pub(super) fn around(&self) -> ([f32; 3], [f32; 3]) {
        let least = |eight: Eight| eight.into_iter().fold(f32::INFINITY, f32::min);
        let most = |eight: Eight| eight.into_iter().fold(f32::NEG_INFINITY, f32::max);
        (self.low.map(least), self.high.map(most))
    }

    /// The box around some of them, which are selected by bits.
    #[inline(always)]
    pub(super) fn around_some(&self, mut which: u32) -> [[f32; 3]; 2] {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        while which != 0 {
            let lane = which.trailing_zeros() as usize & 7;
            which &= which - 1;
            for axis in 0..3 {
                low[axis] = smaller(self.low[axis][lane], low[axis]);
                high[axis] = larger(self.high[axis][lane], high[axis]);
            }
        }
        [low, high]
    }

    pub(super) fn get(&self, lane: usize) -> [[f32; 3]; 2] {
        [self.low.map(|eight| eight[lane]), self.high.map(|eight| eight[lane])]
    }

    pub(super) fn set(&mut self, lane: usize, (low, high): ([f32; 3], [f32; 3])) {
        for axis in 0..3 {
            self.low[axis][lane] = low[axis];
            self.high[axis][lane] = high[axis];
        }
    }
}

/// The smaller of two numbers, in one instruction; `f32::min` heeds NaN and takes three.
#[inline(always)]
pub(super) fn smaller(x: f32, y: f32) -> f32 {
    if x < y { x } else { y }
}

#[inline(always)]
pub(super) fn larger(x: f32, y: f32) -> f32 {
    if x > y { x } else { y }
}

/// Eight triangles: coordinates by corner and axis.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Triangles {
    pub(super) corners: [[Eight; 3]; 3],
}

impl Triangles {
    pub(super) const NONE: Self = Self { corners: [[[f32::NAN; 8]; 3]; 3] };

    /// The box around each triangle; arbitrary for one with a corner that is NaN.
    #[inline(always)]
    pub(super) fn boxes<S: Simd>(&self, simd: S) -> Boxes {
        let mut boxes = Boxes::EMPTY;
        for axis in 0..3 {
            for i in 0..parts::<S>() {
                let a = Lanes::load(simd, &self.corners[0][axis], i);
                let b = Lanes::load(simd, &self.corners[1][axis], i);
                let c = Lanes::load(simd, &self.corners[2][axis], i);
                a.min(b).min(c).store(&mut boxes.low[axis], i);
                a.max(b).max(c).store(&mut boxes.high[axis], i);
            }
        }
        boxes
    }

    /// The interval that the corners cover along a direction, ignoring those that are NaN.
    #[inline(always)]
    pub(super) fn along<S: Simd>(&self, simd: S, direction: [f32; 3]) -> [f32; 2] {
        let direction = splat(simd, direction);
        let mut low = Lanes::splat(simd, f32::INFINITY);
        let mut high = Lanes::splat(simd, f32::NEG_INFINITY);
        for i in 0..parts::<S>() {
            for corner in &self.corners {
                let x = dot(direction, load(simd, corner, i));
                (low, high) = (x.min(low), x.max(high));
            }
        }
        [low.reduce_min(), high.reduce_max()]
    }

    /// Squared lower bounds of the distances from `p` to each triangle, up to rounding (mostly equal to the
    /// distances), and a squared upper bound of the least distance, infinite if there is no triangle.
    ///
    /// Along any direction `u`, the triangle is no nearer than the nearest of its corners. So the bound holds
    /// however `u` was found and rounded; the better `u` points to the closest point, the better the bound.
    /// The closest point is that of the plane if it lies in the triangle (Ericson 2005, *Real-Time Collision
    /// Detection*, section 3.4), or else the best of those of the edges; all are computed from five scalar
    /// products. In any case `u` leads to a point of the triangle, so its length is an upper bound.
    #[inline(always)]
    pub(super) fn bounds_squared<S: Simd>(&self, simd: S, p: [f32; 3]) -> (Eight, f32) {
        let mut out = [0.0; 8];
        let mut above = Lanes::splat(simd, f32::INFINITY);
        let p = splat(simd, p);
        let (zero, one) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 1.0));
        for i in 0..parts::<S>() {
            let a = load(simd, &self.corners[0], i);
            let ab = sub(load(simd, &self.corners[1], i), a);
            let ac = sub(load(simd, &self.corners[2], i), a);
            let ap = sub(p, a);
            let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
            let (pb, pc) = (dot(ab, ap), dot(ac, ap));
            // The closest point is a + v ab + w ac. On an edge its parameter is between 0 and 1; the squared
            // distance is that of a plus a height, the least of which is wanted.
            let v1 = (pb / bb).max(zero).min(one);
            let w2 = (pc / cc).max(zero).min(one);
            let w3 = ((bb - bc + pc - pb) / (bb - bc + cc - bc)).max(zero).min(one);
            let v3 = one - w3;
            let height1 = v1 * (v1 * bb - pb - pb);
            let height2 = w2 * (w2 * cc - pc - pc);
            let height3 = v3.mul_add(v3 * bb + (w3 * bc - pb) + (w3 * bc - pb), w3 * (w3 * cc - pc - pc));
            let is_first = |x: Lanes<S>, y: Lanes<S>| height1.select_below(height2, x, y);
            let (mut v, mut w) = (is_first(v1, zero), is_first(zero, w2));
            let height = is_first(height1, height2);
            v = height3.select_below(height, v3, v);
            w = height3.select_below(height, w3, w);
            let per_area = one / (bb * cc - bc * bc);
            let v0 = (cc * pb - bc * pc) * per_area;
            let w0 = (bb * pc - bc * pb) * per_area;
            let least = v0.min(w0).min(one - v0 - w0);
            // NaN, from triangles without area, is not above zero.
            v = zero.select_below(least, v0, v);
            w = zero.select_below(least, w0, w);
            let mut u = [zero; 3];
            for axis in 0..3 {
                u[axis] = ap[axis] - v * ab[axis] - w * ac[axis];
            }
            let nearest_corner = dot(ap, u) - dot(ab, u).max(dot(ac, u)).max(zero);
            // Also disregards lengths that underflow.
            let square = dot(u, u) + Lanes::splat(simd, 1e-30);
            above = square.select_below(above, square, above);
            let along = nearest_corner.max(zero);
            (along * along / square).store(&mut out, i);
        }
        (out, above.reduce_min())
    }

    /// Squared lower bounds of the distances of each triangle from another one, up to rounding.
    ///
    /// Triangles are at least as far apart as their projections onto any direction. Two directions are tried:
    /// the normal of the other triangle, and the vector between the centroids. No coordinate may be above
    /// [`MAX_SLAB_COORDINATE`].
    #[inline(always)]
    pub(super) fn slabs_squared<S: Simd>(&self, simd: S, other: [[f32; 3]; 3]) -> Eight {
        let mut out = [0.0; 8];
        let other = other.map(|corner| splat(simd, corner));
        let normal = cross(sub(other[1], other[0]), sub(other[2], other[0]));
        for i in 0..parts::<S>() {
            let own = [
                load(simd, &self.corners[0], i),
                load(simd, &self.corners[1], i),
                load(simd, &self.corners[2], i),
            ];
            let mut between = [Lanes::splat(simd, 0.0); 3];
            for axis in 0..3 {
                between[axis] = (own[0][axis] - other[0][axis])
                    + (own[1][axis] - other[1][axis])
                    + (own[2][axis] - other[2][axis]);
            }
            let bound = slab_squared(simd, normal, own, other);
            bound.max(slab_squared(simd, between, own, other)).store(&mut out, i);
        }
        out
    }
}

/// The squared distance of the projections of two triangles onto a direction.
#[inline(always)]
fn slab_squared<S: Simd>(simd: S, along: Vector<S>, a: [Vector<S>; 3], b: [Vector<S>; 3]) -> Lanes<S> {
    let [a0, a1, a2] = [dot(along, a[0]), dot(along, a[1]), dot(along, a[2])];
    let [b0, b1, b2] = [dot(along, b[0]), dot(along, b[1]), dot(along, b[2])];
    let above = a0.min(a1).min(a2) - b0.max(b1).max(b2);
    let below = b0.min(b1).min(b2) - a0.max(a1).max(a2);
    let apart = above.max(below).max(Lanes::splat(simd, 0.0));
    // Lengths that underflow are disregarded.
    apart * apart / (dot(along, along) + Lanes::splat(simd, 1e-30))
}
