//! Tets, the tets they are divided into, and the edges that these share; and how all of it is brought to fit.
//!
//! | step | file | how |
//! |---|---|---|
//! | know | this, `facets` | parents, children, edges and facets are remembered |
//! | divide | `divide`, `eight` | the eight, and which edges each of them has |
//! | shapes | `classes` | few tets have shapes of their own; what follows from the shape is found once |
//! | fit | `patterns` | what is left between divided and undivided tets is cut: all ways to do so, from a table |
//! | choose a way | `fills` | of these the one whose worst part is best; a tet is divided along its shortest diagonal, mostly |
//! | Bey's rule | `bey` | another diagonal, for no more than three shapes |
//! | close | `close` | cuts that would be badly shaped get more split edges, or the tet is divided, too: sweeps until nothing changes |
//! | give out | `extract` | the mesh, with the triangles of patches and where everything came from |
//!
//! Shapes are those of the *reference*: the mesh as it was when its tets became roots. All that is decided about a division is decided there, so
//! motion changes nothing of it, and the same division asked for again comes out the same.

mod bey;
mod classes;
mod close;
mod divide;
mod eight;
mod extract;
mod facets;
mod fills;
mod patterns;

pub(super) use close::{Closed, Need, close};
pub(super) use eight::{IMAGES, eight};
pub(super) use extract::{Extracted, extract};
pub(super) use patterns::{FACET_EDGES, patterns};

use classes::{Class, Shape};
use facets::{Facets, Middles};
use fills::Fills;
use hashbrown::HashMap;

use crate::base::Point;
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, dot, scale, sub};

/// As an id: none.
pub(super) const NONE: u32 = u32::MAX;

/// The most divisions one in another: what a way down of 64 bits can tell, and far beyond what coordinates can.
pub(super) const DEEPEST: u8 = 20;

/// No more tets than this, so that edges, which are a fifth more, have ids, and classes with a bit to spare.
pub(super) const MOST_NODES: usize = 2_000_000_000;

/// An edge of tets of some generation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    /// The vertex in its middle, where there ever was one.
    pub(super) middle: u32,
    /// The halves, each at its end, where there are any.
    pub(super) halves: [u32; 2],
}

/// A tet of the first mesh, or one of eight that a tet was divided into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) vertices: [u32; 4],
    pub(super) parent: u32,
    /// The first of the eight, which follow each other, where there ever were some.
    pub(super) first_child: u32,
    pub(super) shape: Shape,
}

/// What changes of a tet; apart from the rest, since all of it is looked at each time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    pub(super) generation: u8,
    /// Someone wants it divided.
    pub(super) is_asked: bool,
    /// It is divided into eight now.
    pub(super) is_divided: bool,
    /// It is cut to fit its neighbours now.
    pub(super) is_cut: bool,
}

/// The whole of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Forest {
    /// Of each vertex, where it is in the reference.
    pub(super) reference: Vec<Point>,
    /// The edge in whose middle a vertex is, for those after the first mesh's.
    pub(super) origin: Vec<u32>,
    pub(super) edges: Vec<Edge>,
    /// Of each edge, whether it is split now; apart from the edges, since it is read most.
    pub(super) is_split: Vec<bool>,
    pub(super) nodes: Vec<Node>,
    pub(super) states: Vec<State>,
    /// Of each tet, its edges.
    pub(super) edges_of: Vec<[u32; 6]>,
    pub(super) n_roots: usize,
    pub(super) n_first_vertices: usize,
    /// No more tets may be divided once there are so many.
    pub(super) most_nodes: usize,
    /// Edges that stay split, since a root has a vertex in their middle.
    pub(super) pinned: Vec<u32>,
    /// The edges of roots, by their ends.
    of_roots: HashMap<[u32; 2], u32>,
    /// The three edges between the middles of a facet's edges, see [`Self::inner_edges`].
    of_facets: Facets,
    /// What shapes there are: first those of the roots.
    pub(super) classes: Vec<Class>,
    fills: Fills,
}

