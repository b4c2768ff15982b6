//! On which side of a flat facet's plane vertices lie, its own being on it whatever rounding has done to them: each asked once, since the signs of points on edges are dear and are wanted again and again.

use std::cell::Cell;

use super::sites::Sites;
use crate::base::VertexId;

/// A plane, and where vertices lie that somebody has asked for.
#[derive(Default)]
pub(super) struct Sides {
    /// They tell the plane and how it is turned.
    pub(super) corners: [VertexId; 3],
    /// The vertices of the facet.
    own: Vec<VertexId>,
    /// By vertex: the side, and the plane's number when that was found.
    known: Vec<Cell<(u32, i8)>>,
    round: u32,
}

impl Sides {
    /// Takes another plane, that of a flat facet with the vertices `own`.
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

    /// Makes room for vertices that have come.
    pub(super) fn grow(&mut self, sites: &Sites) {
        self.known.resize(sites.len(), Cell::default());
        self.own.iter().for_each(|v| self.known[v.index()].set((self.round, 0)));
    }

    /// 1 in front of the plane, -1 behind it, 0 on it.
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
