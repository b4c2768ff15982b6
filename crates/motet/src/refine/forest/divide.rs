//! Divides tets into eight, and finds the edges of each part.
//!
//! The edges of the parts are numbered, and a table gives for each of the three ways which edges belong to
//! which part: the halves of edge `e` at its first and second end are `2e` and `2e + 1`; the edge within
//! facet `f` opposite its middle `k` is `12 + 3f + k`; the diagonal comes last.

use std::sync::OnceLock;

use super::classes::{ClassId, Shape};
use super::eight::{IMAGES, INNER, eight, ends};
use super::facets::Middles;
use super::patterns::FACET_EDGES;
use super::{Edge, Forest, Node, State};
use crate::base::{EdgeId, ForestVertexId, MaybeId, NodeId, Threads};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};

const DIAGONAL: usize = 24;

/// One of the eight parts.
#[derive(Clone, Copy, Debug, Default)]
struct Eighth {
    /// Local vertices: corners, then middles.
    vertices: [u8; 4],
    /// Numbers of the edges, as above.
    edges: [u8; 6],
}

/// The eight parts of each way.
fn eighths(way: usize) -> &'static [Eighth; 8] {
    static TABLE: OnceLock<[[Eighth; 8]; 3]> = OnceLock::new();
    &TABLE.get_or_init(|| {
        let part_of = parts_between();
        [0, 1, 2].map(|way| {
            let mut eighths = [Eighth::default(); 8];
            for (eighth, tet) in eighths.iter_mut().zip(eight(way)) {
                let edge = |[i, j]: [usize; 2]| part_of[usize::from(tet[i])][usize::from(tet[j])];
                *eighth = Eighth { vertices: *tet, edges: EDGES.map(edge) };
            }
            eighths
        })
    })[way]
}

/// The number of the edge between any two local vertices.
fn parts_between() -> [[u8; 10]; 10] {
    let mut part_of = [[DIAGONAL as u8; 10]; 10];
    let mut put = |i: usize, j: usize, part: usize| {
        (part_of[i][j], part_of[j][i]) = (part as u8, part as u8);
    };
    for (e, [i, j]) in EDGES.into_iter().enumerate() {
        put(i, 4 + e, 2 * e);
        put(j, 4 + e, 2 * e + 1);
    }
    for (f, facet) in FACET_EDGES.into_iter().enumerate() {
        for k in 0..3 {
            put(4 + facet[(k + 1) % 3], 4 + facet[(k + 2) % 3], 12 + 3 * f + k);
        }
    }
    part_of
}

/// How many tets are divided at a time: what is noted of them stays in the cache.
const BLOCK: usize = 1 << 14;

/// The least number of edges that a thread makes at a time.
const MIN_EDGES: usize = 4096;

/// A tet that is being divided.
#[derive(Clone, Copy, Debug)]
struct Division {
    node: NodeId,
    way: u8,
    /// The generation of the parts.
    generation: u8,
    shape: Shape,
    /// The first of the two classes of inner parts.
    inner: ClassId,
    /// Corners, then middles.
    local: [ForestVertexId; 10],
    edges: [EdgeId; 6],
    /// For each facet, the first of the three consecutive edges within it.
    within: [EdgeId; 4],
}

impl Division {
    /// The middles of the edges of each facet.
    fn facets(&self) -> [Middles; 4] {
        FACET_EDGES.map(|facet| Middles::new(facet.map(|e| self.local[4 + e])))
    }
}

impl Forest {
    /// Divides tets that were never divided into eight, each in one of the three ways.
    pub(in crate::refine) fn divide(&mut self, tets: &[(NodeId, u8)], threads: &Threads) {
        for block in tets.chunks(BLOCK) {
            self.divide_block(block, threads);
        }
    }

    /// First everything new gets its number, tet by tet; what these numbers stand for is then computed on all
    /// threads.
    fn divide_block(&mut self, block: &[(NodeId, u8)], threads: &Threads) {
        let n = block.len();
        let mut divisions: Vec<Division> = Vec::with_capacity(n);
        divisions.extend(block.iter().zip(0..).map(|(&(node, way), k)| self.begin(node, way, k)));
        self.finish_middles(threads);
        self.make_edges_within(&mut divisions, threads);
        let first_diagonal = self.edges.len();
        let diagonal = |division: &Division| ends(usize::from(division.way)).map(|v| division.local[v]);
        threads.append(&mut self.edges, n, MIN_EDGES, |k| Edge {
            ends: diagonal(&divisions[k]),
            middle: MaybeId::NONE,
        });
        self.is_split.resize(self.edges.len(), false);

        let mut edges_of = std::mem::take(&mut self.edges_of);
        edges_of.append(n, threads, |k| {
            let division = &divisions[k];
            let known = self.known_edge(diagonal(division));
            self.edges_of_parts(division, known.unwrap_or(EdgeId::new(first_diagonal + k)))
        });
        self.edges_of = edges_of;
        self.nodes.append(n, threads, |k| parts(&divisions[k]));
        self.states
            .append(n, threads, |k| [State { generation: divisions[k].generation, ..State::default() }; 8]);
        self.parents.extend(divisions.iter().map(|division| division.node));
    }

