//! The walls of a complex, by number.

use crate::kernel::link::{HalfFacet, Wall, WallId};

/// Walls, and which of their slots are free.
///
/// Ids are valid while a wall exists; the slot that was freed last is reused first.
#[derive(Clone, Debug, Default)]
pub(super) struct Walls {
    all: Vec<Wall>,
    free: Vec<WallId>,
}

impl Walls {
    /// These walls, numbered as in the list.
    pub(super) fn new(all: Vec<Wall>) -> Self {
        Self { all, free: Vec::new() }
    }

    /// The number of slots, free ones included; wall ids are below it.
    pub(super) fn n_slots(&self) -> usize {
        self.all.len()
    }

    /// A wall.
    #[inline]
    pub(super) fn get(&self, wall: WallId) -> &Wall {
        &self.all[wall.index()]
    }

    /// All walls, in rising order of id.
    pub(super) fn iter(&self) -> impl Iterator<Item = (WallId, &Wall)> + '_ {
        let all = (0..).map(WallId).zip(&self.all);
        all.filter(|(_, wall)| !wall.sides[0].is_none())
    }

    /// The facet on the other side of a wall from `side`.
    #[inline]
    pub(super) fn across(&self, wall: WallId, side: HalfFacet) -> HalfFacet {
        self.all[wall.index()].other(side)
    }

    /// Sets a slot; returns what it held.
    pub(super) fn set(&mut self, id: WallId, wall: Wall) -> Wall {
        std::mem::replace(&mut self.all[id.index()], wall)
    }

    /// Takes the slot that was freed last, or a new one; what it held stays until it is set.
    pub(super) fn take_slot(&mut self) -> WallId {
        self.free.pop().unwrap_or_else(|| {
            self.all.push(Wall::FREE);
            WallId(self.all.len() as u32 - 1)
        })
    }

    /// Removes a wall and frees its slot; returns the wall.
    pub(super) fn remove(&mut self, id: WallId) -> Wall {
        self.free.push(id);
        self.set(id, Wall::FREE)
    }

    /// Puts a slot, which is free, back on the list of free ones: undoes [`Self::take_slot`] of a used slot.
    pub(super) fn put_back_slot(&mut self, id: WallId) {
        self.free.push(id);
    }

    /// Takes the slot that was freed last off the list of free ones: undoes [`Self::remove`], but for the
    /// wall.
    pub(super) fn keep_last_freed(&mut self) {
        self.free.pop();
    }

    /// Drops all slots from the `n`-th: undoes [`Self::take_slot`] of new slots.
    pub(super) fn truncate(&mut self, n: usize) {
        self.all.truncate(n);
    }
}
