//! Which of given edges and facets the tets have: found in one sweep over all tets, on all threads.

use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU32};

use crate::base::{Csr, TetId, Threads, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::kernel::{HalfFacet, Tets};

/// A thread takes this many slots of tets at a time.
pub(super) const SWEEP: usize = 1 << 14;

/// Edges or facets by their vertices: found by the first vertex, then by bisection.
struct Index<'a, const N: usize> {
    keys: &'a [[VertexId; N]],
    /// The places of the keys with each first vertex.
    of_first: Csr<u32>,
}

impl<'a, const N: usize> Index<'a, N> {
    /// `keys` rise, each once, and so do the vertices of each.
    fn new(keys: &'a [[VertexId; N]]) -> Self {
        let n_firsts = keys.last().map_or(0, |key| key[0].index() + 1);
        let of_first = Csr::from_pairs(n_firsts, || keys.iter().map(|key| key[0].index()).zip(0..));
        Self { keys, of_first }
    }

    /// The place of a key, given by its vertices in any order.
    #[inline]
    fn find(&self, vertices: [VertexId; N]) -> Option<usize> {
        let key = sorted_ids(vertices);
        let first = key[0].index();
        let places = if first < self.of_first.len() { self.of_first.list(first) } else { return None };
        let start = *places.first()? as usize;
        let place = self.keys[start..start + places.len()].binary_search(&key).ok()?;
        Some(start + place)
    }
}

/// Returns the edges that no tet has. `edges` rise, each once, smaller vertex first.
pub(super) fn missing_edges(tets: &Tets, edges: &[[VertexId; 2]], threads: &Threads) -> Vec<[VertexId; 2]> {
    let index = Index::new(edges);
    let is_found: Vec<AtomicBool> = edges.iter().map(|_| AtomicBool::new(false)).collect();
    sweep(tets, threads, |_, v| {
        for i in EDGES.iter().filter_map(|&[i, j]| index.find([v[i], v[j]])) {
            is_found[i].store(true, Relaxed);
        }
    });
    edges
        .iter()
        .zip(is_found)
        .filter(|(_, is_found)| !is_found.load(Relaxed))
        .map(|(&edge, _)| edge)
        .collect()
}

/// Returns one side of each facet, the one with the lower number; [`HalfFacet::NONE`] where no tet has it.
pub(super) fn find_facets(tets: &Tets, facets: &[[VertexId; 3]], threads: &Threads) -> Vec<HalfFacet> {
    let mut keys: Vec<_> = facets.iter().map(|&facet| sorted_ids(facet)).collect();
    keys.sort_unstable();
    keys.dedup();
    let index = Index::new(&keys);
    let sides: Vec<AtomicU32> = keys.iter().map(|_| AtomicU32::new(HalfFacet::NONE.0)).collect();
    sweep(tets, threads, |tet, _| {
        for half in Tets::facets(tet) {
            if let Some(i) = index.find(tets.inward(half)) {
                sides[i].fetch_min(half.0, Relaxed);
            }
        }
    });
    let side = |facet: &[VertexId; 3]| index.find(*facet).map(|i| HalfFacet(sides[i].load(Relaxed)));
    facets.iter().map(|facet| side(facet).unwrap_or(HalfFacet::NONE)).collect()
}

/// Calls `see` for each tet, with its vertices, in any order.
fn sweep(tets: &Tets, threads: &Threads, see: impl Fn(TetId, [VertexId; 4]) + Sync + Send) {
    threads.in_runs(tets.n_slots(), SWEEP, |(): &mut (), run| {
        tets.among(run).for_each(|(tet, v)| see(tet, v));
        Vec::<()>::new()
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::splitmix64;
    use crate::delaunay::Triangulation;

    /// Against walks around a vertex, for edges and facets of tets, others, and some given twice.
    #[test]
    fn a_sweep_finds_what_walks_find() {
        let mut seed = 7;
        let mut random = |n: u64| {
            seed += 1;
            splitmix64(seed) % n
        };
        let points: Vec<_> = (0..9000).map(|_| [0; 3].map(|_| random(1 << 20) as f64)).collect();
        let triangulation = Triangulation::new(&points, &Threads::single()).unwrap();
        let (given, neighbors) = (triangulation.tets(), triangulation.neighbors());
        let mut tets = Tets::from_neighbors(given, neighbors, points.len(), &Threads::single());
        // A hole, and slots that are free.
        (1000..1100).for_each(|slot| tets.remove(TetId::new(slot)));
        let mut facets: Vec<[VertexId; 3]> = Vec::new();
        for _ in 0..3000 {
            let tet = given[random(given.len() as u64) as usize];
            let other = VertexId::new(random(9000) as usize);
            facets.extend([[tet[2], tet[0], tet[1]], [tet[3], tet[1], other]]);
        }
        facets.retain(|&[a, b, c]| a != b && b != c && c != a);
        facets.extend_from_within(..100);
        let has = |tets: &Tets, vertices: &[VertexId]| {
            tets.iter().any(|(_, v)| vertices.iter().all(|vertex| v.contains(vertex)))
        };
        let mut edges: Vec<_> = facets.iter().map(|&[_, b, c]| sorted_ids([b, c])).collect();
        edges.sort_unstable();
        edges.dedup();
        let (few_facets, few_edges) = (&facets[facets.len() - 300..], &edges[..300]);
        for n in [1, 2, 5] {
            let threads = Threads::exactly(n).unwrap().shuffled(3);
            let sides = find_facets(&tets, &facets, &threads);
            for (facet, side) in facets.iter().zip(&sides).filter(|(_, side)| !side.is_none()) {
                assert_eq!(sorted_ids(tets.inward(*side)), sorted_ids(*facet));
            }
            for (facet, side) in few_facets.iter().zip(&sides[sides.len() - 300..]) {
                assert_eq!(has(&tets, facet), !side.is_none(), "{facet:?}");
            }
            let missing = missing_edges(&tets, &edges, &threads);
            for edge in few_edges {
                assert_eq!(has(&tets, edge), missing.binary_search(edge).is_err(), "{edge:?}");
            }
            assert!(missing.len() > 100 && edges.len() - missing.len() > 100);
        }
    }
}
