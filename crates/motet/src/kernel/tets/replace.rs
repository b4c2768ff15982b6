//! Tets without walls replaced by others that fill the same space.

use crate::base::{TetId, VertexId, sorted_ids};
use crate::kernel::link::HalfFacet;
use crate::kernel::tets::Tets;

impl Tets {
    /// Adds a tet from `apex` on each face of which it is not a vertex, and links them all. A face is given
    /// as seen from the apex, with the facet behind it, to which facet 3 of the tet is linked; all faces
    /// together form a closed surface. `seams` is a buffer that holds the edges of the faces afterwards,
    /// sorted, each with the facets on its two sides.
    pub(crate) fn cone(
        &mut self,
        apex: VertexId,
        faces: impl Iterator<Item = (HalfFacet, [VertexId; 3])>,
        seams: &mut Vec<([VertexId; 2], HalfFacet)>,
    ) -> Vec<TetId> {
        seams.clear();
        let mut made = Vec::new();
        for (outer, [a, b, c]) in faces {
            let edges = [[b, c], [c, a], [a, b]].map(sorted_ids);
            if let Some(i) = [a, b, c].iter().position(|&v| v == apex) {
                seams.push((edges[i], outer));
                continue;
            }
            let tet = self.add([a, b, c, apex]);
            made.push(tet);
            self.join(HalfFacet::new(tet, 3), outer);
            seams.extend((0..3).map(|i| (edges[i], HalfFacet::new(tet, i))));
        }
        seams.sort_unstable();
        seams.as_chunks::<2>().0.iter().for_each(|pair| self.join(pair[0].1, pair[1].1));
        made
    }

    /// Replaces tets by positive ones that fill the same space.
    pub(crate) fn replace(&mut self, old: &[TetId], new: &[[VertexId; 4]]) {
        self.begin();
        old.iter().for_each(|&tet| _ = self.mark(tet));
        let mut faces = Vec::with_capacity(4 * (old.len() + new.len()));
        for half in old.iter().flat_map(|&tet| Self::facets(tet)) {
            let other = self.across(half);
            if other.is_none() || !self.is_marked(other.tet()) {
                faces.push((sorted_ids(self.inward(half)), other));
            }
        }
        old.iter().for_each(|&tet| self.remove(tet));
        self.put(new, faces);
    }

    /// Adds positive tets and links them with each other and with the facets behind `faces`.
    pub(crate) fn put(&mut self, new: &[[VertexId; 4]], mut faces: Vec<([VertexId; 3], HalfFacet)>) {
        for &vertices in new {
            let tet = self.add(vertices);
            faces.extend(Self::facets(tet).map(|half| (sorted_ids(self.inward(half)), half)));
        }
        faces.sort_unstable();
        for pair in faces.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *pair {
                self.join(a, b);
            }
        }
    }
}
