//! The edges within facets that were divided, by the middles of the facet's edges.
//!
//! Lists by the first of the three middles, not a hash: tets beside each other are divided one after the other, so what is looked for lies near what was looked for
//! before, and a list takes half the memory. It has one or two entries, mostly: the facets at an edge share these between their three edges.

use super::NONE;

/// Which facets there ever were.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    /// Of each vertex, the facet added last of which it is the first middle.
    last: Vec<u32>,
    all: Vec<Facet>,
}

#[derive(Clone, Copy, Debug)]
struct Facet {
    second: u32,
    /// The first of three edges that follow each other: each is opposite the middle at its place.
    edges: u32,
    /// The one added before with the same first middle.
    before: u32,
}

/// Three middles in rising order, the first two of which name the facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Middles {
    /// The vertices.
    pub(super) rising: [u32; 3],
    /// The place that each had.
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

    /// Edges that follow each other, each in the place of the middle that it is opposite to.
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

    /// Adds one that is not there.
    pub(super) fn add(&mut self, middles: &Middles, edges: u32) {
        let [first, second, _] = middles.rising;
        let first = first as usize;
        if self.last.len() <= first {
            self.last.resize(first + 1, NONE);
        }
        self.all.push(Facet { second, edges, before: self.last[first] });
        self.last[first] = (self.all.len() - 1) as u32;
    }

    /// Bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.last[..]) + size_of_val(&self.all[..])
    }
}
