//! Tets, the tets they are divided into, and the edges these share; and how all of it is made conforming.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | store | this, `eights`, `facets` | parents, children, edges and facets |
//! | divide | `divide`, `eight` | the eight parts, and which edges each of them has |
//! | shapes | `classes` | few tets have shapes of their own; what follows from the shape is computed once |
//! | fit | `patterns` | cuts of the tets between divided and undivided ones: all ways to do so, from a table |
//! | choose a way | `fills` | the way whose worst part is best; a tet is mostly divided along its shortest diagonal |
//! | Bey's rule | `bey` | another diagonal, for at most three shapes |
//! | close | `close` | where cuts would be badly shaped, more edges are split or the tet is divided, too: sweeps until nothing changes |
//! | extract | `extract` | the mesh, with the triangles of patches and the origin of everything |
//!
//! Shapes are those of the *reference*: the mesh as it was when its tets became roots. All decisions about a
//! division are made there, so motion does not change them, and the same division requested again gives the
//! same result.

mod bey;
mod bounds;
mod classes;
mod close;
mod divide;
mod eight;
mod eights;
mod extract;
mod facets;
mod fills;
mod patterns;

pub(super) use bounds::ShapeBounds;
pub(super) use close::{Closed, close};
pub(super) use eight::{IMAGES, eight};
pub(super) use extract::{Extracted, extract};
pub(super) use patterns::{FACET_EDGES, patterns};

use classes::{Class, ClassId, Shape};
use eights::Eights;
use facets::{Facets, Middles};
use fills::Fills;
use hashbrown::HashMap;

use crate::base::{EdgeId, ForestVertexId, MaybeId, NodeId, Point, Threads, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, dot, scale, sub};

/// The largest depth of division: what a path of 64 bits can hold, and far beyond the resolution of
/// coordinates.
pub(super) const MAX_GENERATION: u8 = 20;

/// The largest number of tets of a forest: edges, about a fifth more, still have ids, and ids of classes one
/// bit to spare.
pub(super) const MAX_NODES: usize = 2_000_000_000;

/// An edge of tets of some generation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [ForestVertexId; 2],
    /// The vertex in its middle; none if it was never split.
    pub(super) middle: MaybeId<ForestVertexId>,
}

/// A tet of the first mesh, or one of eight that a tet was divided into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) vertices: [ForestVertexId; 4],
    /// The first of its eight parts, which are consecutive; none if it was never divided.
    pub(super) first_child: MaybeId<NodeId>,
    pub(super) shape: Shape,
}

/// The changing state of a tet, stored separately because all of it is scanned in every sweep.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    pub(super) generation: u8,
    /// Whether its division is requested.
    pub(super) is_requested: bool,
    /// Whether it is currently divided into eight.
    pub(super) is_divided: bool,
    /// How many pieces it is currently cut into to fit its neighbours; 0 if it is not cut.
    pub(super) n_pieces: u8,
}

/// All tets, edges and vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Forest {
    /// For each vertex, its position in the reference.
    pub(super) reference: Vec<Point>,
    /// For each vertex that is not of the first mesh, the edge in whose middle it lies.
    pub(super) origin: Vec<EdgeId>,
    /// For each of these, the first of the two consecutive halves of that edge, at the edge's first end.
    first_half: Vec<EdgeId>,
    pub(super) edges: Vec<Edge>,
    /// For each edge, whether it is currently split; stored separately because it is read most.
    pub(super) is_split: Vec<bool>,
    /// The roots, up to seven that stand for nothing, then groups of eight parts.
    pub(super) nodes: Eights<Node>,
    pub(super) states: Eights<State>,
    /// For each tet, its edges.
    pub(super) edges_of: Eights<[EdgeId; 6]>,
    /// For each group of eight parts, the tet that they are parts of.
    parents: Vec<NodeId>,
    pub(super) n_roots: usize,
    pub(super) n_first_vertices: usize,
    /// No tet is divided once there are this many.
    pub(super) max_nodes: usize,
    /// Edges that stay split because a root has a vertex in their middle.
    pub(super) pinned: Vec<EdgeId>,
    /// The halves of such edges, one at each end.
    pinned_halves: HashMap<EdgeId, [EdgeId; 2]>,
    /// The edges of roots, by their ends.
    root_edges: HashMap<[ForestVertexId; 2], EdgeId>,
    /// The three edges between the middles of a facet's edges; see [`Self::inner_edges`].
    facet_edges: Facets,
    /// The classes of shapes: first those of the roots.
    pub(super) classes: Vec<Class>,
    fills: Fills,
}

