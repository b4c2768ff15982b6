//! The tets cut by a missing part of a facet, and the two hollows that they leave, one on each side.
//!
//! No edge of a tet crosses an edge of the part, since the edges of the part are edges of tets themselves. So
//! where a tet is cut at all, its whole slice lies in the part, and the tets behind its cut facets are cut as
//! well: all that needs to be known of the part is its plane and one edge.
//!
//! A vertex all of whose tets are cut stands alone in a hollow.
//! A facet between two cut tets may itself be whole, where it meets the plane in a vertex or an edge. It is
//! dropped, unless it belongs to the surface: then it stands in the hollow as a wall with two sides.

use super::sides::Sides;
use super::sites::Sites;
use crate::base::{TetId, VertexId};
use crate::kernel::{HalfFacet, Tets};

/// A facet seen from within a hollow, and what lies behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) vertices: [VertexId; 3],
    pub(super) outer: HalfFacet,
}

/// Buffers reused from one part to the next.
#[derive(Default)]
pub(super) struct Cut {
    sides: Sides,
    /// The tets that are cut.
    pub(super) tets: Vec<TetId>,
    /// The faces around them in front of the plane, and behind it.
    pub(super) shells: [Vec<Face>; 2],
    /// All vertices in front of the plane, and behind it; some more than once.
    pub(super) vertices: [Vec<VertexId>; 2],
    /// Walls within the hollows, each once.
    pub(super) walls: Vec<[VertexId; 3]>,
    star: Vec<TetId>,
}

/// A failure that cannot occur where no facets cross.
pub(super) struct Stuck;

impl Cut {
    /// Finds the tets cut by a part of the plane of `corners`. The part has `edge`, near which it lies on the
    /// side of `beyond`; `own` are facets in that plane.
    pub(super) fn find(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        (corners, own): ([VertexId; 3], &[[VertexId; 3]]),
        (edge, beyond): ([VertexId; 2], VertexId),
        is_wall: impl Fn([VertexId; 3]) -> bool,
    ) -> Result<(), Stuck> {
        self.sides.begin(corners, own);
        self.sides.grow(sites);
        let first = self.first(tets, sites, edge, beyond).ok_or(Stuck)?;
        self.spread(tets, sites, first)?;
        self.shells.iter_mut().for_each(Vec::clear);
        self.walls.clear();
        self.vertices.iter_mut().for_each(Vec::clear);
        for i in 0..self.tets.len() {
            for v in tets.vertices(self.tets[i]) {
                match self.sides.of(sites, v) {
                    0 => {}
                    side => self.vertices[usize::from(side < 0)].push(v),
                }
            }
            for half in Tets::facets(self.tets[i]) {
                self.enclose(tets, sites, half, &is_wall)?;
            }
        }
        Ok(())
    }

    /// Collects the cut tets, starting from `first`.
    fn spread(&mut self, tets: &mut Tets, sites: &Sites, first: TetId) -> Result<(), Stuck> {
        tets.begin();
        tets.mark(first);
        self.tets.clear();
        self.tets.push(first);
        let mut next = 0;
        while let Some(&tet) = self.tets.get(next) {
            next += 1;
            for half in Tets::facets(tet) {
                if self.met(tets, sites, half) == [true, true] {
                    let outer = tets.across(half);
                    if outer.is_none() {
                        return Err(Stuck);
                    }
                    if tets.mark(outer.tet()) {
                        self.tets.push(outer.tet());
                    }
                }
            }
        }
        Ok(())
    }

    /// Records a facet of a cut tet where it bounds a hollow.
    fn enclose(
        &mut self,
        tets: &Tets,
        sites: &Sites,
        half: HalfFacet,
        is_wall: impl Fn([VertexId; 3]) -> bool,
    ) -> Result<(), Stuck> {
        let (vertices, outer) = (tets.inward(half), tets.across(half));
        let is_within = !outer.is_none() && tets.is_marked(outer.tet());
        let shell = match self.met(tets, sites, half) {
            [true, true] => return Ok(()),
            [false, false] => return Err(Stuck),
            [front, _] => usize::from(!front),
        };
        if !is_within {
            self.shells[shell].push(Face { vertices, outer });
        } else if is_wall(vertices) {
            self.shells[shell].push(Face { vertices, outer: HalfFacet::NONE });
            if half < outer {
                self.walls.push(vertices);
            }
        }
        Ok(())
    }

    /// Whether a facet has vertices in front of the plane, and behind it.
    fn met(&self, tets: &Tets, sites: &Sites, half: HalfFacet) -> [bool; 2] {
        let sides = tets.inward(half).map(|v| self.sides.of(sites, v));
        [sides.contains(&1), sides.contains(&-1)]
    }

    /// The tet around `edge` that the plane cuts on the side of `beyond`.
    fn first(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        [a, b]: [VertexId; 2],
        beyond: VertexId,
    ) -> Option<TetId> {
        let mut star = std::mem::take(&mut self.star);
        tets.around([a, b], &mut star);
        let is_cut = |tet: &TetId| {
            let others = tets.vertices(*tet).map(|v| if v == a || v == b { None } else { Some(v) });
            let mut others = others.into_iter().flatten();
            let (Some(p), Some(q)) = (others.next(), others.next()) else { return false };
            if self.sides.of(sites, p) * self.sides.of(sites, q) >= 0 {
                return false;
            }
            // Between the half planes of p and q, which are less than half a turn apart.
            let turn = sites.orient3d([a, b, p, q]);
            sites.orient3d([a, b, p, beyond]) == turn && sites.orient3d([a, b, beyond, q]) == turn
        };
        let first = star.iter().copied().find(is_cut);
        self.star = star;
        first
    }
}
