//! Flat facets: triangles of the surface that hang together and lie in one plane, exactly.
//!
//! An edge between two of them shapes nothing, so it need not be an edge of tets while facets are made. That matters: of the faces of a box
//! cut into two triangles each, half have the diagonal that Delaunay tets do not, and points on it would be in the way
//! of others, and so on. What the triangles were is put right afterwards (`keep`).

use super::sites::Sites;
use super::unmade::Part;
use crate::base::{Csr, Sets, VertexId, rising};

/// The flat facets and the edges around them.
#[derive(Clone)]
pub(super) struct Flats {
    /// The triangles of each.
    pub(super) triangles: Csr<u32>,
    /// The edges that are not within one of them, smaller end first; rising.
    pub(super) creases: Vec<[VertexId; 2]>,
}

impl Flats {
    /// Finds them; each triangle is one of its own where they are not to be `merged`.
    pub(super) fn find(sites: &Sites, triangles: &[[VertexId; 3]], merged: bool) -> Self {
        let mut edges: Vec<([VertexId; 2], u32)> = Vec::with_capacity(3 * triangles.len());
        for (i, &[a, b, c]) in triangles.iter().enumerate() {
            edges.extend([[a, b], [b, c], [c, a]].map(|e| (rising(e), i as u32)));
        }
        edges.sort_unstable();
        let mut flats = Sets::new(triangles.len());
        let mut creases = Vec::new();
        for run in edges.chunk_by(|a, b| a.0 == b.0) {
            match *run {
                [(edge, i), (_, j)]
                    if merged && is_flat(sites, edge, [triangles[i as usize], triangles[j as usize]]) =>
                {
                    flats.join(i, j);
                }
                _ => creases.push(run[0].0),
            }
        }
        let mut number = vec![u32::MAX; triangles.len()];
        let mut count = 0;
        let flat_of: Vec<u32> = (0..triangles.len() as u32)
            .map(|i| {
                let of = &mut number[flats.root(i) as usize];
                if *of == u32::MAX {
                    *of = count;
                    count += 1;
                }
                *of
            })
            .collect();
        let pairs = || flat_of.iter().enumerate().map(|(i, &flat)| (flat as usize, i as u32));
        Self { triangles: Csr::from_pairs(count as usize, pairs), creases }
    }

    /// Whether a part is a triangle of a flat facet.
    pub(super) fn has(&self, flat: usize, part: Part) -> bool {
        matches!(part, Part::Triangle(i) if self.triangles.list(flat).contains(&i))
    }
}

/// Whether two triangles at an edge lie in one plane.
fn is_flat(sites: &Sites, edge: [VertexId; 2], [s, t]: [[VertexId; 3]; 2]) -> bool {
    let third = |t: [VertexId; 3]| t.into_iter().find(|v| !edge.contains(v));
    match (third(s), third(t)) {
        (Some(p), Some(q)) if p != q => sites.orient3d([edge[0], edge[1], p, q]) == 0,
        _ => false,
    }
}
