//! The side of a flat facet's plane on which vertices lie. The facet's own vertices count as on it, whatever
//! rounding has done to them. Each side is computed once, since the signs of points on edges are expensive
//! and are needed repeatedly.

use std::cell::Cell;

use super::sites::Sites;
use crate::base::VertexId;

/// A plane, and the sides of vertices known so far.
#[derive(Default)]
pub(super) struct Sides {
    /// Three vertices that define the plane and its orientation.
    pub(super) corners: [VertexId; 3],
    /// The vertices of the facet.
    own: Vec<VertexId>,
    /// For each vertex, the number of the plane for which its side was last computed, and that side.
    known: Vec<Cell<(u32, i8)>>,
    round: u32,
}

impl Sides {
    /// Switches to another plane, that of a flat facet with the vertices `own`.
    pub(super) fn begin(&mut self, corners: [VertexId; 3], own: &[[VertexId; 3]]) {
        self.corners = corners;
        self.own.clear();
        self.own.extend(own.as_flattened());
        self.round += 1;
    }

    /// Adds a vertex of the facet.
    pub(super) fn add(&mut self, vertex: VertexId) {
        self.own.push(vertex);
    }

    /// Extends the table to vertices added since.
    pub(super) fn grow(&mut self, sites: &Sites) {
        self.known.resize(sites.len(), Cell::default());
        self.own.iter().for_each(|v| self.known[v.index()].set((self.round, 0)));
    }

    /// The side of a vertex: 1 in front of the plane, -1 behind it, 0 on it.
    pub(super) fn of(&self, sites: &Sites, v: VertexId) -> i8 {
        let known = &self.known[v.index()];
        if known.get().0 != self.round {
            let [a, b, c] = self.corners;
            let side = if self.corners.contains(&v) { 0 } else { sites.orient3d([a, b, c, v]) };
            known.set((self.round, side));
        }
        known.get().1
    }
}
