//! The nearest pair of triangles of two surfaces: finds the pairs that are worth an exact computation.
//!
//! Eight leaves of one tree descend the other together, as one box. Two leaves are then compared along the
//! direction in which each lies flat, which separates most surfaces that are a small gap apart. The caller
//! computes the distance of two triangles.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use pulp::{Simd, WithSimd};

use super::eights::{Boxes, MAX_SLAB_COORDINATE, ROUNDING, Triangles, larger};
use super::lanes::at_most;
use super::packed::{MAX_COORDINATE, Packed};
use super::search::{EXACT_ROUNDING, UNDERFLOW, bound};
use crate::geometry::vector::{scale, sub};

/// The square of the smallest distance so far, shared by all threads. A thread that reads it late examines
/// more pairs, but finds the same result.
pub(super) struct Reach(AtomicU64);

impl Reach {
    pub(super) fn new(start: f64) -> Self {
        Self(AtomicU64::new(start.to_bits()))
    }

    #[inline(always)]
    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Relaxed))
    }

    /// Lowers the reach to `to` if that is smaller. Bits of non-negative numbers are in the order of the
    /// numbers.
    fn lower(&self, to: f64) {
        self.0.fetch_min(to.to_bits(), Relaxed);
    }
}

/// The search from some groups of eight leaves of `from`.
pub(super) struct PairSearch<'a, F> {
    pub(super) from: &'a Packed,
    pub(super) to: &'a Packed,
    pub(super) eights: Range<usize>,
    /// The square of the distance beyond which pairs do not count.
    pub(super) reach: &'a Reach,
    pub(super) pair: F,
}

impl<F: FnMut(u32, u32, f64) -> Option<f64>> WithSimd for PairSearch<'_, F> {
    type Output = Option<(f64, u32, u32)>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let mut best = None;
        if self.to.leaves.is_empty() {
            return best;
        }
        let (mut open, mut nearby) = (Vec::new(), Vec::new());
        for eight in self.eights.clone() {
            self.descend(simd, eight, &mut open, &mut nearby);
            let all = nearby.iter().fold(0, |all, (_, leaves)| all | leaves);
            for lane in (0..8).filter(|lane| all >> lane & 1 == 1) {
                let own = self.leaf(simd, 8 * eight + lane);
                for &(oriented, _) in nearby.iter().filter(|(_, leaves)| leaves >> lane & 1 == 1) {
                    let bounds = self.to.oriented[oriented].distances_squared_to(simd, own.around);
                    let mut near = at_most(simd, &bounds, self.bound(own.rounding));
                    while near != 0 {
                        self.examine_leaves(
                            simd,
                            &own,
                            8 * oriented + near.trailing_zeros() as usize,
                            &mut best,
                        );
                        near &= near - 1;
                    }
                }
            }
        }
        best
    }
}

