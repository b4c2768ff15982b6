//! The triangulation while it grows: flat arrays with one slot per tet.
//!
//! Vertex 0 lies at infinity; each facet of the hull has a *ghost* tet that joins it to that vertex (Guibas
//! and Stolfi 1985; Shewchuk 1997), so every facet has two sides and the hull needs no separate code. In a
//! ghost the vertex at infinity comes last.
//!
//! A link is `4 * tet + facet`: the tet across a facet, and the number of that facet within it.
//!
//! There are three arrays instead of one of records: the conflict test reads gauges alone, and setting a
//! neighbour's mark brings its gauge into the cache well before the test needs it; vertices and links are
//! converted in place into the caller's arrays (`finish`). Compared with records of a cache line this saves
//! 190 of 780 bytes of fresh memory per vertex, and a twentieth of the time at a million points.

use super::gauge::Gauge;
use crate::base::{Error, Point, Result, Shared};

/// The vertex at infinity.
pub(super) const INFINITY: u32 = 0;

/// The vertices of facet `i`, ordered so that vertex `i` followed by them is positive again. In a ghost the
/// vertex at infinity stays last.
pub(super) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// The number of tets up to which links fit into 32 bits.
pub(super) const MAX_TETS: usize = 1 << 30;

/// The vertices recorded for a slot without a tet.
pub(super) const FREE: [u32; 4] = [INFINITY; 4];

/// The vertices of all facets, in the order of [`FACETS`].
#[inline(always)]
pub(super) fn facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, c, d], [c, a, d], [a, b, d], [a, c, b]]
}

#[inline(always)]
pub(super) fn is_ghost(vertices: [u32; 4]) -> bool {
    vertices[3] == INFINITY
}

/// All tets, and the slots without one.
#[derive(Clone, Debug)]
pub(super) struct Store {
    /// Positively oriented; [`FREE`] where the slot is free.
    vertices: Vec<[u32; 4]>,
    links: Vec<[u32; 4]>,
    gauges: Vec<[u64; Gauge::WORDS]>,
    pub(super) slots: Slots,
}

/// Slots without a tet: those of removed tets, and those not used so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    free: Vec<u32>,
    fresh: std::ops::Range<u32>,
}

/// A view of the tets, through which threads change those of different parts of space at the same time.
#[derive(Clone, Copy)]
pub(super) struct Tets<'a> {
    pub(super) vertices: Shared<'a, [u32; 4]>,
    pub(super) links: Shared<'a, [u32; 4]>,
    pub(super) gauges: Gauges<'a>,
}

/// A view of the gauges.
#[derive(Clone, Copy)]
pub(super) struct Gauges<'a>(Shared<'a, [u64; Gauge::WORDS]>);

impl Store {
    /// A store without tets, and `n` slots. Memory is touched when slots are first used.
    pub(super) fn with_slots(n: usize) -> Self {
        Self {
            vertices: vec![FREE; n],
            links: vec![[0; 4]; n],
            gauges: vec![[0; Gauge::WORDS]; n],
            slots: Slots { free: Vec::new(), fresh: 0..n as u32 },
        }
    }

    /// Makes room for `n` more tets.
    ///
    /// # Errors
    /// When there are more than [`MAX_TETS`] slots.
    pub(super) fn reserve(&mut self, n: usize) -> Result<()> {
        if self.slots.len() >= n {
            return Ok(());
        }
        let used = self.n_used();
        let all = used + n.max(used / 2);
        if used + n > MAX_TETS {
            return Err(Error::input(format!("more than {MAX_TETS} tets")).remedy("divide the set"));
        }
        let all = all.min(MAX_TETS);
        let mut grown = Self::with_slots(all);
        grown.vertices[..used].copy_from_slice(&self.vertices[..used]);
        grown.links[..used].copy_from_slice(&self.links[..used]);
        grown.gauges[..used].copy_from_slice(&self.gauges[..used]);
        grown.slots = Slots { free: std::mem::take(&mut self.slots.free), fresh: used as u32..all as u32 };
        *self = grown;
        Ok(())
    }