impl Forest {
    /// Makes a root of every tet, in either orientation; the flag says whether the mesh has it in the
    /// opposite one.
    pub(super) fn new(points: &[Point], tets: &[([ForestVertexId; 4], bool)], threads: &Threads) -> Self {
        let n_roots = tets.len();
        let class = |t: usize| Class::of_root(tets[t].0.map(|v| points[v.index()]));
        let mut forest = Self {
            reference: points.to_vec(),
            n_roots,
            n_first_vertices: points.len(),
            max_nodes: MAX_NODES,
            classes: threads.map(n_roots, class),
            // A large mesh has about a fifth more edges than tets.
            root_edges: HashMap::with_capacity(n_roots + n_roots / 5),
            ..Self::default()
        };
        let (mut nodes, mut edges_of) = (Vec::with_capacity(n_roots), Vec::with_capacity(n_roots));
        for (&(vertices, is_turned), root) in tets.iter().zip(0..) {
            edges_of.push(EDGES.map(|[i, j]| forest.make_root_edge([vertices[i], vertices[j]])));
            let shape = Shape::new(ClassId(root), is_turned);
            nodes.push(Node { vertices, first_child: MaybeId::NONE, shape });
        }
        forest.states = Eights::of(&vec![State::default(); n_roots]);
        (forest.nodes, forest.edges_of) = (Eights::of(&nodes), Eights::of(&edges_of));
        forest
    }

    /// The edge between two vertices of the first mesh.
    pub(super) fn root_edge(&self, [u, v]: [ForestVertexId; 2]) -> Option<EdgeId> {
        self.root_edges.get(&[u.min(v), u.max(v)]).copied()
    }

    /// The edge between two vertices of the first mesh; a new one if there is none.
    fn make_root_edge(&mut self, [u, v]: [ForestVertexId; 2]) -> EdgeId {
        let ends = [u.min(v), u.max(v)];
        *self.root_edges.entry(ends).or_insert_with(|| push_edge(&mut self.edges, &mut self.is_split, ends))
    }

    /// The edges within a facet between the middles of its edges, if it was ever divided, by tets here or by
    /// roots: edge `k` is opposite middle `k`; none where a facet of roots has no such edge.
    pub(super) fn inner_edges(&self, middles: [ForestVertexId; 3]) -> Option<[MaybeId<EdgeId>; 3]> {
        let middles = Middles::new(middles);
        let first = self.facet_edges.get(&middles);
        if first.is_none() && middles.rising.iter().any(|v| v.index() >= self.n_first_vertices) {
            return None;
        }
        let edges = first.map_or([MaybeId::NONE; 3], |first| middles.named(first).map(MaybeId::from));
        Some(self.or_root_edges(&middles, edges))
    }

    /// Replaces edges between two of three middles by edges of roots, where there are such.
    #[inline]
    fn or_root_edges<E: From<EdgeId> + Copy>(&self, middles: &Middles, edges: [E; 3]) -> [E; 3] {
        let are_of_roots = middles.rising[1].index() < self.n_first_vertices;
        if are_of_roots { self.root_edges_or(middles, edges) } else { edges }
    }

    #[cold]
    fn root_edges_or<E: From<EdgeId> + Copy>(&self, middles: &Middles, mut edges: [E; 3]) -> [E; 3] {
        let [x, y, z] = middles.rising;
        for (edge, place) in edges.iter_mut().zip(middles.ranks()) {
            let opposite = [[y, z], [x, z], [x, y]][place];
            *edge = self.known_edge(opposite).map_or(*edge, E::from);
        }
        edges
    }

    /// The edge of a root between two vertices. Returns at once if a vertex belongs to no root, the usual
    /// case for vertices made by divisions.
    #[inline]
    fn known_edge(&self, ends: [ForestVertexId; 2]) -> Option<EdgeId> {
        let are_of_roots = ends.iter().all(|v| v.index() < self.n_first_vertices);
        if are_of_roots { self.root_edge(ends) } else { None }
    }

    /// Finds the edges that stay split.
    pub(super) fn pin(&mut self) {
        let n = self.n_first_vertices;
        let is_pinned =
            |edge: &EdgeId| self.edges[edge.index()].middle.get().is_some_and(|middle| middle.index() < n);
        self.pinned = (0..self.edges.len()).map(EdgeId::new).filter(is_pinned).collect();
        // Their halves may be edges of roots, whether or not a tet here was divided.
        for i in 0..self.pinned.len() {
            self.pin_halves(self.pinned[i]);
        }
    }

    /// Makes the halves of an edge with a vertex of a root in its middle, unless they are there: edges of
    /// roots where there are such.
    fn pin_halves(&mut self, edge: EdgeId) {
        let Edge { ends, middle } = self.edges[edge.index()];
        let Some(middle) = middle.get().filter(|_| !self.pinned_halves.contains_key(&edge)) else { return };
        let halves = ends.map(|end| {
            let known = self.known_edge([end, middle]);
            known.unwrap_or_else(|| push_edge(&mut self.edges, &mut self.is_split, [end, middle]))
        });
        self.pinned_halves.insert(edge, halves);
    }

    /// The halves of an edge, one at each end; none if it was never split.
    #[inline]
    pub(super) fn halves(&self, edge: EdgeId) -> Option<[EdgeId; 2]> {
        let middle = self.edges[edge.index()].middle.get()?;
        match middle.index().checked_sub(self.n_first_vertices) {
            Some(made) => {
                let EdgeId(first) = self.first_half[made];
                Some([EdgeId(first), EdgeId(first + 1)])
            }
            None => self.pinned_halves.get(&edge).copied(),
        }
    }

