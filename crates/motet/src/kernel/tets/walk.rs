//! Walks from tet to tet through facets: the tets of a vertex, those around an edge, and facets with given
//! vertices.

use crate::base::{TetId, VertexId};
use crate::kernel::link::HalfFacet;
use crate::kernel::marks::Marks;
use crate::kernel::tets::{NO_TET, Tets};

/// Collects the tets reached from `first` through facets whose opposite vertices satisfy `passes`, nearest
/// first; `across` gives the facet behind a facet. The tets reached are in `marks` afterwards, and no others.
pub(in crate::kernel) fn flood(
    tets: &Tets,
    first: TetId,
    (reached, marks): (&mut Vec<TetId>, &mut Marks),
    passes: impl Fn(VertexId) -> bool,
    mut across: impl FnMut(HalfFacet) -> HalfFacet,
) {
    marks.begin(tets.n_slots());
    marks.add(first);
    reached.clear();
    reached.push(first);
    let mut next = 0;
    while let Some(&tet) = reached.get(next) {
        next += 1;
        let vertices = tets.vertices(tet);
        for half in Tets::facets(tet) {
            if !passes(vertices[half.facet()]) {
                continue;
            }
            let other = across(half);
            if !other.is_none() && marks.add(other.tet()) {
                reached.push(other.tet());
            }
        }
    }
}

/// Walks in tets without walls.
impl Tets {
    /// Starts a new round of marking, in which no tet is marked.
    pub(crate) fn begin(&mut self) {
        self.marks.begin(self.n_slots());
    }

    /// Whether a tet is marked.
    #[inline]
    pub(crate) fn is_marked(&self, tet: TetId) -> bool {
        self.marks.has(tet)
    }

    /// Marks a tet; returns whether it was unmarked before.
    #[inline]
    pub(crate) fn mark(&mut self, tet: TetId) -> bool {
        self.marks.add(tet)
    }

    /// Collects all tets of a vertex; they are marked in a new round.
    pub(crate) fn star(&mut self, vertex: VertexId, star: &mut Vec<TetId>) {
        star.clear();
        let first = self.tet_of(vertex);
        if first != NO_TET {
            self.reach(first, star, |opposite| opposite != vertex);
        }
    }

    /// Collects the tets reached from `first` through facets whose opposite vertices satisfy `passes`; they
    /// are marked in a new round.
    fn reach(&mut self, first: TetId, reached: &mut Vec<TetId>, passes: impl Fn(VertexId) -> bool) {
        let mut marks = std::mem::take(&mut self.marks);
        flood(self, first, (reached, &mut marks), passes, |half| self.across(half));
        self.marks = marks;
    }

    /// Finds a tet of an edge; `star` is a buffer.
    pub(crate) fn find_edge(&mut self, [a, b]: [VertexId; 2], star: &mut Vec<TetId>) -> Option<TetId> {
        self.star(a, star);
        star.iter().copied().find(|&tet| self.vertices(tet).contains(&b))
    }

    /// Finds one side of a facet; `star` is a buffer.
    pub(crate) fn find_facet(
        &mut self,
        [a, b, c]: [VertexId; 3],
        star: &mut Vec<TetId>,
    ) -> Option<HalfFacet> {
        self.star(a, star);
        let has = |tet: &TetId| {
            let v = self.vertices(*tet);
            v.contains(&b) && v.contains(&c)
        };
        let tet = star.iter().copied().find(has)?;
        let i = self.vertices(tet).iter().position(|&v| v != a && v != b && v != c)?;
        Some(HalfFacet::new(tet, i))
    }

    /// Collects the tets around an edge, starting from one of them.
    pub(crate) fn around_from(&mut self, edge: [VertexId; 2], first: TetId, ring: &mut Vec<TetId>) {
        self.reach(first, ring, |opposite| !edge.contains(&opposite));
    }

    /// Collects the tets around an existing edge.
    pub(crate) fn around(&mut self, [a, b]: [VertexId; 2], star: &mut Vec<TetId>) {
        self.star(a, star);
        star.retain(|&tet| self.vertices(tet).contains(&b));
    }
}
