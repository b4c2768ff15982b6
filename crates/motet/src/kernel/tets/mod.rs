//! The topology of tets: flat arrays with a slot per tet, which say what lies behind each facet. The only
//! store of tets that can be changed: for [`Complex`](crate::kernel::Complex), and for surfaces that become
//! facets of tets, where there are no walls.
//!
//! | what | file |
//! |---|---|
//! | slots, links, one tet of each vertex | here |
//! | the tets of a vertex, those around an edge, a facet with given vertices | `walk` |
//! | tets replaced by others that fill the same space | `replace` |

mod replace;
mod walk;

pub(super) use walk::flood;

use std::ops::Range;

use crate::base::{TetId, Threads, VertexId};
use crate::geometry::tet::FACETS;
use crate::kernel::link::{HalfFacet, Link};
use crate::kernel::marks::Marks;

/// No tet.
pub(crate) const NO_TET: TetId = TetId(u32::MAX);

/// Vertices of a free slot.
pub(super) const FREE: [VertexId; 4] = [VertexId(u32::MAX); 4];

/// Tets, what lies behind their facets, and one tet of each vertex.
///
/// Ids are valid while a tet exists; the slot that was freed last is reused first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tets {
    vertices: Vec<[VertexId; 4]>,
    links: Vec<[Link; 4]>,
    /// One tet of each vertex; [`NO_TET`] for vertices without tets.
    of_vertex: Vec<TetId>,
    free: Vec<TetId>,
    /// Tets reached by the walk in progress.
    marks: Marks,
}

impl Tets {
    /// Tets with `links` behind their facets.
    pub(super) fn new(vertices: Vec<[VertexId; 4]>, links: Vec<[Link; 4]>, n_vertices: usize) -> Self {
        let mut of_vertex = vec![NO_TET; n_vertices];
        for (t, tet) in vertices.iter().enumerate() {
            tet.iter().for_each(|v| of_vertex[v.index()] = TetId::new(t));
        }
        Self { vertices, links, of_vertex, free: Vec::new(), marks: Marks::default() }
    }

    /// Tets without walls, given the tet behind each facet; [`NO_TET`] beyond the boundary.
    pub(crate) fn from_neighbors(
        vertices: &[[VertexId; 4]],
        neighbors: &[[TetId; 4]],
        n_vertices: usize,
        threads: &Threads,
    ) -> Self {
        let back = |tet: usize, other: TetId| {
            let i = neighbors[other.index()].iter().position(|n| n.index() == tet);
            HalfFacet::new(other, i.unwrap_or_default())
        };
        let half = |tet: usize, n: TetId| if n == NO_TET { HalfFacet::NONE } else { back(tet, n) };
        let links = threads.map(neighbors.len(), |tet| neighbors[tet].map(|n| Link::tet(half(tet, n))));
        Self::new(vertices.to_vec(), links, n_vertices)
    }

    /// Removes all tets. Vertices keep the ids of their former tets until they get new ones.
    pub(crate) fn clear(&mut self) {
        self.vertices.clear();
        self.links.clear();
        self.free.clear();
    }

    /// The number of slots, free ones included; tet ids are below it.
    #[inline]
    pub(crate) fn n_slots(&self) -> usize {
        self.vertices.len()
    }

    /// The free slots, in the order in which they were freed.
    #[inline]
    pub(super) fn free_slots(&self) -> &[TetId] {
        &self.free
    }

