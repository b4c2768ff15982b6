//! Tets, the tets they are divided into, and the edges that these share.
//!
//! Shapes are those of the *reference*: the mesh as it was when its tets became roots. All that is decided about a division is decided there, so
//! motion changes nothing of it, and the same division asked for again comes out the same.

use std::hash::{BuildHasherDefault, Hasher};

use hashbrown::HashMap;

use super::close::{Goal, Way};
use super::patterns::{FACET_EDGES, FULL, inner_tets, patterns};
use crate::base::Point;
use crate::geometry::quality::eas;
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, dot, scale, sub};

/// As an id: none.
pub(super) const NONE: u32 = u32::MAX;

/// The most divisions one in another: what a way down of 64 bits can tell, and far beyond what coordinates can.
pub(super) const DEEPEST: u8 = 20;

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
    /// The EAS in the reference.
    pub(super) eas: f64,
    pub(super) generation: u8,
    /// Someone wants it divided.
    pub(super) is_asked: bool,
    /// It is divided into eight now.
    pub(super) is_divided: bool,
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
    /// Of each tet, its edges.
    pub(super) edges_of: Vec<[u32; 6]>,
    pub(super) n_roots: usize,
    pub(super) n_first_vertices: usize,
    /// Edges that stay split, since a root has a vertex in their middle.
    pub(super) pinned: Vec<u32>,
    /// The edges of roots, by their ends.
    of_roots: HashMap<[u32; 2], u32>,
    /// The three edges between the middles of a facet's edges, by the first two of these: the first of them, see [`Self::inner_edges`].
    of_facets: HashMap<u64, u32, BuildHasherDefault<Near>>,
    /// Of tets with some edges split, what they need: what was found once holds for good.
    pub(super) goals: HashMap<(u32, u8), Goal>,
}

impl Forest {
    /// Every tet is a root; all are positive.
    pub(super) fn new(points: &[Point], tets: impl ExactSizeIterator<Item = [u32; 4]>) -> Self {
        let n_roots = tets.len();
        let mut forest = Self {
            reference: points.to_vec(),
            n_roots,
            n_first_vertices: points.len(),
            nodes: Vec::with_capacity(n_roots),
            edges_of: Vec::with_capacity(n_roots),
            ..Self::default()
        };
        for vertices in tets {
            let edges = EDGES.map(|[i, j]| forest.make_root_edge([vertices[i], vertices[j]]));
            let eas = eas(vertices.map(|v| points[v as usize]));
            forest.push(vertices, edges, NONE, 0, eas);
        }
        forest
    }

    fn push(&mut self, vertices: [u32; 4], edges: [u32; 6], parent: u32, generation: u8, eas: f64) {
        let (is_asked, is_divided) = (false, false);
        self.nodes.push(Node { vertices, parent, first_child: NONE, eas, generation, is_asked, is_divided });
        self.edges_of.push(edges);
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
        let (order, key) = ordered(middles);
        let first = self.of_facets.get(&key);
        if first.is_none() && middles.iter().any(|v| (*v as usize) >= self.n_first_vertices) {
            return None;
        }
        Some(self.or_root_edges(middles, first.map_or([NONE; 3], |&first| named(order, first))))
    }

    /// The same, new ones if there are none.
    fn make_inner_edges(&mut self, middles: [u32; 3]) -> [u32; 3] {
        let (order, key) = ordered(middles);
        let first = *self.of_facets.entry(key).or_insert_with(|| {
            let [x, y, z] = order.map(|k| middles[k]);
            let first = push_edge(&mut self.edges, &mut self.is_split, [y, z]);
            push_edge(&mut self.edges, &mut self.is_split, [x, z]);
            push_edge(&mut self.edges, &mut self.is_split, [x, y]);
            first
        });
        self.or_root_edges(middles, named(order, first))
    }

    /// Puts edges of roots in place of those between the same two of three middles.
    fn or_root_edges(&self, middles: [u32; 3], mut edges: [u32; 3]) -> [u32; 3] {
        for (k, edge) in edges.iter_mut().enumerate() {
            *edge = self.known_edge([middles[(k + 1) % 3], middles[(k + 2) % 3]]).unwrap_or(*edge);
        }
        edges
    }

