//! What a triangle has yet to examine, in the order of the times before which it need not.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An item that is not needed before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Item {
    /// A subtree.
    Node(u32),
    /// A triangle whose box is touched then.
    Box(u32),
    /// A triangle that may be touched then itself.
    Triangle(u32),
}

/// The queue, the earliest item first. It is kept from search to search to reuse its memory.
#[derive(Debug, Default)]
pub(super) struct Queue {
    /// Ordered by the bits of the time: non-negative times are in the order of their bits.
    open: BinaryHeap<Reverse<(u64, Item)>>,
}

impl Queue {
    pub(super) fn clear(&mut self) {
        self.open.clear();
    }

    pub(super) fn push(&mut self, time: f64, item: Item) {
        self.open.push(Reverse((time.to_bits(), item)));
    }

    pub(super) fn pop(&mut self) -> Option<(f64, Item)> {
        self.open.pop().map(|Reverse((bits, item))| (f64::from_bits(bits), item))
    }
}
