//! Flat facets: connected triangles of the surface that lie in one plane, exactly or up to the rounding of
//! their coordinates.
//!
//! An edge between two of them does not affect the shape, so it need not be an edge of tets while facets are
//! made. This matters: of the faces of a box cut into two triangles each, half have the diagonal that the
//! Delaunay tets lack; points on it would be in the way of others, and so on. The given triangles are
//! restored afterwards (`repair`).

use super::grown::{by_edge, pair};
use super::levels::{Levels, Merge};
use super::recovery::Part;
use super::sites::Sites;
use crate::base::{Csr, DisjointSets, VertexId};

/// The flat facets and the edges around them.
#[derive(Clone)]
pub(super) struct FlatFacets {
    /// The triangles of each flat facet; the first one defines the plane.
    pub(super) triangles: Csr<u32>,
    /// The edges that are not inside a flat facet; ascending, with the smaller end first.
    pub(super) creases: Vec<[VertexId; 2]>,
}

impl FlatFacets {
    /// Flat facets of one triangle each.
    pub(super) fn of_each(triangles: &[[VertexId; 3]]) -> Self {
        let mut creases: Vec<_> = by_edge(triangles).into_iter().map(|(edge, _)| edge).collect();
        creases.dedup();
        let n = triangles.len();
        Self { triangles: Csr::from_pairs(n, || (0..n).map(|i| (i, i as u32))), creases }
    }

    /// Joins triangles that share an edge with no third one, as `levels` allows.
    pub(super) fn find(sites: &Sites, triangles: &[[VertexId; 3]], levels: &Levels) -> Self {
        let edges = by_edge(triangles);
        let mut flats = DisjointSets::new(triangles.len());
        for (edge, [i, j]) in edges.chunk_by(|a, b| a.0 == b.0).filter_map(pair) {
            let is_one = match [i, j].map(|t| levels.of(t)) {
                [Merge::Exact, Merge::Exact] => {
                    is_flat(sites, edge, [triangles[i as usize], triangles[j as usize]])
                }
                [Merge::Rounded, Merge::Rounded] => levels.grown.is_one(i, j),
                _ => false,
            };
            if is_one {
                flats.join(i, j);
            }
        }
        let (mut of_root, mut firsts) = (vec![u32::MAX; triangles.len()], Vec::new());
        let number = (0..triangles.len() as u32).map(|i| {
            let of = &mut of_root[flats.root(i) as usize];
            if *of == u32::MAX {
                *of = firsts.len() as u32;
                firsts.push(if levels.of(i) == Merge::Rounded { levels.grown.first(i) } else { i });
            }
            *of
        });
        let number: Vec<u32> = number.collect();
        let is_within =
            |run: &[_]| pair(run).is_some_and(|(_, [i, j])| number[i as usize] == number[j as usize]);
        let runs = edges.chunk_by(|a, b| a.0 == b.0).filter(|run| !is_within(run));
        let creases = runs.map(|run| run[0].0).collect();
        let is_first = |i: &u32| firsts[number[*i as usize] as usize] == *i;
        let others = || (0..triangles.len() as u32).filter(|i| !is_first(i));
        let in_order = || firsts.iter().copied().chain(others());
        let triangles =
            Csr::from_pairs(firsts.len(), || in_order().map(|i| (number[i as usize] as usize, i)));
        Self { triangles, creases }
    }

    /// Whether a part is a triangle of a flat facet.
    pub(super) fn has(&self, flat: usize, part: Part) -> bool {
        matches!(part, Part::Triangle(i) if self.triangles.list(flat).contains(&i))
    }
}

/// Whether two triangles at an edge are exactly coplanar.
fn is_flat(sites: &Sites, edge: [VertexId; 2], [s, t]: [[VertexId; 3]; 2]) -> bool {
    let third = |t: [VertexId; 3]| t.into_iter().find(|v| !edge.contains(v));
    match (third(s), third(t)) {
        (Some(p), Some(q)) if p != q => sites.orient3d([edge[0], edge[1], p, q]) == 0,
        _ => false,
    }
}
