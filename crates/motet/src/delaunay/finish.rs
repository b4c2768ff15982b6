//! From the builder's arrays to the caller's: tets, neighbours and hull under the caller's ids, in the order
//! of slots.

use super::HullFacet;
use super::store::{FACETS, is_ghost};
use crate::base::{TetId, Threads, VertexId};
use crate::spatial::OUTSIDE;

/// The finished triangulation, without ghosts and free slots.
pub(super) struct Finished {
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) neighbors: Vec<[TetId; 4]>,
    pub(super) hull: Vec<HullFacet>,
}

/// Numbers the tets that are neither ghosts nor free in the order of slots. Arrays are the vertices and the
/// links of all slots; `vertex_to_id[v]` is the caller's id of vertex `v`, arbitrary for the one at infinity.
///
/// They are converted in place (a vector collected from its own elements keeps its memory): at a million
/// points that saves 216 MB of fresh pages, which cost more than the work itself.
pub(super) fn by_slots(arrays: [Vec<[u32; 4]>; 2], vertex_to_id: &[u32], threads: &Threads) -> Finished {
    let [vertices, links] = arrays;
    let mut next = 0;
    let number = |&vertices: &[u32; 4]| {
        let tet = if is_ghost(vertices) { OUTSIDE } else { TetId(next) };
        next += u32::from(!is_ghost(vertices));
        tet
    };
    let tet_of: Vec<TetId> = vertices.iter().map(number).collect();
    let id = |v: u32| VertexId(vertex_to_id[v as usize]);
    let tet = |link: u32| tet_of[(link >> 2) as usize];
    let tets = || compact(vertices, &tet_of, |[a, b, c, d]| [id(a), id(b), id(c), id(d)]);
    let neighbors = || compact(links, &tet_of, |[a, b, c, d]| [tet(a), tet(b), tet(c), tet(d)]);
    let (tets, neighbors) = threads.join(tets, neighbors);
    let mut hull = Vec::new();
    for (t, (tet, beyond)) in tets.iter().zip(&neighbors).enumerate() {
        push_hull(t, tet.map(|v| v.0), beyond.map(|t| t.0), &mut hull);
    }
    Finished { tets, neighbors, hull }
}

/// Converts the entries of numbered slots and drops the others.
fn compact<T: Copy, U>(slots: Vec<T>, tet_of: &[TetId], entry: impl Fn(T) -> U) -> Vec<U> {
    let numbered = slots.into_iter().zip(tet_of).filter(|(_, tet)| **tet != OUTSIDE);
    numbered.map(|(slot, _)| entry(slot)).collect()
}

/// Lists the facets of a tet without a tet beyond.
#[inline(always)]
pub(super) fn push_hull(tet: usize, vertices: [u32; 4], neighbors: [u32; 4], hull: &mut Vec<HullFacet>) {
    if !neighbors.contains(&OUTSIDE.0) {
        return;
    }
    for facet in (0..4).filter(|&facet| neighbors[facet] == OUTSIDE.0) {
        // Together with the opposite vertex in front the facet is positive, so its front faces outward.
        let vertices = FACETS[facet].map(|i| VertexId(vertices[i]));
        hull.push(HullFacet { vertices, tet: TetId::new(tet), facet: facet as u8 });
    }
}
