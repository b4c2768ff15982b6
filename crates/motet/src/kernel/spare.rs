//! Tets that walls force count as good.
//!
//! Where two walls meet at an angle, the tet between them has that dihedral angle, whatever is done. Nothing raises its quality, and as the worst tet
//! of every cavity around it, it would forbid each change that helps a neighbour. So such tets are marked, each by its id: the mark is the quality
//! stored for it. A tet that a change puts in place of marked ones is judged again, by the walls it will lie between. The value of a quality marks
//! nothing: elsewhere another tet can have the same one, and need repair.

use std::cell::Cell;

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::dihedral;
use crate::geometry::tet::EDGES;
use crate::kernel::complex::{Complex, UNMEASURED};
use crate::kernel::link::HalfFacet;

/// The quality of a tet that is marked: above that of any tet.
const SPARED: f64 = f64::INFINITY;

/// A quality within this of the highest that walls allow is as high as they allow.
const NEARLY: f64 = 1e-6;

/// Whether a tet of some `quality` is as good as walls allow that leave at most `best` to a tet between them.
pub fn is_reached(quality: f64, best: f64) -> bool {
    quality > 0.0 && best - quality < NEARLY
}

impl Complex {
    /// Counts `tets` as good from now on, and of the tets that changes bring those whose quality is below `limit` and as high as two walls on both sides of the
    /// tet allow. All until [`Self::spare_none`].
    ///
    /// Cannot be taken back by [`Self::undo`].
    pub fn spare(&mut self, tets: &[TetId], limit: f64) {
        self.spared_below = limit;
        tets.iter().for_each(|tet| self.qualities[tet.index()].set(SPARED));
        self.forget();
    }

    /// Judges every tet by its quality again.
    ///
    /// Cannot be taken back by [`Self::undo`].
    pub fn spare_none(&mut self) {
        self.spared_below = f64::NEG_INFINITY;
        let marked = self.qualities.iter_mut().filter(|quality| quality.get() == SPARED);
        marked.for_each(|quality| *quality = Cell::new(UNMEASURED));
        self.forget();
    }

    pub(super) fn is_spared(&self, tet: TetId) -> bool {
        self.qualities[tet.index()].get() == SPARED
    }

    /// The quality of a tet to come, of which `is_wall` tells the facets that will be walls: its EAS, unless walls force it and such tets are spared.
    #[inline]
    pub fn judge(&self, corners: [Point; 4], is_wall: impl Fn(usize) -> bool) -> f64 {
        let quality = self.measure(corners);
        if quality < self.spared_below && is_forced(corners, quality, is_wall) { SPARED } else { quality }
    }

    /// Whether one of `tets` has a wall with these vertices, in rising order.
    pub fn is_wall_of(&self, tets: &[TetId], vertices: [VertexId; 3]) -> bool {
        let mut facets = tets.iter().flat_map(|&tet| (0..4).map(move |i| (tet, i)));
        facets.any(|(tet, i)| self.is_wall(tet, i) && sorted(self.facet(HalfFacet::new(tet, i))) == vertices)
    }
}

/// Whether the angle between two walls of a tet decides its quality.
fn is_forced(corners: [Point; 4], quality: f64, is_wall: impl Fn(usize) -> bool) -> bool {
    let angles = dihedral::angles(corners);
    // The facets at an edge are those opposite to the two other vertices.
    let is_between = |edge: usize| EDGES[5 - edge].into_iter().all(&is_wall);
    (0..6).any(|edge| is_reached(quality, angles[edge] / dihedral::REGULAR) && is_between(edge))
}

/// The vertices of a facet in rising order.
pub(super) fn sorted(mut facet: [VertexId; 3]) -> [VertexId; 3] {
    facet.sort_unstable();
    facet
}
