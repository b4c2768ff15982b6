//! An array of which several threads change different elements at the same time.

use std::cell::Cell;

/// A view of an array through which any number of threads may change elements, without locks.
///
/// It is for work whose partition decides, before the threads start, which of them may touch which elements,
/// in an order that no slices can express: the tets of a part of space, wherever in the array they lie.
pub(crate) struct Shared<'a, T>(&'a [Cell<T>]);

impl<T> Clone for Shared<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Shared<'_, T> {}

#[allow(unsafe_code, reason = "no slices express which tets a thread may change: see DESIGN, delaunay")]
mod across_threads {
    use super::{Cell, Shared};

    // SAFETY: whoever makes a view promises that no element is written by one thread while another reads or
    // writes it; see `Shared::new`.
    unsafe impl<T: Send> Send for Shared<'_, T> {}
    // SAFETY: as above.
    unsafe impl<T: Send> Sync for Shared<'_, T> {}

    impl<'a, T: Copy> Shared<'a, T> {
        /// A view of `array`.
        ///
        /// # Safety
        /// While threads use copies of the view at the same time, an element that one of them sets must not
        /// be read or set by any other.
        pub(crate) unsafe fn new(array: &'a mut [T]) -> Self {
            Self(Cell::from_mut(array).as_slice_of_cells())
        }
    }
}

impl<'a, T: Copy> Shared<'a, T> {
    /// The element `i`.
    #[inline(always)]
    pub(crate) fn get(self, i: u32) -> T {
        self.0[i as usize].get()
    }

    /// Replaces the element `i`.
    #[inline(always)]
    pub(crate) fn set(self, i: u32, value: T) {
        self.0[i as usize].set(value);
    }

    /// The element `i` as a cell.
    #[inline(always)]
    pub(crate) fn cell(self, i: u32) -> &'a Cell<T> {
        &self.0[i as usize]
    }
}