    /// The edge of a root between two vertices; without looking where one of them is of no root, as all are that divisions made, mostly.
    #[inline]
    fn known_edge(&self, ends: [u32; 2]) -> Option<u32> {
        let are_of_roots = ends.iter().all(|v| (*v as usize) < self.n_first_vertices);
        if are_of_roots { self.root_edge(ends) } else { None }
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

    fn halves(&mut self, edge: u32) -> [u32; 2] {
        let Edge { ends, middle, halves, .. } = self.edges[edge as usize];
        if halves[0] != NONE {
            return halves;
        }
        let halves = ends.map(|end| match self.known_edge([end, middle]) {
            Some(edge) => edge,
            None => push_edge(&mut self.edges, &mut self.is_split, [end, middle]),
        });
        self.edges[edge as usize].halves = halves;
        halves
    }

    /// The places of a tet's corners.
    pub(super) fn corners(&self, node: u32) -> [Point; 4] {
        self.nodes[node as usize].vertices.map(|v| self.reference[v as usize])
    }

    /// The corners of a tet, then the middles of its edges, there or not.
    pub(super) fn places(&self, node: u32) -> [Point; 10] {
        with_middles(self.corners(node))
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

    /// Divides a tet into eight, along a diagonal of its octahedron, and gives the first; which it may have been before.
    pub(super) fn divide(&mut self, node: u32, way: impl FnOnce(&Self) -> Way) -> u32 {
        let Node { vertices, first_child, generation, eas, .. } = self.nodes[node as usize];
        let edges = self.edges_of[node as usize];
        self.nodes[node as usize].is_divided = true;
        if first_child != NONE {
            return first_child;
        }
        for edge in edges {
            self.middle(edge);
        }
        let local = self.local(node);
        // The edges of the eight, by two local vertices.
        let mut between = [[NONE; 10]; 10];
        for (e, [i, j]) in EDGES.into_iter().enumerate() {
            let halves = self.halves(edges[e]);
            let is_turned = self.edges[edges[e] as usize].ends[0] != vertices[i];
            let [at_i, at_j] = if is_turned { [halves[1], halves[0]] } else { halves };
            (between[i][4 + e], between[j][4 + e]) = (at_i, at_j);
        }
        for facet in FACET_EDGES {
            let [a, b, c] = [4 + facet[0], 4 + facet[1], 4 + facet[2]];
            let [bc, ca, ab] = self.make_inner_edges([local[a], local[b], local[c]]);
            between[b.min(c)][b.max(c)] = bc;
            between[c.min(a)][c.max(a)] = ca;
            between[a.min(b)][a.max(b)] = ab;
        }
        let way = way(self);
        let first = self.nodes.len() as u32;
        self.nodes[node as usize].first_child = first;
        let inner = inner_tets(way.place);
        for tet in &patterns(FULL, 0)[way.place] {
            let shape = (0..2).find(|&k| inner[k].contains(tet)).map_or(eas, |k| way.inner[k]);
            let mut edges = [NONE; 6];
            for (edge, [i, j]) in edges.iter_mut().zip(EDGES) {
                let (i, j) = (usize::from(tet[i]), usize::from(tet[j]));
                let known = &mut between[i.min(j)][i.max(j)];
                if *known == NONE {
                    let ends = [local[i], local[j]];
                    *known = match self.known_edge(ends) {
                        Some(edge) => edge,
                        None => push_edge(&mut self.edges, &mut self.is_split, ends),
                    };
                }
                *edge = *known;
            }
            let mut vertices = [NONE; 4];
            for (vertex, v) in vertices.iter_mut().zip(tet) {
                *vertex = local[usize::from(*v)];
            }
            self.push(vertices, edges, node, generation + 1, shape);
        }
        first
    }

    /// Whether the facets that have two split edges are cut from the middle of the second, by bits: from that of the longer one, as both tets at a
    /// facet see it.
    pub(super) fn cuts(&self, node: u32, mask: u8) -> u8 {
        (0..4).fold(0, |cuts, facet| {
            let (split, n) = super::patterns::split_edges(facet, mask);
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
        let named = (self.of_roots.capacity() + self.of_facets.capacity()) * (size_of::<(u64, u32)>() + 1)
            + self.goals.capacity() * (size_of::<((u32, u8), Goal)>() + 1);
        size_of_val(&self.reference[..])
            + size_of_val(&self.origin[..])
            + size_of_val(&self.edges[..])
            + size_of_val(&self.is_split[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.edges_of[..])
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

/// The places of three middles in rising order, and the first two of them as one number.
fn ordered(middles: [u32; 3]) -> ([usize; 3], u64) {
    let mut order = [0, 1, 2];
    order.sort_unstable_by_key(|&k| middles[k]);
    (order, u64::from(middles[order[0]]) << 32 | u64::from(middles[order[1]]))
}

/// Puts facets whose first middles follow each other next to each other, as they are asked for: the lower bits of a hash say where it begins to look,
/// the upper seven are compared first.
#[derive(Clone, Copy, Debug, Default)]
struct Near(u64);

impl Hasher for Near {
    fn write_u64(&mut self, key: u64) {
        let (first, second) = (key >> 32, key & 0xffff_ffff);
        let upper_seven = second.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 57;
        self.0 = (2 * first) | (upper_seven << 57);
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(self.0 << 8 | u64::from(*byte)));
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Three edges that follow each other, each opposite a middle.
fn named(order: [usize; 3], first: u32) -> [u32; 3] {
    let mut edges = [NONE; 3];
    for (k, edge) in order.into_iter().zip(first..) {
        edges[k] = edge;
    }
    edges
}

fn push_edge(edges: &mut Vec<Edge>, is_split: &mut Vec<bool>, ends: [u32; 2]) -> u32 {
    edges.push(Edge { ends, middle: NONE, halves: [NONE; 2] });
    is_split.push(false);
    (edges.len() - 1) as u32
}
