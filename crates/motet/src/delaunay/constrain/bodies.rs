//! The bodies that the surfaces enclose: a body is a set of tets connected without crossing a surface.

use super::flats::FlatFacets;
use super::present::find_facets;
use super::recovery::{Part, Unrecovered};
use crate::base::{Csr, Error, TetId, Threads, VertexId, same_orientation};
use crate::kernel::{HalfFacet, NO_TET, Tets};

/// The bodies, and those on both sides of each flat facet.
pub(super) struct Bodies {
    /// The body of each slot; 0 is the outside, [`Self::NONE`] marks a slot without a tet.
    pub(super) of_slot: Vec<u32>,
    /// The number of bodies, the outside included.
    count: u32,
    /// The bodies in front of each flat facet and behind it.
    pub(super) sides: Vec<[u32; 2]>,
}

impl Bodies {
    pub(super) const NONE: u32 = u32::MAX;

    /// Finds the facets of all parts, and the bodies that they separate; `corner` is a vertex outside.
    ///
    /// # Errors
    /// When a part is not a facet of tets.
    pub(super) fn find(
        tets: &Tets,
        flats: &FlatFacets,
        parts: &Csr<[VertexId; 3]>,
        corner: VertexId,
        threads: &Threads,
    ) -> Result<Self, Unrecovered> {
        let mut walls = vec![0u8; tets.n_slots()];
        let mut halves = find_facets(tets, parts.items(), threads);
        if let Some(place) = halves.iter().position(|half| half.is_none()) {
            let flat = parts.offsets().partition_point(|&first| first as usize <= place) - 1;
            return Err(lost(flats.triangles.list(flat)[0]));
        }
        for (half, &part) in halves.iter_mut().zip(parts.items()) {
            let sides = [*half, tets.across(*half)];
            for side in sides.into_iter().filter(|side| !side.is_none()) {
                walls[side.tet().index()] |= 1 << side.facet();
            }
            *half = sides[usize::from(!faces(tets, *half, part))];
        }
        let mut bodies = Self { of_slot: vec![Self::NONE; tets.n_slots()], count: 0, sides: Vec::new() };
        let first = tets.tet_of(corner);
        let others = tets.iter().map(|(tet, _)| tet);
        for tet in [first].into_iter().filter(|&t| t != NO_TET).chain(others) {
            if bodies.of_slot[tet.index()] == Self::NONE {
                bodies.flood(tets, &walls, tet);
            }
        }
        let body = |half: HalfFacet| if half.is_none() { 0 } else { bodies.of_slot[half.tet().index()] };
        let firsts = parts.offsets()[..parts.len()].iter().map(|&first| halves[first as usize]);
        bodies.sides = firsts.map(|front| [body(front), body(tets.across(front))]).collect();
        Ok(bodies)
    }

    fn flood(&mut self, tets: &Tets, walls: &[u8], first: TetId) {
        self.of_slot[first.index()] = self.count;
        let mut todo = vec![first];
        while let Some(tet) = todo.pop() {
            for half in Tets::facets(tet) {
                let other = tets.across(half);
                let is_wall = walls[tet.index()] & 1 << half.facet() != 0;
                if !is_wall && !other.is_none() && self.of_slot[other.tet().index()] == Self::NONE {
                    self.of_slot[other.tet().index()] = self.count;
                    todo.push(other.tet());
                }
            }
        }
        self.count += 1;
    }
}

/// Whether the tet of a facet lies in front of it, the facet having the orientation of `part`.
fn faces(tets: &Tets, half: HalfFacet, part: [VertexId; 3]) -> bool {
    same_orientation(part, tets.inward(half))
}

fn lost(triangle: u32) -> Unrecovered {
    let error = Error::input("a part of the surface is not a facet of the tets")
        .at(format!("triangle {triangle}"))
        .remedy("check for triangles that cross or touch it");
    Unrecovered { what: Some(Part::Triangle(triangle)), error }
}
