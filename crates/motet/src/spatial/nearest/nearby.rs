//! The part of the tree around a place, for consecutive searches from there: they need not descend from the
//! root.
//!
//! With it, a search near a tube examines 2.7 groups of boxes instead of 4.9, and takes 13 % less time with a
//! good guess, 5 % less without. With half as many boxes nearby, or half as many again, it takes 3 to 7 %
//! longer.

use pulp::Simd;

use super::eights::Boxes;
use super::node::{Node, STACK_SIZE, put_nearest_on_top};
use super::packed::Packed;

/// The number of groups of eight boxes.
pub(super) const N_EIGHTS: usize = 2;
const N: usize = 8 * N_EIGHTS;

/// More than the relative rounding error of a length.
const ROUNDING: f64 = 1e-6;

/// A part that served fewer than `MIN_SERVED` searches did not pay off; the next `PAUSE` searches do without
/// one.
const MIN_SERVED: u32 = 4;
const PAUSE: u32 = 32;

/// The boxes around eight leaves each that are nearest to a place.
pub(super) struct Nearby {
    centre: [f32; 3],
    /// All other boxes are at least this far from `centre`.
    reach: f64,
    pub(super) boxes: [Boxes; N_EIGHTS],
    pub(super) nodes: [u32; N],
    n_served: u32,
    n_without: u32,
}

impl Nearby {
    pub(super) fn new() -> Self {
        Self {
            centre: [0.0; 3],
            reach: -1.0,
            boxes: [Boxes::EMPTY; N_EIGHTS],
            nodes: [0; N],
            n_served: MIN_SERVED,
            n_without: 0,
        }
    }

    /// Whether this part contains everything with a lower bound of up to `bound` at `p` (squared), gathered
    /// anew if need be.
    #[inline(always)]
    pub(super) fn serves<S: Simd>(&mut self, tree: &Packed, simd: S, p: [f32; 3], bound: f32) -> bool {
        let bound = f64::from(bound).sqrt();
        if self.holds(p, bound) {
            self.n_served += 1;
            return true;
        }
        if self.n_served < MIN_SERVED {
            self.n_without += 1;
            if self.n_without < PAUSE {
                return false;
            }
        }
        (self.n_served, self.n_without) = (0, 0);
        self.gather(tree, simd, p);
        self.holds(p, bound)
    }

    #[inline(always)]
    fn holds(&self, p: [f32; 3], bound: f64) -> bool {
        let [x, y, z] = [0, 1, 2].map(|k| f64::from(p[k]) - f64::from(self.centre[k]));
        (x * x + y * y + z * z).sqrt() + bound * (1.0 + ROUNDING) < self.reach
    }

    #[inline(always)]
    fn gather<S: Simd>(&mut self, tree: &Packed, simd: S, p: [f32; 3]) {
        let nearest = nearest(tree, simd, p);
        for (i, &x) in nearest[..N].iter().enumerate() {
            let Node(place, bound) = Node::of(x);
            let (node, lane) = (place as usize / 8, place as usize % 8);
            let is_there = bound < f32::INFINITY;
            let [low, high] = if is_there { tree.boxes[node].get(lane) } else { Boxes::EMPTY.get(0) };
            self.boxes[i / 8].set(i % 8, (low, high));
            self.nodes[i] = if is_there { tree.first_child[node] + lane as u32 } else { 0 };
        }
        self.centre = p;
        self.reach = f64::from(Node::of(nearest[N]).1).sqrt() * (1.0 - ROUNDING);
    }
}

/// The nearest of the boxes around eight leaves each, as `8 node + lane`, in the order of their bounds. The
/// last one is the nearest that is left out.
#[inline(always)]
fn nearest<S: Simd>(tree: &Packed, simd: S, p: [f32; 3]) -> [u64; N + 1] {
    let mut nearest = [Node(0, f32::INFINITY).packed(); N + 1];
    let mut open = [0; STACK_SIZE];
    let mut n_open = 1;
    while n_open > 0 {
        n_open -= 1;
        let next = open[n_open];
        if next >> 32 > nearest[N] >> 32 {
            continue;
        }
        let node = Node::of(next).0;
        let bounds = tree.boxes[node as usize].distances_squared(simd, p);
        let first = tree.first_child[node as usize];
        let start = n_open;
        for lane in 0..8 {
            let bound = bounds[lane as usize];
            if (first as usize) < tree.boxes.len() {
                let x = Node(first + lane, bound).packed();
                if x < nearest[N] && n_open < STACK_SIZE {
                    open[n_open] = x;
                    n_open += 1;
                }
                continue;
            }
            let mut x = Node(8 * node + lane, bound).packed();
            if x < nearest[N] {
                for y in &mut nearest {
                    (*y, x) = ((*y).min(x), (*y).max(x));
                }
            }
        }
        put_nearest_on_top(&mut open[start..n_open]);
    }
    nearest
}
