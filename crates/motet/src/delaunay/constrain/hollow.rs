//! The Delaunay triangulation of the vertices around a hollow, as a guide for filling it.
//!
//! The guide ignores visibility. But where all faces of the hollow are facets of it, the tets between them
//! are those wanted; and where some are not, most of its tets still are, and only the faces that are not its
//! facets can hide a vertex.

use hashbrown::HashMap;

use super::insert::Insertion;
use super::sites::Sites;
use crate::base::VertexId;
use crate::geometry::tet::FACETS;
use crate::kernel::Tets;

/// The triangulation, and the apexes of its facets by their vertices.
#[derive(Default)]
pub(super) struct Guide {
    tets: Tets,
    insertion: Insertion,
    /// The apex of the tet on each facet, on the side from which the facet's vertices run counter-clockwise;
    /// the key has the smallest vertex first.
    apexes: HashMap<[VertexId; 3], VertexId>,
}

impl Guide {
    /// Triangulates the given vertices.
    pub(super) fn build(&mut self, sites: &Sites, vertices: &[VertexId]) {
        let [a, b, c, d] = sites.around_all();
        self.tets.clear();
        let mut start = self.tets.add([a, b, c, d]);
        for &vertex in vertices {
            self.insertion.insert(&mut self.tets, sites, vertex, start);
            start = self.tets.tet_of(vertex);
        }
        self.apexes.clear();
        for (_, v) in self.tets.iter() {
            for (i, [p, q, r]) in FACETS.into_iter().enumerate() {
                self.apexes.insert(smallest_first([v[p], v[r], v[q]]), v[i]);
            }
        }
    }

    /// The apex of the tet on a face, on the side from which its vertices run counter-clockwise; `None` where
    /// the face is not a facet. It may be one of the far vertices around everything.
    pub(super) fn apex(&self, face: [VertexId; 3]) -> Option<VertexId> {
        self.apexes.get(&smallest_first(face)).copied()
    }

    /// Whether a face is a facet of the guide.
    pub(super) fn has(&self, [a, b, c]: [VertexId; 3]) -> bool {
        self.apex([a, b, c]).is_some() || self.apex([a, c, b]).is_some()
    }
}

/// Rotates a triangle to start from its smallest vertex; its orientation stays.
pub(super) fn smallest_first([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
