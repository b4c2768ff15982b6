//! A tree of boxes whose sides move: which of them touch a moving box, and from when on.
//!
//! Each side of a box moves with the least or greatest velocity of what is within, so the box stays around
//! it. Unlike the box around a whole motion, it does not grow with a motion that all have in common, and the
//! time may be unlimited.

use super::queue::{Item, Queue};
use crate::base::Point;
use crate::geometry::vector::{add, scale, sub};
use crate::spatial::{Bounds, bounding_box};

/// Boxes in a leaf.
const LEAF: usize = 2;

/// Quotients of differences are correct to 3 roundings; the rest is a margin for what follows.
const ROUNDING: f64 = 1e-15;

/// A box at time 0, and how its corners move.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBox {
    place: Bounds,
    velocity: Bounds,
}

impl MovingBox {
    /// The box around points, with their velocities; all must be finite.
    pub(super) fn new<const N: usize>(points: [Point; N], velocities: [Point; N]) -> Self {
        Self { place: bounding_box(points), velocity: bounding_box(velocities) }
    }

    /// The box grown by a length on all sides.
    pub(super) fn expanded(self, by: f64) -> Self {
        let [low, high] = self.place;
        Self { place: [low.map(|x| x - by), high.map(|x| x + by)], ..self }
    }

    fn union(self, other: Self) -> Self {
        let join = |[a, b]: Bounds, [c, d]: Bounds| bounding_box([a, b, c, d]);
        Self { place: join(self.place, other.place), velocity: join(self.velocity, other.velocity) }
    }

    fn centre(&self, time: f64) -> Point {
        let middle = |[low, high]: Bounds| add(scale(low, 0.5), scale(high, 0.5));
        add(middle(self.place), scale(middle(self.velocity), time))
    }

    /// When the boxes first touch, from 0 to the horizon; never later than they really do. `None` if they do
    /// not.
    #[inline]
    fn touches(&self, other: &Self, horizon: f64) -> Option<f64> {
        let (mut from, mut to) = (0.0, horizon);
        for (a, b) in [(self, other), (other, self)] {
            for k in 0..3 {
                // They are apart while the low side of one is above the high side of the other.
                let apart = a.place[0][k] - b.place[1][k];
                let closing = b.velocity[1][k] - a.velocity[0][k];
                if apart > 0.0 {
                    // Infinite if they do not come closer.
                    let when = if closing > 0.0 { apart / closing } else { f64::INFINITY };
                    from = if when > from { when } else { from };
                } else if closing < 0.0 {
                    let when = apart / closing;
                    to = if when < to { when } else { to };
                }
            }
        }
        let from = from * (1.0 - ROUNDING);
        (from <= to * (1.0 + ROUNDING) && from < f64::INFINITY && from <= horizon).then_some(from)
    }
}

/// Moving boxes within moving boxes.
#[derive(Debug, Default)]
pub(super) struct MovingTree {
    nodes: Vec<Node>,
    /// The boxes with their ids, in the order of the leaves.
    boxes: Vec<(MovingBox, u32)>,
    horizon: f64,
}

/// A box with either two subtrees (the left one follows directly) or a run of boxes.
#[derive(Clone, Copy, Debug)]
struct Node {
    around: MovingBox,
    /// The right subtree, or the first box.
    start: u32,
    /// How many boxes; 0 for a node with subtrees.
    count: u32,
}

impl MovingTree {
    /// Builds the tree. Boxes are known by their indices; those that are `None` are left out. Boxes are
    /// grouped by where they are halfway to the horizon, or at the start if it is infinite.
    pub(super) fn new(boxes: Vec<Option<MovingBox>>, horizon: f64) -> Self {
        let mut boxes: Vec<_> = boxes.into_iter().zip(0u32..).filter_map(|(b, id)| Some((b?, id))).collect();
        let mut tree = Self { nodes: Vec::with_capacity(boxes.len()), boxes: Vec::new(), horizon };
        let time = if horizon.is_finite() { 0.5 * horizon } else { 0.0 };
        if !boxes.is_empty() {
            tree.build(&mut boxes, 0, time);
        }
        tree.boxes = boxes;
        tree
    }

    /// Builds a subtree: boxes are halved across the longest side of the box of their centres until few are
    /// left.
    fn build(&mut self, boxes: &mut [(MovingBox, u32)], start: u32, time: f64) {
        let whole = boxes[1..].iter().fold(boxes[0].0, |whole, b| whole.union(b.0));
        let place = self.nodes.len();
        self.nodes.push(Node { around: whole, start, count: boxes.len() as u32 });
        if boxes.len() <= LEAF {
            return;
        }
        let [low, high] = bounding_box(boxes.iter().map(|b| b.0.centre(time)));
        let size = sub(high, low);
        let axis = (0..3).max_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
        let key = |b: &(MovingBox, u32)| b.0.centre(time)[axis];
        let middle = boxes.len() / 2;
        boxes.select_nth_unstable_by(middle, |x, y| key(x).total_cmp(&key(y)).then(x.1.cmp(&y.1)));
        let (left, right) = boxes.split_at_mut(middle);
        self.build(left, start, time);
        (self.nodes[place].start, self.nodes[place].count) = (self.nodes.len() as u32, 0);
        self.build(right, start + middle as u32, time);
    }

    /// Prepares `queue` for the boxes that touch `query`.
    pub(super) fn begin(&self, query: &Option<MovingBox>, queue: &mut Queue) {
        queue.clear();
        if query.is_some() && !self.nodes.is_empty() {
            queue.push(0.0, Item::Node(0));
        }
    }

    /// Replaces a node by those of its contents that touch `query` before `bound`.
    pub(super) fn open(&self, node: u32, query: &Option<MovingBox>, bound: f64, queue: &mut Queue) {
        let Some(query) = query else { return };
        let Node { start, count, .. } = self.nodes[node as usize];
        let mut put = |around: &MovingBox, item| {
            if let Some(time) = around.touches(query, self.horizon).filter(|&time| time < bound) {
                queue.push(time, item);
            }
        };
        if count == 0 {
            [node + 1, start].into_iter().for_each(|k| put(&self.nodes[k as usize].around, Item::Node(k)));
            return;
        }
        let run = start as usize..(start + count) as usize;
        self.boxes[run].iter().for_each(|(around, id)| put(around, Item::Box(*id)));
    }

    /// Replaces the contents of `found` by all boxes that touch `query` before the horizon: from when on (or
    /// sooner), and their ids.
    pub(super) fn touching(&self, query: &Option<MovingBox>, found: &mut Vec<(f64, u32)>) {
        found.clear();
        let Some(query) = query else { return };
        // Halving keeps the depth below 32, and each level leaves one box behind.
        let mut open = [0u32; 33];
        let mut n_open = usize::from(!self.nodes.is_empty());
        while n_open > 0 {
            n_open -= 1;
            let node = &self.nodes[open[n_open] as usize];
            if node.around.touches(query, self.horizon).is_none() {
                continue;
            }
            if node.count == 0 {
                (open[n_open], open[n_open + 1]) = (node.start, open[n_open] + 1);
                n_open += 2;
                continue;
            }
            let run = node.start as usize..(node.start + node.count) as usize;
            let touching = self.boxes[run].iter();
            found.extend(touching.filter_map(|(b, id)| Some((b.touches(query, self.horizon)?, *id))));
        }
    }
}
