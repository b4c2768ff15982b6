//! A list in groups of eight, which grows by whole groups on all threads.

use std::ops::{Deref, DerefMut};

use crate::base::Threads;

/// A group of eight is written in about a microsecond.
const MIN_PART: usize = 256;

/// Items in groups of eight; read as one list.
#[derive(Clone, Debug)]
pub(in crate::refine) struct Eights<T>(Vec<[T; 8]>);

impl<T: Copy> Eights<T> {
    /// These items. Where the last group is not full, copies of the first item follow.
    pub(super) fn of(items: &[T]) -> Self {
        Self(
            items
                .chunks(8)
                .map(|group| [0, 1, 2, 3, 4, 5, 6, 7].map(|k| *group.get(k).unwrap_or(&items[0])))
                .collect(),
        )
    }
}

impl<T> Eights<T> {
    /// Reserves memory for more groups.
    pub(super) fn reserve(&mut self, n_groups: usize) {
        self.0.reserve(n_groups);
    }
}

impl<T: Send> Eights<T> {
    /// Appends `n` groups.
    pub(super) fn append(&mut self, n: usize, threads: &Threads, of: impl Fn(usize) -> [T; 8] + Sync + Send) {
        threads.append(&mut self.0, n, MIN_PART, of);
    }
}

impl<T> Default for Eights<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Deref for Eights<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        self.0.as_flattened()
    }
}

impl<T> DerefMut for Eights<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        self.0.as_flattened_mut()
    }
}