    /// The existing tets with their vertices, in rising order of id.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (TetId, [VertexId; 4])> + Clone + '_ {
        self.among(0..self.vertices.len())
    }

    /// The existing tets in some slots with their vertices, in rising order of id.
    pub(crate) fn among(
        &self,
        slots: Range<usize>,
    ) -> impl Iterator<Item = (TetId, [VertexId; 4])> + Clone + '_ {
        let all = slots.clone().zip(&self.vertices[slots]).map(|(t, &v)| (TetId::new(t), v));
        all.filter(|(_, v)| *v != FREE)
    }

    /// Whether a tet with this id exists.
    #[inline]
    pub(super) fn is_alive(&self, tet: TetId) -> bool {
        self.vertices[tet.index()] != FREE
    }

    /// The vertices of a tet.
    #[inline(always)]
    pub(crate) fn vertices(&self, tet: TetId) -> [VertexId; 4] {
        self.vertices[tet.index()]
    }

    /// The local number of a vertex in a tet that has it.
    #[inline]
    pub(super) fn place(&self, tet: TetId, vertex: VertexId) -> usize {
        let vertices = self.vertices(tet);
        debug_assert!(vertices.contains(&vertex));
        // Not a search: three comparisons, no branch.
        usize::from(vertices[1] == vertex)
            + 2 * usize::from(vertices[2] == vertex)
            + 3 * usize::from(vertices[3] == vertex)
    }

    /// The four facets of a tet.
    #[inline]
    pub(crate) fn facets(tet: TetId) -> [HalfFacet; 4] {
        [0, 1, 2, 3].map(|i| HalfFacet::new(tet, i))
    }

    /// The vertices of a facet, counter-clockwise seen from outside its tet.
    #[inline]
    pub(super) fn outward(&self, half: HalfFacet) -> [VertexId; 3] {
        let v = self.vertices(half.tet());
        FACETS[half.facet()].map(|place| v[place])
    }

    /// The vertices of a facet, ordered so that followed by the vertex opposite they make a positive tet.
    #[inline]
    pub(crate) fn inward(&self, half: HalfFacet) -> [VertexId; 3] {
        let ([a, b, c], v) = (FACETS[half.facet()], self.vertices(half.tet()));
        [v[a], v[c], v[b]]
    }

    /// The link of a facet: what lies behind it.
    #[inline(always)]
    pub(super) fn link(&self, half: HalfFacet) -> Link {
        self.links[half.tet().index()][half.facet()]
    }

    /// The links of the four facets of a tet.
    #[inline]
    pub(super) fn links(&self, tet: TetId) -> [Link; 4] {
        self.links[tet.index()]
    }

    /// The facet of the tet behind a facet that is no wall; [`HalfFacet::NONE`] beyond the boundary.
    #[inline]
    pub(crate) fn across(&self, half: HalfFacet) -> HalfFacet {
        self.link(half).half()
    }

    /// One tet of a vertex; [`NO_TET`] where it has none.
    #[inline]
    pub(crate) fn tet_of(&self, vertex: VertexId) -> TetId {
        self.of_vertex.get(vertex.index()).copied().unwrap_or(NO_TET)
    }

    /// One tet of each vertex; [`NO_TET`] for vertices without tets.
    #[inline]
    pub(super) fn tets_of_vertices(&self) -> &[TetId] {
        &self.of_vertex
    }

    /// Sets the tet of a vertex.
    #[inline]
    pub(crate) fn set_tet_of(&mut self, vertex: VertexId, tet: TetId) {
        self.of_vertex[vertex.index()] = tet;
    }

    /// Sets the vertices of a slot.
    #[inline]
    pub(super) fn set_vertices(&mut self, tet: TetId, vertices: [VertexId; 4]) {
        self.vertices[tet.index()] = vertices;
    }

    /// Sets what lies behind a facet.
    #[inline]
    pub(super) fn set_link(&mut self, half: HalfFacet, link: Link) {
        self.links[half.tet().index()][half.facet()] = link;
    }

    /// Sets what lies behind the four facets of a tet.
    #[inline]
    pub(super) fn set_links(&mut self, tet: TetId, links: [Link; 4]) {
        self.links[tet.index()] = links;
    }

    /// Takes the slot that was freed last, or a new one; what it held stays until it is set.
    #[inline]
    pub(super) fn take_slot(&mut self) -> TetId {
        self.free.pop().unwrap_or_else(|| {
            self.vertices.push(FREE);
            self.links.push([Link::tet(HalfFacet::NONE); 4]);
            TetId::new(self.vertices.len() - 1)
        })
    }

    /// Frees a slot. The caller must relink its neighbours and give its vertices new tets.
    #[inline]
    pub(crate) fn remove(&mut self, tet: TetId) {
        self.vertices[tet.index()] = FREE;
        self.free.push(tet);
    }

    /// Puts a slot, which is free, back on the list of free ones: undoes [`Self::take_slot`] of a used slot.
    pub(super) fn put_back_slot(&mut self, tet: TetId) {
        self.free.push(tet);
    }

    /// Takes the slot that was freed last off the list of free ones: undoes [`Self::remove`], but for the
    /// vertices.
    pub(super) fn keep_last_freed(&mut self) {
        self.free.pop();
    }

    /// Drops all slots from the `n`-th: undoes [`Self::take_slot`] of new slots.
    pub(super) fn truncate(&mut self, n: usize) {
        self.vertices.truncate(n);
        self.links.truncate(n);
    }

    /// Sets the number of vertices; new ones have no tet.
    pub(super) fn resize_vertices(&mut self, n: usize) {
        self.of_vertex.resize(n, NO_TET);
    }

    /// Adds a positive tet with nothing behind its facets; it becomes the tet of its vertices.
    pub(crate) fn add(&mut self, vertices: [VertexId; 4]) -> TetId {
        let tet = self.take_slot();
        self.vertices[tet.index()] = vertices;
        self.links[tet.index()] = [Link::tet(HalfFacet::NONE); 4];
        self.marks.remove(tet);
        for v in vertices {
            if self.of_vertex.len() <= v.index() {
                self.resize_vertices(v.index() + 1);
            }
            self.of_vertex[v.index()] = tet;
        }
        tet
    }

    /// Links two facets with each other; [`HalfFacet::NONE`] stands for the space beyond the boundary.
    pub(crate) fn join(&mut self, a: HalfFacet, b: HalfFacet) {
        for (from, to) in [(a, b), (b, a)] {
            if !from.is_none() {
                self.set_link(from, Link::tet(to));
            }
        }
    }
}
