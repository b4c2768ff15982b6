//! Boxes that lie flat around pieces of a surface, eight at a time, and lower bounds of their distances from
//! a point or a box.

use pulp::Simd;

use super::eights::{Boxes, Triangles};
use super::lanes::{Eight, Lanes, cross, dot, load, parts, splat, sub};

/// Eight boxes, each oriented to lie flat around its triangles: `low <= axes x <= high`. A box with `low`
/// above `high` is empty.
///
/// A flat piece of a surface that lies askew fills a thick axis-aligned box. For a point near a tube, 3
/// leaves are examined; with axis-aligned boxes it would be 8.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct OrientedBoxes {
    axes: [[Eight; 3]; 3],
    sides: Boxes,
}

impl OrientedBoxes {
    pub(super) const EMPTY: Self = Self { axes: [[[0.0; 8]; 3]; 3], sides: Boxes::EMPTY };

    /// Squared distances from `p` to each box, up to rounding: 0 inside, infinite for an empty box.
    #[inline(always)]
    pub(super) fn distances_squared<S: Simd>(&self, simd: S, p: [f32; 3]) -> Eight {
        let mut out = [0.0; 8];
        let zero = Lanes::splat(simd, 0.0);
        let p = splat(simd, p);
        for i in 0..parts::<S>() {
            let (low, high) = (load(simd, &self.sides.low, i), load(simd, &self.sides.high, i));
            let mut outside = [zero; 3];
            for axis in 0..3 {
                let x = dot(load(simd, &self.axes[axis], i), p);
                outside[axis] = (low[axis] - x).max(x - high[axis]).max(zero);
            }
            dot(outside, outside).store(&mut out, i);
        }
        out
    }

    /// Squared lower bounds of the distances from an axis-aligned box to each box, up to rounding: how far
    /// apart they are along the axes of the oriented one.
    ///
    /// The other directions that could separate two boxes (Gottschalk, Lin and Manocha 1996, *OBBTree*) are
    /// left out.
    #[inline(always)]
    pub(super) fn distances_squared_to<S: Simd>(&self, simd: S, [low, high]: [[f32; 3]; 2]) -> Eight {
        let mut out = [0.0; 8];
        let zero = Lanes::splat(simd, 0.0);
        let middle = splat(simd, [0, 1, 2].map(|k| 0.5 * low[k] + 0.5 * high[k]));
        let half = splat(simd, [0, 1, 2].map(|k| 0.5 * high[k] - 0.5 * low[k]));
        for i in 0..parts::<S>() {
            let (low, high) = (load(simd, &self.sides.low, i), load(simd, &self.sides.high, i));
            let mut outside = [zero; 3];
            for axis in 0..3 {
                let row = load(simd, &self.axes[axis], i);
                let x = dot(row, middle);
                let reach = dot([row[0].abs(), row[1].abs(), row[2].abs()], half);
                outside[axis] = (low[axis] - x - reach).max(x - reach - high[axis]).max(zero);
            }
            dot(outside, outside).store(&mut out, i);
        }
        out
    }

    /// The direction in which a box is flat, of length at most 1, and the ends of the box along it.
    #[inline(always)]
    pub(super) fn flat(&self, lane: usize) -> ([f32; 3], [f32; 2]) {
        (self.axes[2].map(|x| x[lane]), [self.sides.low[2][lane], self.sides.high[2][lane]])
    }

    /// Makes box `lane` the one around the sound ones of eight triangles.
    #[inline(always)]
    pub(super) fn set<S: Simd>(&mut self, simd: S, lane: usize, triangles: &Triangles, is_sound: u8) {
        let axes = orientation(simd, triangles, is_sound);
        for (axis, row) in axes.into_iter().enumerate() {
            for (k, &x) in row.iter().enumerate() {
                self.axes[axis][k][lane] = x;
            }
            let [low, high] = triangles.along(simd, row);
            self.sides.low[axis][lane] = low;
            self.sides.high[axis][lane] = high;
        }
    }
}

/// Three orthogonal directions of length at most 1: an edge of the first sound triangle, projected along the
/// normal; the direction across both; and the normal of all sound triangles together. With the normal of the
/// first triangle alone, the box is twice as thick, and searches take 6 % longer.
#[inline(always)]
fn orientation<S: Simd>(simd: S, triangles: &Triangles, is_sound: u8) -> [[f32; 3]; 3] {
    // Below 1 by more than the rounding of what follows.
    const SHORT: f32 = 1.0 - 4e-6;
    let product = |x: [f32; 3], y: [f32; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let short = |x: [f32; 3]| {
        let per_length = SHORT / product(x, x).sqrt();
        [x[0] * per_length, x[1] * per_length, x[2] * per_length]
    };
    let normal = short(area_vector(simd, triangles));
    let lane = is_sound.trailing_zeros() as usize & 7;
    let [a, b] = [0, 1].map(|k| [0, 1, 2].map(|axis| triangles.corners[k][axis][lane]));
    let edge = short([b[0] - a[0], b[1] - a[1], b[2] - a[2]]);
    let up = product(normal, edge);
    let along = short([0, 1, 2].map(|axis| edge[axis] - up * normal[axis]));
    let across = short([
        normal[1] * along[2] - normal[2] * along[1],
        normal[2] * along[0] - normal[0] * along[2],
        normal[0] * along[1] - normal[1] * along[0],
    ]);
    // False for triangles without area, and for NaN.
    let is_right = |x, y| product(x, y).abs() < 1e-6;
    let is_long = |x| product(x, x) > 0.9;
    let is_orthogonal = is_right(along, normal) && is_right(along, across) && is_right(normal, across);
    if is_orthogonal && is_long(along) && is_long(normal) && is_long(across) {
        [along, across, normal]
    } else {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    }
}

/// Twice the area vector of all triangles together, ignoring those with a corner that is NaN.
#[inline(always)]
fn area_vector<S: Simd>(simd: S, triangles: &Triangles) -> [f32; 3] {
    let mut out = [0.0; 3];
    let (zero, infinite) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, f32::INFINITY));
    for i in 0..parts::<S>() {
        let a = load(simd, &triangles.corners[0], i);
        let ab = sub(load(simd, &triangles.corners[1], i), a);
        let ac = sub(load(simd, &triangles.corners[2], i), a);
        let area = cross(ab, ac);
        for axis in 0..3 {
            out[axis] += area[axis].select_below(infinite, area[axis], zero).sum();
        }
    }
    out
}