    /// The tet that a tet is one of eight parts of; none for a root.
    #[inline]
    pub(super) fn parent(&self, node: NodeId) -> Option<NodeId> {
        (node.index() / 8).checked_sub(self.n_roots.div_ceil(8)).map(|eight| self.parents[eight])
    }

    /// The first part of the first divided tet.
    pub(super) fn first_part(&self) -> usize {
        self.n_roots.next_multiple_of(8)
    }

    /// The eight parts of a divided tet, given the first.
    #[inline]
    pub(super) fn parts_from(first: NodeId) -> impl DoubleEndedIterator<Item = NodeId> {
        (first.0..first.0 + 8).map(NodeId)
    }

    /// A tet of the forest, and those that it is a part of.
    pub(super) fn ancestors(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        std::iter::successors(Some(node), move |&node| self.parent(node))
    }

    /// The positions of a tet's corners.
    pub(super) fn corners(&self, node: NodeId) -> [Point; 4] {
        let [a, b, c, d] = self.nodes[node.index()].vertices;
        let place = |v: ForestVertexId| self.reference[v.index()];
        [place(a), place(b), place(c), place(d)]
    }

    /// Which edges of a tet are split, as bits.
    #[inline]
    pub(super) fn mask(&self, node: NodeId) -> u8 {
        let mut mask = 0;
        for (e, edge) in self.edges_of[node.index()].iter().enumerate() {
            mask |= u8::from(self.is_split[edge.index()]) << e;
        }
        mask
    }

    /// Whether the facets with two split edges are cut from the middle of the second, as bits. The cut starts
    /// from the middle of the longer edge, so both tets at a facet agree.
    pub(super) fn cuts(&self, node: NodeId, mask: u8) -> u8 {
        (0..4).fold(0, |cuts, facet| {
            let (split, n) = patterns::split_edges(facet, mask);
            let [first, second, _] = split.map(|e| self.edges_of[node.index()][e]);
            cuts | u8::from(n == 2 && self.is_longer(second, first)) << facet
        })
    }

    /// Whether a triangle is cut from the middle of the second of its split edges, given by rank: it has two,
    /// and the second is longer.
    pub(super) fn is_cut_from_second(&self, split: [Option<EdgeId>; 3]) -> bool {
        let mut split = split.into_iter().flatten();
        match (split.next(), split.next(), split.next()) {
            (Some(first), Some(second), None) => self.is_longer(second, first),
            _ => false,
        }
    }

    /// Which of two edges that share a vertex is longer; ties are broken by the coordinates, then the id, of
    /// the other end.
    fn is_longer(&self, one: EdgeId, other: EdgeId) -> bool {
        let [[a, b], [c, d]] = [one, other].map(|edge| self.edges[edge.index()].ends);
        let place = |v: ForestVertexId| self.reference[v.index()];
        let length = |u: ForestVertexId, v: ForestVertexId| {
            let along = sub(place(u), place(v));
            dot(along, along)
        };
        let p = if a == c || a == d { b } else { a };
        let q = if c == a || c == b { d } else { c };
        let (first, second) = (length(a, b), length(c, d));
        first > second || first == second && (place(p), p) > (place(q), q)
    }

    /// The size in bytes.
    pub(super) fn memory(&self) -> usize {
        // An entry of a hash map takes one byte more.
        let named = self.root_edges.capacity() * (size_of::<(u64, u32)>() + 1) + self.fills.memory();
        size_of_val(&self.reference[..])
            + size_of_val(&self.origin[..])
            + size_of_val(&self.first_half[..])
            + size_of_val(&self.parents[..])
            + size_of_val(&self.edges[..])
            + size_of_val(&self.is_split[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.states[..])
            + size_of_val(&self.edges_of[..])
            + size_of_val(&self.classes[..])
            + self.facet_edges.memory()
            + named
    }
}

/// The vertex of the forest that a vertex of the first mesh is.
pub(super) fn in_forest(v: VertexId) -> ForestVertexId {
    ForestVertexId(v.0)
}

/// The corners of a tet, then the middles of its edges.
pub(super) fn with_middles(corners: [Point; 4]) -> [Point; 10] {
    let mut places = [[0.0; 3]; 10];
    places[..4].copy_from_slice(&corners);
    for (e, [i, j]) in EDGES.into_iter().enumerate() {
        places[4 + e] = scale(add(corners[i], corners[j]), 0.5);
    }
    places
}

#[inline]
fn push_edge(edges: &mut Vec<Edge>, is_split: &mut Vec<bool>, ends: [ForestVertexId; 2]) -> EdgeId {
    edges.push(Edge { ends, middle: MaybeId::NONE });
    is_split.push(false);
    EdgeId::new(edges.len() - 1)
}
