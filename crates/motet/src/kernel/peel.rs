//! Inverted tets removed that hang on a mesh by one facet: folded back over it, they fill no room that it does not fill already.

use crate::base::{TetId, VertexId};
use crate::geometry::predicates::orient3d;
use crate::kernel::change::NewWall;
use crate::kernel::complex::{Complex, FREE, Hold, NO_TET};
use crate::kernel::link::{Behind, HalfFacet, NO_TRIANGLE, Wall};

impl Complex {
    /// Removes the tets that are flat or inverted and have no tet behind three of their facets; answers how many. The facet behind which there is one
    /// bounds the mesh then. Triangles at the other three are removed with the tet.
    pub fn peel(&mut self) -> usize {
        if !self.is_tangled {
            return 0;
        }
        let mut candidates: Vec<TetId> = self.tets().collect();
        let mut n_peeled = 0;
        while let Some(tet) = candidates.pop() {
            if let Some(behind) = self.peelable(tet) {
                self.peel_off(tet, behind);
                candidates.push(behind.tet());
                n_peeled += 1;
            }
        }
        n_peeled
    }

    /// The one facet behind a tet that may be peeled.
    fn peelable(&self, tet: TetId) -> Option<HalfFacet> {
        if !self.is_alive(tet) {
            return None;
        }
        let mut behind = [0, 1, 2, 3].map(|i| self.across(tet, i)).into_iter().filter(|half| !half.is_none());
        let (Some(only), None) = (behind.next(), behind.next()) else { return None };
        let corners = self.facet(only);
        let is_fixed = |v: &VertexId| !corners.contains(v) && self.hold(*v) == Hold::Fixed;
        let [a, b, c, d] = self.corners(tet);
        (orient3d(a, b, c, d) <= 0 && !self.is_locked(tet) && !self.vertices(tet).iter().any(is_fixed))
            .then_some(only)
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
            if self.vertex_to_tet[vertex.index()] == tet {
                let has = |t: &TetId| self.tets[t.index()] != FREE && self.tets[t.index()].contains(&vertex);
                let other = if new.vertices.contains(&vertex) {
                    Some(behind.tet())
                } else {
                    (0..self.tets.len()).map(TetId::new).find(has)
                };
                self.set_tet_of(vertex, other.unwrap_or(NO_TET));
                if other.is_none() {
                    self.free_vertices.push(vertex);
                }
            }
        }
    }
}
