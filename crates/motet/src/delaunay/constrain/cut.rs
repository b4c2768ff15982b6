//! The tets that a missing part of a facet cuts, and the two hollows that they leave, one on each side.
//!
//! No edge of tets crosses an edge of the part, since those are edges of tets themselves. So where a tet is cut at all its whole slice lies
//! in the part, and the tets behind its cut facets are cut as well: nothing needs to be known of the part but its plane and one edge.

use super::sites::Sites;
use super::tets::Tets;
use crate::base::{TetId, VertexId};
use crate::kernel::HalfFacet;

/// A facet seen from within a hollow, and what lies behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) vertices: [VertexId; 3],
    pub(super) outer: HalfFacet,
}

/// Working space.
#[derive(Default)]
pub(super) struct Cut {
    /// On which side of the plane each vertex met lies, and in which round that was found.
    sides: Vec<(u32, i8)>,
    round: u32,
    /// The tets that are cut.
    pub(super) tets: Vec<TetId>,
    /// The faces around them in front of the plane, and behind it.
    pub(super) shells: [Vec<Face>; 2],
    star: Vec<TetId>,
}

/// What must not be, and is not where no facets cross.
pub(super) struct Stuck;

impl Cut {
    /// Finds the tets cut by a part of the plane of `corners`, which has `edge` and near it lies on the side of `beyond`.
    pub(super) fn find(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        corners: [VertexId; 3],
        [edge, beyond]: [[VertexId; 2]; 2],
    ) -> Result<(), Stuck> {
        self.round += 1;
        self.sides.resize(self.sides.len().max(sites.len()), (0, 0));
        let first = self.first(tets, sites, corners, edge, beyond[0]).ok_or(Stuck)?;
        tets.begin();
        tets.mark(first);
        self.tets.clear();
        self.shells.iter_mut().for_each(Vec::clear);
        self.tets.push(first);
        let mut next = 0;
        while let Some(&tet) = self.tets.get(next) {
            next += 1;
            for half in Tets::facets(tet) {
                self.pass(tets, sites, corners, half)?;
            }
        }
        Ok(())
    }

    /// Goes on behind a facet that is cut, and notes one that is not.
    fn pass(&mut self, tets: &mut Tets, sites: &Sites, corners: [VertexId; 3], half: HalfFacet) -> Result<(), Stuck> {
        let vertices = tets.inward(half);
        let sides = vertices.map(|v| self.side(sites, corners, v));
        let outer = tets.across(half);
        let (front, behind) = (sides.contains(&1), sides.contains(&-1));
        if front && behind {
            if outer.is_none() {
                return Err(Stuck);
            }
            if tets.mark(outer.tet()) {
                self.tets.push(outer.tet());
            }
        } else if front || behind {
            self.shells[usize::from(behind)].push(Face { vertices, outer });
        } else {
            return Err(Stuck);
        }
        Ok(())
    }

    /// Of the tets around `edge` the one that the plane cuts on the side of `beyond`.
    fn first(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        corners: [VertexId; 3],
        [a, b]: [VertexId; 2],
        beyond: VertexId,
    ) -> Option<TetId> {
        let mut star = std::mem::take(&mut self.star);
        tets.around([a, b], &mut star);
        let mut is_cut = |tet: &TetId| {
            let others = tets.vertices(*tet).map(|v| if v == a || v == b { None } else { Some(v) });
            let mut others = others.into_iter().flatten();
            let (Some(p), Some(q)) = (others.next(), others.next()) else { return false };
            if self.side(sites, corners, p) * self.side(sites, corners, q) >= 0 {
                return false;
            }
            // Between the half planes of p and q, which are less than half a turn apart.
            let turn = sites.orient3d([a, b, p, q]);
            sites.orient3d([a, b, p, beyond]) == turn && sites.orient3d([a, b, beyond, q]) == turn
        };
        let first = star.iter().copied().find(&mut is_cut);
        self.star = star;
        first
    }

    /// On which side of the plane a vertex lies.
    fn side(&mut self, sites: &Sites, [a, b, c]: [VertexId; 3], v: VertexId) -> i8 {
        let known = &mut self.sides[v.index()];
        if known.0 != self.round {
            *known = (self.round, sites.orient3d([a, b, c, v]));
        }
        known.1
    }
}
