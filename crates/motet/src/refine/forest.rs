//! Tets, the tets they are divided into, and the edges that these share.
//!
//! Shapes are those of the *reference*: the mesh as it was when its tets became roots. All that is decided about a division is decided there, so
//! motion changes nothing of it, and the same division asked for again comes out the same.

use hashbrown::HashMap;

use super::patterns::{FACET_EDGES, FULL, patterns};
use crate::base::Point;
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, dot, scale, sub};

/// As an id: none.
pub(super) const NONE: u32 = u32::MAX;

/// An edge of tets of some generation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    /// The vertex in its middle, where there ever was one.
    pub(super) middle: u32,
    /// The halves, each at its end, where there are any.
    pub(super) halves: [u32; 2],
    /// Whether it is split now.
    pub(super) is_split: bool,
}

/// A tet of the first mesh, or one of eight that a tet was divided into.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) vertices: [u32; 4],
    pub(super) edges: [u32; 6],
    pub(super) parent: u32,
    /// The first of the eight, which follow each other, where there ever were some.
    pub(super) first_child: u32,
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
    pub(super) nodes: Vec<Node>,
    pub(super) n_roots: usize,
    pub(super) n_first_vertices: usize,
    /// Edges by their ends, those alone that more than one tree may have: of roots, and between middles of one facet.
    by_ends: HashMap<[u32; 2], u32>,
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
            ..Self::default()
        };
        for vertices in tets {
            let edges = EDGES.map(|[i, j]| forest.edge([vertices[i], vertices[j]]));
            forest.nodes.push(Node {
                vertices,
                edges,
                parent: NONE,
                first_child: NONE,
                generation: 0,
                is_asked: false,
                is_divided: false,
            });
        }
        forest
    }

    /// The edge between two vertices, of those that are known by their ends.
    pub(super) fn known_edge(&self, [u, v]: [u32; 2]) -> Option<u32> {
        self.by_ends.get(&[u.min(v), u.max(v)]).copied()
    }

    /// The same, a new one if there is none.
    fn edge(&mut self, [u, v]: [u32; 2]) -> u32 {
        let ends = [u.min(v), u.max(v)];
        *self.by_ends.entry(ends).or_insert_with(|| push_edge(&mut self.edges, ends))
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
        let halves = ends.map(|end| push_edge(&mut self.edges, [end, middle]));
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
        let split = self.nodes[node as usize].edges.map(|edge| self.edges[edge as usize].is_split);
        (0..6).fold(0, |mask, e| mask | u8::from(split[e]) << e)
    }

    /// Divides a tet into eight, along a diagonal of its octahedron, and gives the first; which it may have been before.
    pub(super) fn divide(&mut self, node: u32, diagonal: impl FnOnce(&Self) -> usize) -> u32 {
        let Node { vertices, edges, first_child, generation, .. } = self.nodes[node as usize];
        self.nodes[node as usize].is_divided = true;
        if first_child != NONE {
            return first_child;
        }
        let mut local = [NONE; 10];
        local[..4].copy_from_slice(&vertices);
        for (e, &edge) in edges.iter().enumerate() {
            local[4 + e] = self.middle(edge);
        }
        // The edges of the eight, by two local vertices.
        let mut between = [[NONE; 10]; 10];
        for (e, [i, j]) in EDGES.into_iter().enumerate() {
            let halves = self.halves(edges[e]);
            let is_turned = self.edges[edges[e] as usize].ends[0] != vertices[i];
            let [at_i, at_j] = if is_turned { [halves[1], halves[0]] } else { halves };
            (between[i][4 + e], between[j][4 + e]) = (at_i, at_j);
        }
        for facet in FACET_EDGES {
            for [a, b] in [[0, 1], [0, 2], [1, 2]].map(|[i, j]| [4 + facet[i], 4 + facet[j]]) {
                between[a.min(b)][a.max(b)] = self.edge([local[a], local[b]]);
            }
        }
        let way = &patterns(FULL, 0)[diagonal(self)];
        let first = self.nodes.len() as u32;
        self.nodes[node as usize].first_child = first;
        for tet in way {
            let tet = tet.map(usize::from);
            let edges = EDGES.map(|[i, j]| {
                let (a, b) = (tet[i].min(tet[j]), tet[i].max(tet[j]));
                if between[a][b] == NONE {
                    between[a][b] = push_edge(&mut self.edges, [local[a], local[b]]);
                }
                between[a][b]
            });
            self.nodes.push(Node {
                vertices: tet.map(|i| local[i]),
                edges,
                parent: node,
                first_child: NONE,
                generation: generation + 1,
                is_asked: false,
                is_divided: false,
            });
        }
        first
    }

    /// Whether the facets that have two split edges are cut from the middle of the second, by bits: from that of the longer one, as both tets at a
    /// facet see it.
    pub(super) fn cuts(&self, node: u32, mask: u8) -> u8 {
        (0..4).fold(0, |cuts, facet| {
            let (split, n) = super::patterns::split_edges(facet, mask);
            let [first, second, _] = split.map(|e| self.nodes[node as usize].edges[e]);
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

    /// Bytes of the list of edges by their ends.
    pub(super) fn memory_of_names(&self) -> usize {
        self.by_ends.capacity() * size_of::<([u32; 2], u32)>() + self.by_ends.capacity()
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

fn push_edge(edges: &mut Vec<Edge>, ends: [u32; 2]) -> u32 {
    edges.push(Edge { ends, middle: NONE, halves: [NONE; 2], is_split: false });
    (edges.len() - 1) as u32
}
