//! A changeable set of tets: flat arrays with one slot per tet, each facet linked to the one on its other
//! side.

use super::super::Triangulation;
use crate::base::{TetId, VertexId, sorted_ids};
use crate::geometry::tet::FACETS;
use crate::kernel::HalfFacet;
use crate::spatial::OUTSIDE;

/// The vertices recorded for a slot without a tet.
const FREE: [VertexId; 4] = [VertexId(u32::MAX); 4];

/// The tets and their adjacency.
#[derive(Default)]
pub(super) struct Tets {
    vertices: Vec<[VertexId; 4]>,
    links: Vec<[HalfFacet; 4]>,
    /// One tet of each vertex.
    at: Vec<TetId>,
    free: Vec<TetId>,
    marks: Vec<u32>,
    round: u32,
}

impl Tets {
    /// Copies the tets of a triangulation.
    pub(super) fn new(triangulation: &Triangulation) -> Self {
        let (vertices, neighbors) = (triangulation.tets(), triangulation.neighbors());
        let back = |tet: usize, other: TetId| {
            let i = neighbors[other.index()].iter().position(|&n| n.index() == tet);
            HalfFacet::new(other, i.unwrap_or_default())
        };
        let link = |tet: usize, n: TetId| if n == OUTSIDE { HalfFacet::NONE } else { back(tet, n) };
        let links = neighbors.iter().enumerate().map(|(tet, n)| n.map(|n| link(tet, n)));
        let mut tets = Self {
            vertices: vertices.to_vec(),
            links: links.collect(),
            at: vec![OUTSIDE; triangulation.points().len()],
            free: Vec::new(),
            marks: vec![0; vertices.len()],
            round: 0,
        };
        for (tet, corners) in vertices.iter().enumerate() {
            corners.iter().for_each(|v| tets.at[v.index()] = TetId::new(tet));
        }
        tets
    }

    /// Removes all tets. The entries of `at` are stale until their vertices get new tets.
    pub(super) fn clear(&mut self) {
        self.vertices.clear();
        self.links.clear();
        self.free.clear();
        self.marks.clear();
        self.round = 0;
    }

    /// The number of slots, free ones included.
    pub(super) fn n_slots(&self) -> usize {
        self.vertices.len()
    }

