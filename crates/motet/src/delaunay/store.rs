//! The triangulation while it grows: one record a tet, on flat arrays.
//!
//! Vertex 0 lies at infinity; each facet of the hull has a *ghost* tet that joins it to that
//! vertex (Guibas and Stolfi 1985; Shewchuk 1997), so every facet has two sides and the hull needs no
//! code of its own. In a ghost the vertex at infinity comes last.
//!
//! A link is `4 * tet + facet`: the tet on the other side of a facet and which of its facets it is.

use super::gauge::{Gauge, Minors};
use crate::base::Point;

/// The vertex at infinity.
pub(super) const INFINITY: u32 = 0;

/// Vertices of facet `i`, so that vertex `i` followed by them is again positive. A ghost's vertex at
/// infinity stays last.
pub(super) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// More tets than this do not fit into links.
pub(super) const MAX_TETS: usize = 1 << 30;

/// One tet: a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Tet {
    /// Positively oriented; all [`INFINITY`] where the slot is free.
    pub(super) vertices: [u32; 4],
    pub(super) links: [u32; 4],
    pub(super) minors: Minors,
}

impl Tet {
    pub(super) const FREE: Self = Self { vertices: [INFINITY; 4], links: [0; 4], minors: Minors::ZERO };

    /// The vertices of all facets, in the order of [`FACETS`].
    #[inline(always)]
    pub(super) fn facets(&self) -> [[u32; 3]; 4] {
        let [a, b, c, d] = self.vertices;
        [[b, c, d], [c, a, d], [a, b, d], [a, c, b]]
    }

    #[inline(always)]
    pub(super) fn is_ghost(&self) -> bool {
        self.vertices[3] == INFINITY
    }

    pub(super) fn is_free(&self) -> bool {
        self.vertices[0] == INFINITY
    }
}

/// All tets and the free slots among them.
#[derive(Clone, Debug)]
pub(super) struct Store {
    pub(super) tets: Vec<Tet>,
    pub(super) gauges: Vec<Gauge>,
    pub(super) free: Vec<u32>,
}

impl Store {
    pub(super) fn with_capacity(n: usize) -> Self {
        Self { tets: Vec::with_capacity(n), gauges: Vec::with_capacity(n), free: Vec::new() }
    }

    /// Makes `slots`, which are free for use, exactly `n` long.
    #[inline(always)]
    pub(super) fn fit(&mut self, slots: &mut Vec<u32>, n: usize) {
        while slots.len() > n {
            if let Some(slot) = slots.pop() {
                self.tets[slot as usize] = Tet::FREE;
                self.gauges[slot as usize] = Gauge::FREE;
                self.free.push(slot);
            }
        }
        while slots.len() < n {
            let slot = self.free.pop().unwrap_or_else(|| self.grow());
            slots.push(slot);
        }
    }

    #[inline(always)]
    fn grow(&mut self) -> u32 {
        let slot = self.tets.len() as u32;
        self.tets.push(Tet::FREE);
        self.gauges.push(Gauge::FREE);
        slot
    }

    /// Coordinates of the four vertices of a tet that is no ghost.
    #[inline(always)]
    pub(super) fn corners(&self, points: &[Point], tet: u32) -> [Point; 4] {
        self.tets[tet as usize].vertices.map(|v| points[v as usize])
    }
}
