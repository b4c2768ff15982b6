//! Removal of tets that are folded over a mesh and attached to it by one facet only: they fill no space that
//! it does not fill already.

use crate::base::{TetId, VertexId};
use crate::kernel::change::NewWall;
use crate::kernel::complex::Complex;
use crate::kernel::hold::Hold;
use crate::kernel::link::{Behind, HalfFacet, NO_TRIANGLE, Wall};
use crate::kernel::tets::NO_TET;

impl Complex {
    /// Removes, one after the other, the tets of the first mesh that are folded over others and have no tet
    /// behind three of their facets; returns how many. The facet towards the remaining tet then becomes
    /// boundary.
    ///
    /// A tet that a motion has inverted stays, and so does one with a labelled triangle on an outer facet or
    /// with a fixed vertex that the remaining tet does not share: the boundary there was given.
    pub fn peel(&mut self) -> usize {
        let mut folded = std::mem::take(&mut self.overlaps.folded);
        let n_folded = folded.len();
        loop {
            let before = folded.len();
            folded.retain(|&tet| match self.peelable(tet) {
                Some(behind) => {
                    self.peel_off(tet, behind);
                    false
                }
                None => true,
            });
            if folded.len() == before {
                return n_folded - before;
            }
        }
    }

    /// The facet of the only neighbour of a tet, if the tet may be peeled.
    fn peelable(&self, tet: TetId) -> Option<HalfFacet> {
        let mut behind = (0..4).map(|i| self.across(tet, i)).filter(|half| !half.is_none());
        let (Some(only), None) = (behind.next(), behind.next()) else { return None };
        let inner = self.facet(only);
        let is_fixed = |v: &VertexId| !inner.contains(v) && self.hold(*v) == Hold::Fixed;
        let is_labelled = |i: usize| match self.behind(tet, i) {
            Behind::Wall(wall) => self.across(tet, i).is_none() && self.wall(wall).triangle != NO_TRIANGLE,
            Behind::Tet(_) => false,
        };
        let may_peel =
            !self.is_locked(tet) && !self.vertices(tet).iter().any(is_fixed) && !(0..4).any(is_labelled);
        may_peel.then_some(only)
    }

    fn peel_off(&mut self, tet: TetId, behind: HalfFacet) {
        let vertices = self.vertices(tet);
        let mut new = NewWall { vertices: self.facet(behind), patch: 0, triangle: NO_TRIANGLE };
        for i in 0..4 {
            let Behind::Wall(wall) = self.behind(tet, i) else { continue };
            let Wall { patch, triangle, .. } = *self.wall(wall);
            if self.across(tet, i) == behind {
                (new.patch, new.triangle) = (patch, triangle);
            }
            self.free_wall(wall);
        }
        self.free_tet(tet);
        self.add_wall([behind, HalfFacet::NONE], new);
        for vertex in vertices {
            if self.tet_of(vertex) == tet {
                let other = if new.vertices.contains(&vertex) {
                    Some(behind.tet())
                } else {
                    self.tets().find(|&t| self.vertices(t).contains(&vertex))
                };
                self.set_tet_of(vertex, other.unwrap_or(NO_TET));
                if other.is_none() {
                    self.vertices.free_slot(vertex);
                }
            }
        }
    }
}
