//! What a triangle has still to look at, in the order of the times before which it need not.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A thing that is not needed before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Item {
    /// A subtree.
    Node(u32),
    /// A triangle whose box comes then.
    Box(u32),
    /// A triangle that may come then itself.
    Triangle(u32),
}

/// The earliest first. Kept from search to search, for its memory.
#[derive(Debug, Default)]
pub(super) struct Queue {
    /// By the bits of the time: those from 0 on are in the order of their bits.
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