impl Forest {
    /// Every tet is a root, numbered in either way; with each comes whether the mesh has it the other way round.
    pub(super) fn new(points: &[Point], tets: impl ExactSizeIterator<Item = ([u32; 4], bool)>) -> Self {
        let n_roots = tets.len();
        let mut forest = Self {
            reference: points.to_vec(),
            n_roots,
            n_first_vertices: points.len(),
            most_nodes: MOST_NODES,
            nodes: Vec::with_capacity(n_roots),
            states: Vec::with_capacity(n_roots),
            edges_of: Vec::with_capacity(n_roots),
            classes: Vec::with_capacity(n_roots),
            ..Self::default()
        };
        for ((vertices, is_turned), root) in tets.zip(0..) {
            let edges = EDGES.map(|[i, j]| forest.make_root_edge([vertices[i], vertices[j]]));
            let shape = Shape::new(root, is_turned);
            forest.nodes.push(Node { vertices, parent: NONE, first_child: NONE, shape });
            forest.classes.push(Class::of_root(vertices.map(|v| points[v as usize])));
            forest.states.push(State::default());
            forest.edges_of.push(edges);
        }
        forest
    }

    /// The edge between two vertices of the first mesh.
    pub(super) fn root_edge(&self, [u, v]: [u32; 2]) -> Option<u32> {
        self.of_roots.get(&[u.min(v), u.max(v)]).copied()
    }

    /// The same, a new one if there is none.
    fn make_root_edge(&mut self, [u, v]: [u32; 2]) -> u32 {
        let ends = [u.min(v), u.max(v)];
        *self.of_roots.entry(ends).or_insert_with(|| push_edge(&mut self.edges, &mut self.is_split, ends))
    }

    /// The edges within a facet between the middles of its edges, if it was ever divided, by tets here or by roots: edge `k` is that
    /// opposite middle `k`, or [`NONE`].
    pub(super) fn inner_edges(&self, middles: [u32; 3]) -> Option<[u32; 3]> {
        let middles = Middles::new(middles);
        let first = self.of_facets.get(&middles);
        if first.is_none() && middles.rising.iter().any(|v| (*v as usize) >= self.n_first_vertices) {
            return None;
        }
        Some(self.or_root_edges(&middles, first.map_or([NONE; 3], |first| middles.named(first))))
    }

    /// The same, new ones if there are none.
    #[inline]
    pub(super) fn make_inner_edges(&mut self, middles: [u32; 3]) -> [u32; 3] {
        let middles = Middles::new(middles);
        let first = self.of_facets.get(&middles).unwrap_or_else(|| {
            let [x, y, z] = middles.rising;
            let first = push_edge(&mut self.edges, &mut self.is_split, [y, z]);
            push_edge(&mut self.edges, &mut self.is_split, [x, z]);
            push_edge(&mut self.edges, &mut self.is_split, [x, y]);
            self.of_facets.add(&middles, first);
            first
        });
        self.or_root_edges(&middles, middles.named(first))
    }

    /// Puts edges of roots in place of those between the same two of three middles.
    #[inline]
    fn or_root_edges(&self, middles: &Middles, edges: [u32; 3]) -> [u32; 3] {
        let are_of_roots = (middles.rising[1] as usize) < self.n_first_vertices;
        if are_of_roots { self.root_edges_or(middles, edges) } else { edges }
    }

    #[cold]
    fn root_edges_or(&self, middles: &Middles, mut edges: [u32; 3]) -> [u32; 3] {
        let [x, y, z] = middles.rising;
        let places = middles.named(0);
        for (edge, place) in edges.iter_mut().zip(places) {
            let opposite = [[y, z], [x, z], [x, y]][place as usize];
            *edge = self.known_edge(opposite).unwrap_or(*edge);
        }
        edges
    }

    /// The edge of a root between two vertices; without looking where one of them is of no root, as all are that divisions made, mostly.
    #[inline]
    fn known_edge(&self, ends: [u32; 2]) -> Option<u32> {
        let are_of_roots = ends.iter().all(|v| (*v as usize) < self.n_first_vertices);
        if are_of_roots { self.root_edge(ends) } else { None }
    }

    /// That one, or a new one.
    #[inline]
    pub(super) fn make_edge(&mut self, ends: [u32; 2]) -> u32 {
        match self.known_edge(ends) {
            Some(edge) => edge,
            None => push_edge(&mut self.edges, &mut self.is_split, ends),
        }
    }