    /// Notes the `k`-th tet of a block that is being divided, and numbers its middles.
    fn begin(&mut self, node: NodeId, way: u8, k: usize) -> Division {
        let first_child = NodeId::new(self.nodes.len() + 8 * k);
        let tet = &mut self.nodes[node.index()];
        tet.first_child = first_child.into();
        let Node { vertices, shape, .. } = *tet;
        let edges = self.edges_of[node.index()];
        let mut local = [vertices[0]; 10];
        local[..4].copy_from_slice(&vertices);
        for e in 0..6 {
            local[4 + e] = self.middle(edges[e]);
        }
        let inner = self.make_classes(shape.class(), usize::from(way));
        let generation = self.states[node.index()].generation + 1;
        Division { node, way, generation, shape, inner, local, edges, within: [edges[0]; 4] }
    }

    /// The vertex in the middle of an edge. A new one gets a number, all else by
    /// [`finish_middles`](Self::finish_middles).
    #[inline]
    pub(in crate::refine) fn middle(&mut self, edge: EdgeId) -> ForestVertexId {
        let Some(middle) = self.edges[edge.index()].middle.get() else {
            let new = ForestVertexId::new(self.n_first_vertices + self.origin.len());
            self.origin.push(edge);
            self.edges[edge.index()].middle = new.into();
            return new;
        };
        if middle.index() < self.n_first_vertices {
            self.pin_halves(edge);
        }
        middle
    }

    /// Places the new middles, and makes the halves of their edges.
    pub(in crate::refine) fn finish_middles(&mut self, threads: &Threads) {
        let n_before = self.first_half.len();
        let (n, first_edge) = (self.origin.len() - n_before, self.edges.len());
        let ends = threads.map(n, |k| self.edges[self.origin[n_before + k].index()].ends);
        let places = threads.map(n, |k| {
            let [p, q] = ends[k].map(|v| self.reference[v.index()]);
            scale(add(p, q), 0.5)
        });
        self.reference.extend_from_slice(&places);
        self.first_half.extend((0..n).map(|k| EdgeId::new(first_edge + 2 * k)));
        let first_vertex = self.n_first_vertices + n_before;
        threads.append(&mut self.edges, 2 * n, MIN_EDGES, |i| Edge {
            ends: [ends[i / 2][i % 2], ForestVertexId::new(first_vertex + i / 2)],
            middle: MaybeId::NONE,
        });
        self.is_split.resize(self.edges.len(), false);
    }

    /// Finds the edges within the facets, and makes those that are not there.
    fn make_edges_within(&mut self, divisions: &mut [Division], threads: &Threads) {
        let first = self.edges.len();
        let mut new: Vec<[ForestVertexId; 3]> = Vec::with_capacity(3 * divisions.len());
        for division in divisions {
            for (facet, middles) in division.facets().iter().enumerate() {
                division.within[facet] = self.facet_edges.get(middles).unwrap_or_else(|| {
                    let edges = EdgeId::new(first + 3 * new.len());
                    new.push(middles.rising);
                    self.facet_edges.add(middles, edges);
                    edges
                });
            }
        }
        threads.append(&mut self.edges, 3 * new.len(), MIN_EDGES, |i| {
            let [x, y, z] = new[i / 3];
            Edge { ends: [[y, z], [x, z], [x, y]][i % 3], middle: MaybeId::NONE }
        });
    }

    /// The edges of each of the eight parts.
    fn edges_of_parts(&self, division: &Division, diagonal: EdgeId) -> [[EdgeId; 6]; 8] {
        let Division { edges, local, .. } = division;
        let mut parts = [diagonal; DIAGONAL + 1];
        for (e, [i, _]) in EDGES.into_iter().enumerate() {
            let [at_first, at_second] = self.halves(edges[e]).expect("a divided tet has split edges");
            let is_turned = self.edges[edges[e].index()].ends[0] != local[i];
            parts[2 * e] = if is_turned { at_second } else { at_first };
            parts[2 * e + 1] = if is_turned { at_first } else { at_second };
        }
        for (f, middles) in division.facets().iter().enumerate() {
            let within = self.or_root_edges(middles, middles.named(division.within[f]));
            parts[12 + 3 * f..15 + 3 * f].copy_from_slice(&within);
        }
        let mut edges_of = [*edges; 8];
        for (edges, eighth) in edges_of.iter_mut().zip(eighths(usize::from(division.way))) {
            for e in 0..6 {
                edges[e] = parts[usize::from(eighth.edges[e])];
            }
        }
        edges_of
    }
}

/// The eight parts.
fn parts(division: &Division) -> [Node; 8] {
    let &Division { way, shape, inner, local, .. } = division;
    let mut parts = [Node { vertices: [local[0]; 4], first_child: MaybeId::NONE, shape }; 8];
    for (part, eighth) in parts.iter_mut().zip(eighths(usize::from(way))) {
        for i in 0..4 {
            part.vertices[i] = local[usize::from(eighth.vertices[i])];
        }
    }
    for ((class, inner), image) in (inner.0..).zip(INNER).zip(IMAGES) {
        parts[inner].shape = shape.of_class(ClassId(class));
        parts[image].shape = parts[inner].shape.mirrored();
    }
    parts
}
