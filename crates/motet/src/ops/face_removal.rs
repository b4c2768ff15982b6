//! Face removal: facets are removed and an edge is put through them, the inverse of edge removal.
//!
//! Adjacent facets between the same two vertices `a` and `b` are removed, with the tets on both sides of
//! them; the edge `ab` is inserted, with a tet to every outer edge of the facets. Which facets to take is
//! found by trying at each edge whether to stop or to go on (Shewchuk 2002, *Two discrete optimization
//! algorithms for the topological improvement of tetrahedral meshes*). With one facet it is the flip 2-3.

use crate::base::{TetId, VertexId};
use crate::geometry::tet::FACETS;
use crate::kernel::{Behind, Change, Complex};

/// The largest number of facets removed at once.
const MAX_FACES: usize = 8;
/// The largest number of edges crossed from the first facet to any other.
const MAX_DEPTH: usize = 4;

/// Work arrays, reused from call to call.
#[derive(Clone, Debug, Default)]
pub struct FaceRemoval {
    /// The tets on both sides of the facets taken so far; `rim` holds their outer edges.
    cavity: Vec<TetId>,
    rim: Vec<[VertexId; 2]>,
}

/// A facet between `a` and `b`, by its two tets.
#[derive(Clone, Copy)]
struct Face {
    at_a: TetId,
    at_b: TetId,
}

impl FaceRemoval {
    /// Proposes to remove facet `i` of a tet, and adjacent ones if that is better. Returns `false` if there
    /// is no way better than `bar`.
    pub fn propose(
        &mut self,
        complex: &Complex,
        tet: TetId,
        i: usize,
        bar: f64,
        change: &mut Change,
    ) -> bool {
        change.clear();
        let Behind::Tet(other) = complex.behind(tet, i) else { return false };
        let a = complex.vertices(tet)[i];
        let b = complex.vertices(other.tet())[other.facet()];
        let face = Face { at_a: tet, at_b: other.tet() };
        let [p, q, r] = complex.facet(crate::kernel::HalfFacet::new(tet, i));
        self.cavity.clear();
        self.rim.clear();
        self.cavity.extend([face.at_a, face.at_b]);
        for edge in [[p, q], [q, r], [r, p]] {
            if self.at_edge(complex, [a, b], face, edge, bar, 0) <= bar {
                return false;
            }
        }
        change.cavity.extend_from_slice(&self.cavity);
        for &[p, q] in &self.rim {
            change.push(complex, [a, b, p, q], complex.region(tet));
        }
        true
    }

    /// The best quality possible at an edge of a taken facet: that of the tet to the edge, or that of the
    /// tets if the facet behind the edge is taken, too. Adds what the better choice takes to the lists.
    fn at_edge(
        &mut self,
        complex: &Complex,
        [a, b]: [VertexId; 2],
        face: Face,
        [p, q]: [VertexId; 2],
        bar: f64,
        depth: usize,
    ) -> f64 {
        let stop = self.judge(complex, [a, b, p, q]);
        let (n_tets, n_edges) = (self.cavity.len(), self.rim.len());
        let may_go_on = n_tets / 2 < MAX_FACES && depth < MAX_DEPTH;
        let next = if may_go_on { Self::beside(complex, [a, b], face, [p, q]) } else { None };
        let is_new = |face: &Face| !self.cavity.contains(&face.at_a) && !self.cavity.contains(&face.at_b);
        if let Some((next, w)) = next.filter(|(face, _)| is_new(face)) {
            self.cavity.extend([next.at_a, next.at_b]);
            let bar = stop.max(bar);
            let mut worst = self.at_edge(complex, [a, b], next, [p, w], bar, depth + 1);
            if worst > bar {
                worst = worst.min(self.at_edge(complex, [a, b], next, [w, q], bar, depth + 1));
            }
            if worst > bar {
                return worst;
            }
            self.cavity.truncate(n_tets);
            self.rim.truncate(n_edges);
        }
        self.rim.push([p, q]);
        stop
    }

    /// The quality of a tet that would replace tets taken so far.
    fn judge(&self, complex: &Complex, vertices: [VertexId; 4]) -> f64 {
        complex.judge(vertices.map(|v| complex.point(v)), |i| {
            let mut facet = FACETS[i].map(|corner| vertices[corner]);
            facet.sort_unstable();
            complex.side_of(&self.cavity, facet)
        })
    }

    /// The facet between `a` and `b` behind the edge `pq` of a facet, and its third vertex.
    fn beside(
        complex: &Complex,
        [a, b]: [VertexId; 2],
        face: Face,
        [p, q]: [VertexId; 2],
    ) -> Option<(Face, VertexId)> {
        let behind = |tet: TetId, apex: VertexId| {
            let vertices = complex.vertices(tet);
            let third = (0..4).find(|&i| ![apex, p, q].contains(&vertices[i]))?;
            match complex.behind(tet, third) {
                Behind::Tet(half) => Some((half.tet(), complex.vertices(half.tet())[half.facet()])),
                Behind::Wall(_) => None,
            }
        };
        let (at_a, w) = behind(face.at_a, a)?;
        let (at_b, v) = behind(face.at_b, b)?;
        if w != v || at_a == at_b {
            return None;
        }
        let joined =
            matches!(complex.behind(at_a, complex.place(at_a, a)), Behind::Tet(half) if half.tet() == at_b);
        joined.then_some((Face { at_a, at_b }, w))
    }
}
