//! The edges within divided facets, found by the middles of the facet's edges.
//!
//! Linked lists by the first of the three middles rather than a hash map: neighbouring tets are divided one
//! after the other, so successive queries are close in memory, and lists take half the space. They mostly
//! have one or two entries: the facets at an edge are distributed over their three edges.

use super::NONE;

/// All facets that were ever divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    /// For each vertex, the facet added last whose first middle it is.
    last: Vec<u32>,
    all: Vec<Facet>,
}

#[derive(Clone, Copy, Debug)]
struct Facet {
    second: u32,
    /// The first of three consecutive edges, each opposite the middle of the same rank.
    edges: u32,
    /// The facet added before with the same first middle.
    before: u32,
}

/// Three middles in ascending order, the first two of which identify the facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Middles {
    /// The vertices, in ascending order.
    pub(super) rising: [u32; 3],
    /// The original position of each.
    order: [usize; 3],
}

impl Middles {
    #[inline]
    pub(super) fn new(middles: [u32; 3]) -> Self {
        let mut order = [0, 1, 2];
        for [i, j] in [[0, 1], [1, 2], [0, 1]] {
            if middles[order[j]] < middles[order[i]] {
                order.swap(i, j);
            }
        }
        Self { rising: [middles[order[0]], middles[order[1]], middles[order[2]]], order }
    }

    /// Puts three consecutive edges in the order of the middles they are opposite to.
    #[inline]
    pub(super) fn named(&self, first: u32) -> [u32; 3] {
        let mut edges = [NONE; 3];
        for (k, edge) in self.order.into_iter().zip(first..) {
            edges[k] = edge;
        }
        edges
    }
}

impl Facets {
    #[inline]
    pub(super) fn get(&self, middles: &Middles) -> Option<u32> {
        let [first, second, _] = middles.rising;
        let mut at = *self.last.get(first as usize)?;
        while at != NONE {
            let facet = &self.all[at as usize];
            if facet.second == second {
                return Some(facet.edges);
            }
            at = facet.before;
        }
        None
    }

    /// Adds a facet that is not there yet.
    pub(super) fn add(&mut self, middles: &Middles, edges: u32) {
        let [first, second, _] = middles.rising;
        let first = first as usize;
        if self.last.len() <= first {
            self.last.resize(first + 1, NONE);
        }
        self.all.push(Facet { second, edges, before: self.last[first] });
        self.last[first] = (self.all.len() - 1) as u32;
    }

    /// The size in bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.last[..]) + size_of_val(&self.all[..])
    }
}
