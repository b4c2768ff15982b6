//! Assigns flat tets in a flat facet to the outside, where one of the facet's sides is outside.
//!
//! Rounding leaves vertices of one facet 1e-16 above and below its plane, and Delaunay tets of four of them
//! in between. These are positive, but too flat for anything to be done with them: no number lies between
//! their vertices. On which side of them the facet passes is free to choose. Where all of them are outside,
//! each tet inside at the facet has an apex away from it, and the triangles of the facet can be changed as if
//! it were exactly flat (`repair`).

use hashbrown::HashSet;

use super::plane::Net;
use super::repair::{Exchange, SurfaceRepair};
use crate::base::{TetId, VertexId, sorted_ids};
use crate::kernel::{HalfFacet, Tets};

impl SurfaceRepair<'_> {
    /// Assigns the flat tets in flat facets to the outside, where that leaves valid facets.
    pub(super) fn shed(&mut self) {
        let mut star = Vec::new();
        for (flat, list) in self.lists().into_iter().enumerate() {
            let is_outside = self.bodies.sides[flat].map(|body| body == 0);
            if list.len() > 1 && is_outside[0] != is_outside[1] {
                self.shed_one(flat as u32, &list, &mut star);
            }
        }
    }

    fn shed_one(&mut self, flat: u32, list: &[[VertexId; 3]], star: &mut Vec<TetId>) {
        let own: HashSet<VertexId> = list.as_flattened().iter().copied().collect();
        let (flat_tets, sheet) = match self.flat_tets(&own, list, star) {
            Some((tets, sheet)) if !tets.is_empty() => (tets, sheet),
            _ => return,
        };
        let plane = self.plane(flat);
        let sheet: Vec<_> = sheet.into_iter().map(|face| plane.turned(face)).collect();
        if !covers_the_same(&sheet, list) {
            return;
        }
        flat_tets.iter().for_each(|tet| self.bodies.of_slot[tet.index()] = 0);
        list.iter().for_each(|&face| _ = self.walls.remove(&sorted_ids(face)));
        self.walls.extend(sheet.into_iter().map(|face| (sorted_ids(face), flat)));
    }

    /// Finds the tets inside whose vertices are all in `own` and that are connected with the facets of
    /// `list`; also returns the facets that remain once they are outside. `None` where one of them touches
    /// another part of the surface.
    fn flat_tets(
        &mut self,
        own: &HashSet<VertexId>,
        list: &[[VertexId; 3]],
        star: &mut Vec<TetId>,
    ) -> Option<(Vec<TetId>, Vec<[VertexId; 3]>)> {
        let (mut found, mut sheet) = (Vec::new(), Vec::new());
        let mut done: HashSet<TetId> = HashSet::new();
        let is_inside = |keep: &Self, tet: TetId| keep.bodies.of_slot[tet.index()] != 0;
        let is_flat = |keep: &Self, tet: TetId| keep.tets.vertices(tet).iter().all(|v| own.contains(v));
        for &face in list {
            let half = self.tets.find_facet(face, star)?;
            let half = if is_inside(self, half.tet()) { half } else { self.tets.across(half) };
            if !is_flat(self, half.tet()) {
                sheet.push(face);
            } else if done.insert(half.tet()) {
                found.push(half.tet());
            }
        }
        let mut next = 0;
        while let Some(&tet) = found.get(next) {
            next += 1;
            for half in Tets::facets(tet) {
                let (face, other) = (self.tets.inward(half), self.tets.across(half));
                if let Some(flat) = self.wall(half) {
                    if flat != self.walls[&sorted_ids(list[0])] {
                        return None;
                    }
                } else if !is_flat(self, other.tet()) {
                    sheet.push(face);
                } else if done.insert(other.tet()) {
                    found.push(other.tet());
                }
            }
        }
        Some((found, sheet))
    }

    /// Assigns the flat tet of `corners` to the body across its facets `old`, which lie in a flat facet; its
    /// other two facets, `base`, replace them. `None` where `star` has no such tet, or both sides are of one
    /// body.
    pub(super) fn hand_over(
        &mut self,
        star: &[TetId],
        corners: [VertexId; 4],
        Exchange { old, base }: Exchange,
    ) -> Option<()> {
        let has_all = |keep: &Self, tet: TetId| corners.iter().all(|v| keep.tets.vertices(tet).contains(v));
        let tet = star.iter().copied().find(|&tet| has_all(self, tet))?;
        let halves = Tets::facets(tet);
        let walls = halves.map(|half| (sorted_ids(self.tets.inward(half)), self.wall(half)));
        let is_right = walls.iter().all(|(face, wall)| wall.is_some() == old.contains(face));
        let body = self.bodies.of_slot[tet.index()];
        let [front, behind] = self.bodies.sides[base[0].0 as usize];
        if !is_right || front == behind {
            return None;
        }
        let other = if front == body { behind } else { front };
        let is_removed = halves.iter().any(|&half| self.tets.across(half).is_none());
        if is_removed {
            for half in halves.map(|half| self.tets.across(half)).into_iter().filter(|half| !half.is_none()) {
                self.tets.join(HalfFacet::NONE, half);
            }
            self.tets.remove(tet);
        } else {
            self.bodies.of_slot[tet.index()] = other;
        }
        old.iter().for_each(|face| _ = self.walls.remove(face));
        self.walls.extend(base.iter().map(|&(flat, face)| (sorted_ids(face), flat)));
        Some(())
    }
}

/// Whether two lists of triangles with the same orientation have the same length and the same outline.
fn covers_the_same(a: &[[VertexId; 3]], b: &[[VertexId; 3]]) -> bool {
    let [of_a, of_b] = [a, b].map(|list| (Net::new(list).outline(), Net::new(list).len()));
    a.len() == b.len() && of_a == of_b && of_a.1 == 3 * a.len()
}