impl<F: FnMut(u32, u32, f64) -> Option<f64>> PairSearch<'_, F> {
    /// Finds those of `to.oriented` that are near eight leaves of `from`, with a bit for each of the eight
    /// that they are near.
    #[inline(always)]
    fn descend<S: Simd>(&self, simd: S, eight: usize, open: &mut Vec<u32>, nearby: &mut Vec<(usize, u32)>) {
        nearby.clear();
        let around = self.framed(self.from.around_oriented(eight));
        let bound = self.bound(self.rounding(around));
        let mut leaves = None;
        open.push(0);
        while let Some(node) = open.pop() {
            let node = node as usize;
            if let Some(boxes) = self.to.boxes.get(node) {
                let mut near = at_most(simd, &boxes.distances_squared_to(simd, around), bound);
                while near != 0 {
                    open.push(self.to.first_child[node] + near.trailing_zeros());
                    near &= near - 1;
                }
                continue;
            }
            let oriented = node - self.to.boxes.len();
            // Not a closure, which would not be compiled for the instruction set in use.
            let own = match leaves {
                None => self.leaves(simd, eight),
                Some(known) => known,
            };
            leaves = Some(own);
            let bounds = own.distances_squared_to(simd, self.to.around_oriented(oriented));
            let near = at_most(simd, &bounds, bound);
            if near != 0 {
                nearby.push((oriented, near));
            }
        }
    }

    /// The boxes around eight leaves of `from`, in the frame of `to`; empty for leaves without a sound
    /// triangle.
    #[inline(always)]
    fn leaves<S: Simd>(&self, simd: S, eight: usize) -> Boxes {
        let mut out = Boxes::EMPTY;
        for leaf in 8 * eight..self.from.leaves.len().min(8 * eight + 8) {
            if self.from.is_sound[leaf] != 0 {
                out.set(leaf % 8, self.framed(self.from.around_leaf(simd, leaf)).into());
            }
        }
        out
    }

    /// A leaf of `from` that has a sound triangle, in the frame of `to`.
    #[inline(always)]
    fn leaf<S: Simd>(&self, simd: S, leaf: usize) -> Leaf {
        let triangles = self.triangles(leaf);
        let (is_sound, boxes) = (u32::from(self.from.is_sound[leaf]), triangles.boxes(simd));
        let around = boxes.around_some(is_sound);
        let is_far = around.iter().flatten().any(|x| f64::from(x.abs()) > MAX_SLAB_COORDINATE);
        let (flat, _) = self.from.oriented[leaf / 8].flat(leaf % 8);
        let (rounding, ends) = (self.rounding(around), triangles.along(simd, flat));
        Leaf { place: leaf, is_sound, triangles, boxes, around, flat, ends, rounding, is_far }
    }

    /// The triangles of a leaf of `from`, in the frame of `to`.
    #[inline(always)]
    fn triangles(&self, leaf: usize) -> Triangles {
        let (from, to) = (&self.from.frame, &self.to.frame);
        // With a larger ratio, too, everything but 0 is clamped.
        let ratio = (to.scale / from.scale).min(1e300);
        let shift = scale(sub(from.centre, to.centre), to.scale);
        let mut out = self.from.leaves[leaf];
        for corner in &mut out.corners {
            for (axis, shift) in corner.iter_mut().zip(shift) {
                for x in axis {
                    *x = (f64::from(*x) * ratio + shift).clamp(-MAX_COORDINATE, MAX_COORDINATE) as f32;
                }
            }
        }
        out
    }

    /// How far rounding may move a bound, for whatever lies in this box of the frame of `to`.
    #[inline(always)]
    fn rounding(&self, around: [[f32; 3]; 2]) -> f64 {
        let (from, to) = (&self.from.frame, &self.to.frame);
        let size = around.iter().flatten().fold(0.0, |most: f64, x| most.max(f64::from(x.abs())));
        let exact = (EXACT_ROUNDING * (from.largest + to.largest) + UNDERFLOW) * to.scale;
        ROUNDING * (1.0 + size + to.scale / from.scale) + exact
    }

    /// The threshold above which a lower bound proves that a pair is farther apart than `reach`, whatever
    /// rounding did.
    #[inline(always)]
    fn bound(&self, rounding: f64) -> f32 {
        bound(self.reach.get().sqrt() * self.to.frame.scale + rounding)
    }

    /// Calls `pair` for those pairs of triangles of two leaves whose bounds are within reach.
    #[inline(always)]
    fn examine_leaves<S: Simd>(
        &mut self,
        simd: S,
        own: &Leaf,
        other: usize,
        best: &mut Option<(f64, u32, u32)>,
    ) {
        let others = &self.to.leaves[other];
        let bound = self.bound(own.rounding);
        if !own.is_far {
            let (flat, ends) = self.to.oriented[other / 8].flat(other % 8);
            if interval_distance_squared(own.triangles.along(simd, flat), ends) > bound
                || interval_distance_squared(others.along(simd, own.flat), own.ends) > bound
            {
                return;
            }
        }
        let boxes = others.boxes(simd);
        let around = boxes.distances_squared_to(simd, own.around);
        let theirs = at_most(simd, &around, bound) & u32::from(self.to.is_sound[other]);
        if theirs == 0 {
            return;
        }
        let ours = own.boxes.distances_squared_to(simd, boxes.around_some(theirs));
        let mut ours = at_most(simd, &ours, bound) & own.is_sound;
        while ours != 0 {
            let lane = ours.trailing_zeros() as usize & 7;
            ours &= ours - 1;
            let bounds = boxes.distances_squared_to(simd, own.boxes.get(lane));
            let mut near = at_most(simd, &bounds, bound) & theirs;
            if near == 0 {
                continue;
            }
            if !own.is_far {
                let corners = own.triangles.corners.map(|corner| corner.map(|axis| axis[lane]));
                near &= at_most(simd, &others.slabs_squared(simd, corners), bound);
            }
            while near != 0 {
                let place = 8 * other + near.trailing_zeros() as usize;
                near &= near - 1;
                let (i, j) = (self.from.ids[8 * own.place + lane], self.to.ids[place]);
                let reach = self.reach.get();
                let Some(distance_squared) = (self.pair)(i, j, reach) else { continue };
                let is_better = best.is_none_or(|best| (distance_squared, i, j) < best);
                if distance_squared <= reach && is_better {
                    self.reach.lower(distance_squared);
                    *best = Some((distance_squared, i, j));
                }
            }
        }
    }

    /// Converts a box from the frame of `from` to that of `to`.
    #[inline(always)]
    fn framed(&self, corners: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
        corners.map(|x| self.to.frame.of(self.from.frame.point_of(x)))
    }
}

/// The squared distance of two intervals; 0 where they overlap.
#[inline(always)]
fn interval_distance_squared([a, b]: [f32; 2], [c, d]: [f32; 2]) -> f32 {
    let apart = larger(larger(c - b, a - d), 0.0);
    apart * apart
}

/// A leaf of `from`, in the frame of `to`.
struct Leaf {
    place: usize,
    /// A bit for each sound triangle.
    is_sound: u32,
    triangles: Triangles,
    /// The box around each triangle; arbitrary for those that are not sound.
    boxes: Boxes,
    /// The box around all sound triangles.
    around: [[f32; 3]; 2],
    /// The direction in which the triangles lie flat, and the interval that they cover along it.
    flat: [f32; 3],
    ends: [f32; 2],
    /// How far rounding may move a bound.
    rounding: f64,
    /// Whether the leaf is too far off in the frame of `to` for slabs.
    is_far: bool,
}
