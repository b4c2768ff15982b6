//! From the builder's arrays to the caller's: tets, neighbours and hull under the caller's ids.

use super::HullFacet;
use super::store::{FACETS, FREE, Store, is_ghost};
use crate::base::{TetId, Threads, VertexId};
use crate::spatial::OUTSIDE;

/// The finished triangulation, without ghosts and free slots.
pub(super) struct Finished {
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) neighbors: Vec<[TetId; 4]>,
    pub(super) hull: Vec<HullFacet>,
}

/// Compacts the builder's arrays; `vertex_to_id[v]` is the caller's id of vertex `v` (arbitrary for the
/// vertex at infinity).
///
/// The builder's arrays are converted in place (a vector collected from its own elements keeps its memory):
/// at a million points that saves 216 MB of fresh pages, which cost more than the work itself.
pub(super) fn finish(store: Store, vertex_to_id: &[u32], threads: &Threads) -> Finished {
    let [vertices, links] = store.into_arrays();
    let slot_to_tet = number(&vertices);
    let hull = hull(&vertices, &links, &slot_to_tet, vertex_to_id);
    let id = |v: u32| VertexId(vertex_to_id[v as usize]);
    let tet = |link: u32| slot_to_tet[(link >> 2) as usize];
    let tets = || compact(vertices, &slot_to_tet, |[a, b, c, d]| [id(a), id(b), id(c), id(d)]);
    let neighbors = || compact(links, &slot_to_tet, |[a, b, c, d]| [tet(a), tet(b), tet(c), tet(d)]);
    let (tets, neighbors) = threads.join(tets, neighbors);
    Finished { tets, neighbors, hull }
}

/// Numbers the tets that are neither ghosts nor free, in the order of slots; the others get [`OUTSIDE`].
fn number(vertices: &[[u32; 4]]) -> Vec<TetId> {
    let mut next = 0;
    let number = |&vertices: &[u32; 4]| {
        let tet = if is_ghost(vertices) { OUTSIDE } else { TetId(next) };
        next += u32::from(!is_ghost(vertices));
        tet
    };
    vertices.iter().map(number).collect()
}

/// Converts the entries of numbered slots and drops the others.
fn compact<T: Copy, U>(slots: Vec<T>, slot_to_tet: &[TetId], entry: impl Fn(T) -> U) -> Vec<U> {
    let numbered = slots.into_iter().zip(slot_to_tet).filter(|(_, tet)| **tet != OUTSIDE);
    numbered.map(|(slot, _)| entry(slot)).collect()
}

fn hull(
    vertices: &[[u32; 4]],
    links: &[[u32; 4]],
    slot_to_tet: &[TetId],
    vertex_to_id: &[u32],
) -> Vec<HullFacet> {
    let ghosts = (0..vertices.len()).filter(|&s| slot_to_tet[s] == OUTSIDE && vertices[s] != FREE);
    // The hull facet of each ghost, seen from outside.
    let facet = |ghost: usize| {
        let (slot, facet) = ((links[ghost][3] >> 2) as usize, (links[ghost][3] & 3) as usize);
        // Together with the opposite vertex in front the facet is positive, so its front faces outward.
        let corners = FACETS[facet].map(|i| VertexId(vertex_to_id[vertices[slot][i] as usize]));
        HullFacet { vertices: corners, tet: slot_to_tet[slot], facet: facet as u8 }
    };
    ghosts.map(facet).collect()
}
