//! The edges within divided facets, found by the middles of the facet's edges.
//!
//! Linked lists by the first of the three middles rather than a hash map: neighbouring tets are divided one
//! after the other, so successive queries are close in memory, and lists take half the space. They mostly
//! have one or two entries: the facets at an edge are distributed over their three edges.

use crate::base::{EdgeId, ForestVertexId, MaybeId, id};

id!(
    /// A facet that was ever divided.
    FacetId
);

/// All facets that were ever divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    /// For each vertex, the facet added last whose first middle it is.
    last: Vec<MaybeId<FacetId>>,
    all: Vec<Facet>,
}

#[derive(Clone, Copy, Debug)]
struct Facet {
    second: ForestVertexId,
    /// The first of three consecutive edges, each opposite the middle of the same rank.
    edges: EdgeId,
    /// The facet added before with the same first middle.
    before: MaybeId<FacetId>,
}

/// Three middles in ascending order, the first two of which identify the facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Middles {
    /// The vertices, in ascending order.
    pub(super) rising: [ForestVertexId; 3],
    /// The original position of each.
    order: [usize; 3],
}

impl Middles {
    #[inline]
    pub(super) fn new(middles: [ForestVertexId; 3]) -> Self {
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
    pub(super) fn named(&self, first: EdgeId) -> [EdgeId; 3] {
        let mut edges = [first; 3];
        for (k, edge) in self.order.into_iter().zip(first.0..) {
            edges[k] = EdgeId(edge);
        }
        edges
    }

    /// The rank of each middle, in the original order.
    pub(super) fn ranks(&self) -> [usize; 3] {
        let mut ranks = [0; 3];
        for (rank, k) in self.order.into_iter().enumerate() {
            ranks[k] = rank;
        }
        ranks
    }
}

impl Facets {
    #[inline]
    pub(super) fn get(&self, middles: &Middles) -> Option<EdgeId> {
        let [first, second, _] = middles.rising;
        let mut next = *self.last.get(first.index())?;
        while let Some(at) = next.get() {
            let facet = &self.all[at.index()];
            if facet.second == second {
                return Some(facet.edges);
            }
            next = facet.before;
        }
        None
    }

    /// Adds a facet that is not there yet.
    pub(super) fn add(&mut self, middles: &Middles, edges: EdgeId) {
        let [first, second, _] = middles.rising;
        let first = first.index();
        if self.last.len() <= first {
            self.last.resize(first + 1, MaybeId::NONE);
        }
        self.all.push(Facet { second, edges, before: self.last[first] });
        self.last[first] = FacetId::new(self.all.len() - 1).into();
    }

    /// The size in bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.last[..]) + size_of_val(&self.all[..])
    }
}