    /// Finds the edges that stay split.
    pub(super) fn pin(&mut self) {
        let is_pinned = |edge: &u32| (self.edges[*edge as usize].middle as usize) < self.n_first_vertices;
        self.pinned = (0..self.edges.len() as u32).filter(is_pinned).collect();
        // Their halves may be edges of roots, whether a tet here was divided or not.
        for i in 0..self.pinned.len() {
            self.halves(self.pinned[i]);
        }
    }

    /// The vertex in the middle of an edge.
    #[inline]
    pub(super) fn middle(&mut self, edge: u32) -> u32 {
        let Edge { ends: [u, v], middle, .. } = self.edges[edge as usize];
        if middle != NONE {
            return middle;
        }
        let new = self.reference.len() as u32;
        let sum = add(self.reference[u as usize], self.reference[v as usize]);
        self.reference.push(scale(sum, 0.5));
        self.origin.push(edge);
        self.edges[edge as usize].middle = new;
        new
    }

    #[inline]
    pub(super) fn halves(&mut self, edge: u32) -> [u32; 2] {
        let Edge { ends: [u, v], middle, halves, .. } = self.edges[edge as usize];
        if halves[0] != NONE {
            return halves;
        }
        let halves = [self.make_edge([u, middle]), self.make_edge([v, middle])];
        self.edges[edge as usize].halves = halves;
        halves
    }

    /// The places of a tet's corners.
    pub(super) fn corners(&self, node: u32) -> [Point; 4] {
        let [a, b, c, d] = self.nodes[node as usize].vertices;
        let place = |v: u32| self.reference[v as usize];
        [place(a), place(b), place(c), place(d)]
    }

    /// Which edges of a tet are split.
    #[inline]
    pub(super) fn mask(&self, node: u32) -> u8 {
        let mut mask = 0;
        for (e, edge) in self.edges_of[node as usize].iter().enumerate() {
            mask |= u8::from(self.is_split[*edge as usize]) << e;
        }
        mask
    }

    /// Whether the facets that have two split edges are cut from the middle of the second, by bits: from that of the longer one, as both tets at a
    /// facet see it.
    pub(super) fn cuts(&self, node: u32, mask: u8) -> u8 {
        (0..4).fold(0, |cuts, facet| {
            let (split, n) = patterns::split_edges(facet, mask);
            let [first, second, _] = split.map(|e| self.edges_of[node as usize][e]);
            cuts | u8::from(n == 2 && self.is_longer(second, first)) << facet
        })
    }

    /// Whether a triangle with two split edges is cut from the middle of the second of them.
    pub(super) fn is_cut_from_second(&self, edges: [u32; 3], middles: [Option<u32>; 3]) -> bool {
        let mut split = (0..3).filter(|&k| middles[k].is_some()).map(|k| edges[k]);
        match (split.next(), split.next(), split.next()) {
            (Some(first), Some(second), None) => self.is_longer(second, first),
            _ => false,
        }
    }

    /// Which of two edges that share a vertex is the longer one; if they are alike, the one whose other end comes later.
    fn is_longer(&self, one: u32, other: u32) -> bool {
        let [[a, b], [c, d]] = [one, other].map(|edge| self.edges[edge as usize].ends);
        let place = |v: u32| self.reference[v as usize];
        let length = |u: u32, v: u32| {
            let along = sub(place(u), place(v));
            dot(along, along)
        };
        let p = if a == c || a == d { b } else { a };
        let q = if c == a || c == b { d } else { c };
        let (first, second) = (length(a, b), length(c, d));
        first > second || first == second && (place(p), p) > (place(q), q)
    }

    /// Bytes.
    pub(super) fn memory(&self) -> usize {
        // An entry and a byte beside it.
        let named = self.of_roots.capacity() * (size_of::<(u64, u32)>() + 1) + self.fills.memory();
        size_of_val(&self.reference[..])
            + size_of_val(&self.origin[..])
            + size_of_val(&self.edges[..])
            + size_of_val(&self.is_split[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.states[..])
            + size_of_val(&self.edges_of[..])
            + size_of_val(&self.classes[..])
            + self.of_facets.memory()
            + named
    }
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
fn push_edge(edges: &mut Vec<Edge>, is_split: &mut Vec<bool>, ends: [u32; 2]) -> u32 {
    edges.push(Edge { ends, middle: NONE, halves: [NONE; 2] });
    is_split.push(false);
    (edges.len() - 1) as u32
}