    /// The number of slots that have been used so far, free ones included.
    pub(super) fn n_used(&self) -> usize {
        self.slots.fresh.start as usize
    }

    /// The vertices and the links of all slots that have been used so far.
    pub(super) fn into_arrays(self) -> [Vec<[u32; 4]>; 2] {
        let n = self.n_used();
        [self.vertices, self.links].map(|mut array| {
            array.truncate(n);
            array
        })
    }

    /// A view of the tets.
    ///
    /// # Safety
    /// Of the threads that use copies of it at the same time, none may change a tet that another one reads.
    #[allow(unsafe_code, reason = "see `Shared`")]
    pub(super) unsafe fn tets(&mut self) -> Tets<'_> {
        // SAFETY: promised by the caller.
        unsafe {
            Tets {
                vertices: Shared::new(&mut self.vertices),
                links: Shared::new(&mut self.links),
                gauges: Gauges(Shared::new(&mut self.gauges)),
            }
        }
    }
}

impl Slots {
    pub(super) fn len(&self) -> usize {
        self.free.len() + self.fresh.len()
    }

    /// Adds slots whose tets were removed.
    #[inline(always)]
    pub(super) fn release(&mut self, tets: Tets, slots: &[u32]) {
        for &slot in slots {
            tets.vertices.set(slot, FREE);
            self.free.push(slot);
        }
    }

    /// Takes slots for new tets; false, and nothing is taken, where there are too few.
    #[inline(always)]
    pub(super) fn claim(&mut self, slots: &mut [u32]) -> bool {
        if self.len() < slots.len() {
            return false;
        }
        for slot in slots {
            *slot = self.free.pop().unwrap_or_else(|| {
                self.fresh.start += 1;
                self.fresh.start - 1
            });
        }
        true
    }

    /// Takes out as many slots for each part as requested, fewer where there are too few, free ones first.
    pub(super) fn split_off(&mut self, requested: &[usize]) -> Vec<Self> {
        let all: usize = requested.iter().sum();
        let n_free = self.free.len().min(all);
        let n_fresh = self.fresh.len().min(all - n_free);
        let part = |&n: &usize| {
            let share = |of: usize| (of as u64 * n as u64 / all.max(1) as u64) as usize;
            let fresh = self.fresh.start..self.fresh.start + share(n_fresh) as u32;
            self.fresh.start = fresh.end;
            Self { free: self.free.split_off(self.free.len() - share(n_free)), fresh }
        };
        requested.iter().map(part).collect()
    }

    /// Puts back what was split off.
    pub(super) fn put_back(&mut self, other: Self) {
        self.free.extend(other.free);
        if other.fresh.end == self.fresh.start {
            self.fresh.start = other.fresh.start;
        } else {
            self.free.extend(other.fresh.rev());
        }
    }
}

impl Tets<'_> {
    /// The coordinates of the four vertices of a tet that is not a ghost.
    #[inline(always)]
    pub(super) fn corners(&self, points: &[Point], tet: u32) -> [Point; 4] {
        let [a, b, c, d] = self.vertices.get(tet);
        [points[a as usize], points[b as usize], points[c as usize], points[d as usize]]
    }

    /// Links the tet and facet `link` to `other`.
    #[inline(always)]
    pub(super) fn set_link(&self, link: u32, other: u32) {
        self.links.cell(link >> 2).as_array_of_cells()[(link & 3) as usize].set(other);
    }
}

impl Gauges<'_> {
    #[inline(always)]
    pub(super) fn get(self, tet: u32) -> Gauge {
        Gauge::from_words(self.0.get(tet))
    }

    #[inline(always)]
    pub(super) fn set(self, tet: u32, gauge: Gauge) {
        self.0.set(tet, gauge.words());
    }

    #[inline(always)]
    pub(super) fn mark(self, tet: u32) -> u32 {
        self.0.cell(tet).as_array_of_cells()[Gauge::MARK].get() as u32
    }

    #[inline(always)]
    pub(super) fn set_mark(self, tet: u32, mark: u32) {
        let word = &self.0.cell(tet).as_array_of_cells()[Gauge::MARK];
        word.set(word.get() >> 32 << 32 | u64::from(mark));
    }
}
