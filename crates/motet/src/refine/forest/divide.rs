//! Divides a tet into eight, and finds the edges of each part.
//!
//! The edges of the parts are numbered, and a table gives for each of the three ways which edges belong to
//! which part: the halves of edge `e` at its first and second end are `2e` and `2e + 1`; the edge within
//! facet `f` opposite its middle `k` is `12 + 3f + k`; the diagonal comes last.

use std::sync::OnceLock;

use super::classes::ClassId;
use super::eight::{IMAGES, INNER, eight, ends};
use super::patterns::FACET_EDGES;
use super::{Forest, Node, State};
use crate::base::{EdgeId, ForestVertexId, MaybeId, NodeId};
use crate::geometry::tet::EDGES;

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

impl Forest {
    /// Divides a tet into eight in one of the three ways, unless it was divided before; returns the first
    /// part.
    pub(in crate::refine) fn divide(&mut self, node: NodeId, way: usize) -> NodeId {
        self.states[node.index()].is_divided = true;
        let Node { vertices, first_child, shape, .. } = self.nodes[node.index()];
        if let Some(first_child) = first_child.get() {
            return first_child;
        }
        let edges = self.edges_of[node.index()];
        let mut local = [vertices[0]; 10];
        local[..4].copy_from_slice(&vertices);
        for e in 0..6 {
            local[4 + e] = self.middle(edges[e]);
        }
        let parts = self.parts(&edges, &local, way);
        let first = NodeId::new(self.nodes.len());
        self.nodes[node.index()].first_child = first.into();
        let mut tets = [Node { vertices, parent: node.into(), first_child: MaybeId::NONE, shape }; 8];
        let mut edges_of = [edges; 8];
        for (k, eighth) in eighths(way).iter().enumerate() {
            for i in 0..4 {
                tets[k].vertices[i] = local[usize::from(eighth.vertices[i])];
            }
            for e in 0..6 {
                edges_of[k][e] = parts[usize::from(eighth.edges[e])];
            }
        }
        let classes = self.make_classes(shape.class(), way);
        for ((class, inner), image) in (classes.0..).zip(INNER).zip(IMAGES) {
            tets[inner].shape = shape.of_class(ClassId(class));
            tets[image].shape = tets[inner].shape.mirrored();
        }
        let generation = self.states[node.index()].generation + 1;
        self.nodes.extend_from_slice(&tets);
        self.edges_of.extend_from_slice(&edges_of);
        self.states.extend_from_slice(&[State { generation, ..State::default() }; 8]);
        first
    }

    /// The edges of the parts, with the diagonal of a way.
    fn parts(
        &mut self,
        edges: &[EdgeId; 6],
        local: &[ForestVertexId; 10],
        way: usize,
    ) -> [EdgeId; DIAGONAL + 1] {
        let mut parts = [edges[0]; DIAGONAL + 1];
        for (e, [i, _]) in EDGES.into_iter().enumerate() {
            let [at_first, at_second] = self.halves(edges[e]);
            let is_turned = self.edges[edges[e].index()].ends[0] != local[i];
            parts[2 * e] = if is_turned { at_second } else { at_first };
            parts[2 * e + 1] = if is_turned { at_first } else { at_second };
        }
        for (f, [a, b, c]) in FACET_EDGES.into_iter().enumerate() {
            let within = self.make_inner_edges([local[4 + a], local[4 + b], local[4 + c]]);
            parts[12 + 3 * f..15 + 3 * f].copy_from_slice(&within);
        }
        parts[DIAGONAL] = self.make_edge(ends(way).map(|v| local[v]));
        parts
    }
}
