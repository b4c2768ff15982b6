//! A set of tets that can be emptied in constant time.

use crate::base::TetId;

/// A set of tets: each tet stores the number of the round in which it was added last.
#[derive(Clone, Debug, Default)]
pub(crate) struct Marks {
    rounds: Vec<u32>,
    round: u32,
}

impl Marks {
    /// Empties the set; ids are below `n`, except those of tets that are inserted later.
    pub(crate) fn begin(&mut self, n: usize) {
        if self.rounds.len() < n {
            // With some extra, which the system zeroes on first use.
            self.rounds = vec![0; n + n / 8 + 64];
            self.round = 0;
        }
        if self.round == u32::MAX {
            self.rounds.fill(0);
            self.round = 0;
        }
        self.round += 1;
    }

    /// Adds a tet; returns whether it was not yet in the set.
    #[inline(always)]
    pub(crate) fn add(&mut self, tet: TetId) -> bool {
        match self.rounds.get_mut(tet.index()) {
            Some(round) => std::mem::replace(round, self.round) != self.round,
            None => self.add_beyond(tet),
        }
    }

    /// Adds a tet with an id that has no place in the list yet.
    #[cold]
    fn add_beyond(&mut self, tet: TetId) -> bool {
        self.rounds.resize(tet.index() + 1, 0);
        self.rounds[tet.index()] = self.round;
        true
    }

    /// Removes a tet from the set, if it is in it.
    #[inline]
    pub(super) fn remove(&mut self, tet: TetId) {
        if let Some(round) = self.rounds.get_mut(tet.index()) {
            *round = 0;
        }
    }

    /// Whether a tet is in the set.
    #[inline(always)]
    pub(crate) fn has(&self, tet: TetId) -> bool {
        self.rounds.get(tet.index()) == Some(&self.round)
    }
}
