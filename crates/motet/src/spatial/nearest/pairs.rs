//! The nearest pair of triangles of two surfaces: which pairs are worth an exact look.
//!
//! Each leaf of one tree goes down the other as a box. What two triangles are apart is the caller's to say.

use pulp::{Simd, WithSimd};

use super::eights::{Boxes, ROUNDING, ROUNDING_OF_SQUARE};
use super::lanes::at_most;
use super::packed::{Frame, Packed};
use super::search::{ROUNDING_OF_EXACT, UNDERFLOW};

/// A box of `f64` beyond `f32` has no place in sums of squares.
const MOST: f64 = 1e38;

/// The search over all leaves of `from`.
pub(super) struct Pairs<'a, F> {
    pub(super) from: &'a Packed,
    pub(super) to: &'a Packed,
    /// What is not nearer than its root does not count.
    pub(super) reach: f64,
    pub(super) pair: F,
}

impl<F: FnMut(u32, u32, f64) -> Option<f64>> WithSimd for Pairs<'_, F> {
    type Output = Option<(f64, u32, u32)>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let mut best = None;
        if self.to.leaves.is_empty() {
            return best;
        }
        let mut open = Vec::new();
        for leaf in 0..self.from.leaves.len() {
            let boxes = self.from.leaves[leaf].boxes();
            let (low, high) = boxes.around();
            if self.from.is_sound[leaf] == 0 {
                continue;
            }
            let around = framed(&self.from.frame, &self.to.frame, [low, high]);
            open.clear();
            open.push(0);
            while let Some(node) = open.pop() {
                let bound = self.bound(around);
                let (bounds, first) = match self.to.within(node) {
                    Ok(within) => (within.0.distances_squared_to(simd, around), within.1),
                    Err(other) => {
                        self.look_into(simd, leaf, &boxes, other, &mut best);
                        continue;
                    }
                };
                let mut near = at_most(simd, &bounds, bound);
                while near != 0 {
                    open.push(first + near.trailing_zeros());
                    near &= near - 1;
                }
            }
        }
        best
    }
}

impl<F: FnMut(u32, u32, f64) -> Option<f64>> Pairs<'_, F> {
    /// What has a lower bound above this is farther than `reach`, whatever rounding did.
    #[inline(always)]
    fn bound(&self, around: [[f32; 3]; 2]) -> f32 {
        let (from, to) = (&self.from.frame, &self.to.frame);
        let size = around.iter().flatten().fold(0.0, |most: f64, x| most.max(f64::from(x.abs())));
        let exact = (ROUNDING_OF_EXACT * (from.largest + to.largest) + UNDERFLOW) * to.scale;
        let rounding = ROUNDING * (1.0 + size + to.scale / from.scale) + exact;
        let reach = self.reach.sqrt() * to.scale + rounding;
        let bound = reach * reach * (1.0 + 2.0 * ROUNDING_OF_SQUARE);
        if bound < MOST { bound as f32 } else { MOST as f32 }
    }

    /// All pairs of two leaves whose boxes are near enough.
    #[inline(always)]
    fn look_into<S: Simd>(
        &mut self,
        simd: S,
        leaf: usize,
        boxes: &Boxes,
        other: usize,
        best: &mut Option<(f64, u32, u32)>,
    ) {
        let others = self.to.leaves[other].boxes();
        for lane in (0..8).filter(|lane| self.from.is_sound[leaf] >> lane & 1 == 1) {
            let around = framed(&self.from.frame, &self.to.frame, boxes.get(lane));
            let bounds = others.distances_squared_to(simd, around);
            let mut near = at_most(simd, &bounds, self.bound(around)) & u32::from(self.to.is_sound[other]);
            while near != 0 {
                let place = 8 * other + near.trailing_zeros() as usize;
                near &= near - 1;
                let (i, j) = (self.from.ids[8 * leaf + lane], self.to.ids[place]);
                let Some(distance_squared) = (self.pair)(i, j, self.reach) else { continue };
                let is_better = best.is_none_or(|best| (distance_squared, i, j) < best);
                if distance_squared <= self.reach && is_better {
                    self.reach = distance_squared;
                    *best = Some((distance_squared, i, j));
                }
            }
        }
    }
}

/// A box of one frame in another.
#[inline(always)]
fn framed(from: &Frame, to: &Frame, corners: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    corners.map(|x| to.of(from.back(x)))
}
