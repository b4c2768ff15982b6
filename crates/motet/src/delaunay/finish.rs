//! From the builder's records to what the caller sees: tets, neighbours and hull under the caller's ids.

use super::HullFacet;
use super::store::{FACETS, INFINITY, Store};
use crate::base::{TetId, VertexId};
use crate::spatial::OUTSIDE;

/// Tets without ghosts and free slots.
pub(super) struct Finished {
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) neighbors: Vec<[TetId; 4]>,
    pub(super) hull: Vec<HullFacet>,
}

/// `vertex_to_id[v]` is the caller's id of vertex `v` (and anything for the one at infinity).
pub(super) fn finish(store: &Store, vertex_to_id: &[u32]) -> Finished {
    let slot_to_tet = number(store);
    let n_tets = slot_to_tet.iter().filter(|&&t| t != OUTSIDE).count();
    let mut out = Finished {
        tets: Vec::with_capacity(n_tets),
        neighbors: Vec::with_capacity(n_tets),
        hull: Vec::new(),
    };
    for (tet, number) in store.tets.iter().zip(&slot_to_tet) {
        if *number != OUTSIDE {
            out.tets.push(tet.vertices.map(|v| VertexId(vertex_to_id[v as usize])));
            out.neighbors.push(tet.links.map(|link| slot_to_tet[(link >> 2) as usize]));
        } else if !tet.is_free() {
            out.hull.push(hull_facet(store, tet.links[3], &slot_to_tet, vertex_to_id));
        }
    }
    out
}

/// Numbers the tets that are neither ghosts nor free, in the order of slots.
fn number(store: &Store) -> Vec<TetId> {
    let mut next = 0;
    let number = |tet: &super::store::Tet| {
        if tet.vertices[3] == INFINITY {
            return OUTSIDE;
        }
        next += 1;
        TetId(next - 1)
    };
    store.tets.iter().map(number).collect()
}

/// The facet of a tet at `link`, seen from outside.
fn hull_facet(store: &Store, link: u32, slot_to_tet: &[TetId], vertex_to_id: &[u32]) -> HullFacet {
    let (slot, facet) = ((link >> 2) as usize, (link & 3) as usize);
    // With the opposite vertex in front the facet is positive, so it turns its front outward.
    let vertices = FACETS[facet].map(|i| VertexId(vertex_to_id[store.tets[slot].vertices[i] as usize]));
    HullFacet { vertices, tet: slot_to_tet[slot], facet: facet as u8 }
}