    /// The existing tets.
    pub(super) fn iter(&self) -> impl Iterator<Item = (TetId, [VertexId; 4])> + '_ {
        let all = self.vertices.iter().enumerate().map(|(t, &v)| (TetId::new(t), v));
        all.filter(|(_, v)| *v != FREE)
    }

    #[inline]
    pub(super) fn vertices(&self, tet: TetId) -> [VertexId; 4] {
        self.vertices[tet.index()]
    }

    /// The facet on the other side of a facet.
    #[inline]
    pub(super) fn across(&self, half: HalfFacet) -> HalfFacet {
        self.links[half.tet().index()][half.facet()]
    }

    /// The four facets of a tet.
    pub(super) fn facets(tet: TetId) -> [HalfFacet; 4] {
        [0, 1, 2, 3].map(|i| HalfFacet::new(tet, i))
    }

    /// The vertices of a facet, ordered so that followed by the vertex opposite they make a positive tet.
    #[inline]
    pub(super) fn inward(&self, half: HalfFacet) -> [VertexId; 3] {
        let ([a, b, c], v) = (FACETS[half.facet()], self.vertices[half.tet().index()]);
        [v[a], v[c], v[b]]
    }

    /// One tet of a vertex; `OUTSIDE` where it has none.
    pub(super) fn at(&self, vertex: VertexId) -> TetId {
        self.at.get(vertex.index()).copied().unwrap_or(OUTSIDE)
    }

    /// Sets the tet of a vertex, where the tets added last have been removed again.
    pub(super) fn set_at(&mut self, vertex: VertexId, tet: TetId) {
        self.at[vertex.index()] = tet;
    }

    /// Puts a positive tet into a free slot; nothing is linked yet.
    pub(super) fn add(&mut self, vertices: [VertexId; 4]) -> TetId {
        let tet = self.free.pop().unwrap_or_else(|| {
            self.vertices.push(FREE);
            self.links.push([HalfFacet::NONE; 4]);
            self.marks.push(0);
            TetId::new(self.vertices.len() - 1)
        });
        self.vertices[tet.index()] = vertices;
        self.links[tet.index()] = [HalfFacet::NONE; 4];
        self.marks[tet.index()] = 0;
        for v in vertices {
            if self.at.len() <= v.index() {
                self.at.resize(v.index() + 1, OUTSIDE);
            }
            self.at[v.index()] = tet;
        }
        tet
    }

    /// Frees a slot. The caller must relink its neighbours and give its vertices new tets.
    pub(super) fn remove(&mut self, tet: TetId) {
        self.vertices[tet.index()] = FREE;
        self.free.push(tet);
    }

    /// Adds a tet from `apex` on each face of which it is not a vertex, and links them all. A face is given
    /// as seen from the apex, with the facet behind it, to which facet 3 of the tet is linked; all faces
    /// together form a closed surface. `seams` is a buffer that holds the edges of the faces afterwards,
    /// sorted, each with the facets on its two sides.
    pub(super) fn cone(
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
    pub(super) fn replace(&mut self, old: &[TetId], new: &[[VertexId; 4]]) {
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
    pub(super) fn put(&mut self, new: &[[VertexId; 4]], mut faces: Vec<([VertexId; 3], HalfFacet)>) {
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

    /// Links two facets with each other.
    pub(super) fn join(&mut self, a: HalfFacet, b: HalfFacet) {
        for (from, to) in [(a, b), (b, a)] {
            if !from.is_none() {
                self.links[from.tet().index()][from.facet()] = to;
            }
        }
    }

    /// Starts a new round of marking, in which no tet is marked.
    pub(super) fn begin(&mut self) {
        if self.round == u32::MAX {
            self.marks.fill(0);
            self.round = 0;
        }
        self.round += 1;
    }

    pub(super) fn is_marked(&self, tet: TetId) -> bool {
        self.marks[tet.index()] == self.round
    }

    /// Marks a tet; returns whether it was unmarked before.
    pub(super) fn mark(&mut self, tet: TetId) -> bool {
        std::mem::replace(&mut self.marks[tet.index()], self.round) != self.round
    }

    /// Collects all tets of a vertex; they are marked in a new round.
    pub(super) fn star(&mut self, vertex: VertexId, star: &mut Vec<TetId>) {
        star.clear();
        let first = self.at(vertex);
        if first != OUTSIDE {
            self.flood(first, star, |opposite| opposite != vertex);
        }
    }

    /// Collects the tets reached from `first` through facets whose opposite vertices satisfy `passes`; they
    /// are marked in a new round.
    fn flood(&mut self, first: TetId, reached: &mut Vec<TetId>, passes: impl Fn(VertexId) -> bool) {
        self.begin();
        self.mark(first);
        reached.clear();
        reached.push(first);
        let mut next = 0;
        while let Some(&tet) = reached.get(next) {
            next += 1;
            for half in Self::facets(tet) {
                let other = self.across(half);
                if passes(self.vertices(tet)[half.facet()]) && !other.is_none() && self.mark(other.tet()) {
                    reached.push(other.tet());
                }
            }
        }
    }

    /// Finds a tet of an edge; `star` is a buffer.
    pub(super) fn find_edge(&mut self, [a, b]: [VertexId; 2], star: &mut Vec<TetId>) -> Option<TetId> {
        self.star(a, star);
        star.iter().copied().find(|&tet| self.vertices(tet).contains(&b))
    }

    /// Finds one side of a facet; `star` is a buffer.
    pub(super) fn find_facet(
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
    pub(super) fn around_from(&mut self, edge: [VertexId; 2], first: TetId, ring: &mut Vec<TetId>) {
        self.flood(first, ring, |opposite| !edge.contains(&opposite));
    }

    /// Collects the tets around an existing edge.
    pub(super) fn around(&mut self, [a, b]: [VertexId; 2], star: &mut Vec<TetId>) {
        self.star(a, star);
        star.retain(|&tet| self.vertices[tet.index()].contains(&b));
    }
}
