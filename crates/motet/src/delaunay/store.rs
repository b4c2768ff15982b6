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
use crate::base::Point;

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

/// All tets and the free slots among them.
#[derive(Clone, Debug)]
pub(super) struct Store {
    /// Positively oriented; [`FREE`] where the slot is free.
    pub(super) vertices: Vec<[u32; 4]>,
    pub(super) links: Vec<[u32; 4]>,
    pub(super) gauges: Vec<Gauge>,
    pub(super) free: Vec<u32>,
}

impl Store {
    pub(super) fn with_capacity(n: usize) -> Self {
        Self {
            vertices: Vec::with_capacity(n),
            links: Vec::with_capacity(n),
            gauges: Vec::with_capacity(n),
            free: Vec::new(),
        }
    }

    /// The number of slots, free ones included.
    #[inline(always)]
    pub(super) fn n_slots(&self) -> usize {
        self.gauges.len()
    }

    /// Frees slots.
    #[inline(always)]
    pub(super) fn release(&mut self, slots: &[u32]) {
        for &slot in slots {
            self.vertices[slot as usize] = FREE;
            self.free.push(slot);
        }
    }

    /// Takes free slots; appends new ones at the end when none are left.
    #[inline(always)]
    pub(super) fn claim(&mut self, slots: &mut [u32]) {
        for slot in slots {
            *slot = self.free.pop().unwrap_or_else(|| self.grow());
        }
    }

    #[inline(always)]
    fn grow(&mut self) -> u32 {
        let slot = self.n_slots() as u32;
        self.vertices.push(FREE);
        self.links.push([0; 4]);
        self.gauges.push(Gauge::FREE);
        slot
    }

    /// The coordinates of the four vertices of a tet that is not a ghost.
    #[inline(always)]
    pub(super) fn corners(&self, points: &[Point], tet: u32) -> [Point; 4] {
        let [a, b, c, d] = self.vertices[tet as usize];
        [points[a as usize], points[b as usize], points[c as usize], points[d as usize]]
    }
}
