//! The Delaunay triangulation of the vertices around a hollow, as a guide for filling it.
//!
//! It knows nothing of what can be seen. But where all faces of the hollow are facets of it, the tets between them are those that are
//! wanted; and where some are not, most of its tets still are, and only those faces can hide a vertex.

use hashbrown::HashMap;

use super::insert::Insertion;
use super::sites::Sites;
use super::tets::Tets;
use crate::base::VertexId;
use crate::geometry::tet::FACETS;

/// The triangulation, and its facets by their vertices.
#[derive(Default)]
pub(super) struct Guide {
    tets: Tets,
    insertion: Insertion,
    /// The apex of the tet on each facet, seen from the side on which its vertices run counter-clockwise, smallest first.
    apexes: HashMap<[VertexId; 3], VertexId>,
}

impl Guide {
    /// Triangulates vertices of `sites`.
    pub(super) fn build(&mut self, sites: &Sites, vertices: &[VertexId]) {
        let [a, b, c, d] = sites.around_all();
        self.tets.clear();
        let mut start = self.tets.add([a, b, c, d]);
        for &vertex in vertices {
            self.insertion.insert(&mut self.tets, sites, vertex, start);
            start = self.tets.at(vertex);
        }
        self.apexes.clear();
        for (_, v) in self.tets.iter() {
            for (i, [p, q, r]) in FACETS.into_iter().enumerate() {
                self.apexes.insert(smallest_first([v[p], v[r], v[q]]), v[i]);
            }
        }
    }

    /// The apex of the tet on a face, on the side from which its vertices run counter-clockwise; `None` where it is no facet. It may
    /// be a vertex far outside.
    pub(super) fn apex(&self, face: [VertexId; 3]) -> Option<VertexId> {
        self.apexes.get(&smallest_first(face)).copied()
    }

    /// Whether a face is a facet.
    pub(super) fn has(&self, [a, b, c]: [VertexId; 3]) -> bool {
        self.apex([a, b, c]).is_some() || self.apex([a, c, b]).is_some()
    }
}

/// The same turn, from the smallest vertex on.
pub(super) fn smallest_first([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
