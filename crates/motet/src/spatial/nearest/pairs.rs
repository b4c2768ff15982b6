//! The nearest pair of triangles of two surfaces: which pairs are worth an exact look.
//!
//! Each leaf of one tree goes down the other as a box. What two triangles are apart is the caller's to say.

use pulp::{Simd, WithSimd};

use super::eights::{Boxes, MOST_OF_SLABS, ROUNDING, ROUNDING_OF_SQUARE};
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
            if self.from.is_sound[leaf] == 0 {
                continue;
            }
            let own = self.leaf(simd, leaf);
            open.clear();
            open.push(0);
            while let Some(node) = open.pop() {
                let bound = self.bound(&own);
                let (bounds, first) = match self.to.within(simd, node) {
                    Ok(within) => (within.0.distances_squared_to(simd, own.around), within.1),
                    Err(other) => {
                        self.look_into(simd, &own, other, &mut best);
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
    /// A leaf of `from` in the frame of `to`.
    #[inline(always)]
    fn leaf<S: Simd>(&self, simd: S, leaf: usize) -> Leaf {
        let (from, to) = (&self.from.frame, &self.to.frame);
        let boxes = self.from.leaves[leaf].boxes(simd);
        let around = framed(from, to, boxes.around_some(self.from.is_sound[leaf].into()));
        let mut own = Boxes::EMPTY;
        for lane in (0..8).filter(|lane| self.from.is_sound[leaf] >> lane & 1 == 1) {
            own.set(lane, framed(from, to, boxes.get(lane)).into());
        }
        let size = around.iter().flatten().fold(0.0, |most: f64, x| most.max(f64::from(x.abs())));
        let exact = (ROUNDING_OF_EXACT * (from.largest + to.largest) + UNDERFLOW) * to.scale;
        let rounding = ROUNDING * (1.0 + size + to.scale / from.scale) + exact;
        Leaf { place: leaf, around, boxes: own, rounding, is_far: size > MOST_OF_SLABS }
    }

    /// What has a lower bound above this is farther than `reach`, whatever rounding did.
    #[inline(always)]
    fn bound(&self, own: &Leaf) -> f32 {
        let reach = self.reach.sqrt() * self.to.frame.scale + own.rounding;
        let bound = reach * reach * (1.0 + 2.0 * ROUNDING_OF_SQUARE);
        if bound < MOST { bound as f32 } else { MOST as f32 }
    }

    /// All pairs of two leaves whose boxes are near enough, and whose triangles are not clearly farther.
    #[inline(always)]
    fn look_into<S: Simd>(&mut self, simd: S, own: &Leaf, other: usize, best: &mut Option<(f64, u32, u32)>) {
        let others = &self.to.leaves[other];
        let boxes = others.boxes(simd);
        let bound = self.bound(own);
        let around = boxes.distances_squared_to(simd, own.around);
        let theirs = at_most(simd, &around, bound) & u32::from(self.to.is_sound[other]);
        if theirs == 0 {
            return;
        }
        let ours = own.boxes.distances_squared_to(simd, boxes.around_some(theirs));
        let mut ours = at_most(simd, &ours, bound);
        while ours != 0 {
            let lane = ours.trailing_zeros() as usize & 7;
            ours &= ours - 1;
            let bounds = boxes.distances_squared_to(simd, own.boxes.get(lane));
            let mut near = at_most(simd, &bounds, bound) & theirs;
            if near == 0 {
                continue;
            }
            if !own.is_far {
                let corners = self.from.leaves[own.place].corners.map(|corner| corner.map(|axis| axis[lane]));
                let corners = corners.map(|x| self.to.frame.of(self.from.frame.back(x)));
                near &= at_most(simd, &others.slabs_squared(simd, corners), bound);
            }
            while near != 0 {
                let place = 8 * other + near.trailing_zeros() as usize;
                near &= near - 1;
                let (i, j) = (self.from.ids[8 * own.place + lane], self.to.ids[place]);
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

/// A leaf that goes down the other tree.
struct Leaf {
    place: usize,
    /// Around all its sound triangles.
    around: [[f32; 3]; 2],
    /// Around each; nothing around those that are not sound.
    boxes: Boxes,
    /// How far rounding may bring a bound off.
    rounding: f64,
    /// Too far off in the frame of `to` for slabs.
    is_far: bool,
}

/// A box of one frame in another.
#[inline(always)]
fn framed(from: &Frame, to: &Frame, corners: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    corners.map(|x| to.of(from.back(x)))
}
