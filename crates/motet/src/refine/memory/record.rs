//! Records what must be remembered of a refined mesh.

use super::super::forest::{Extracted, Forest, in_forest};
use super::super::refinement::Refinement;
use super::Memory;
use crate::base::{TetId, Threads, TriangleId};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;

impl Refinement {
    /// Returns what must be kept with the mesh so that [`recall`](Self::recall) can continue from there.
    pub fn memory_to_keep(&self, threads: &Threads) -> Memory {
        let (forest, now) = (&self.forest, &self.now);
        let of_tets = threads.map(now.nodes.len(), |t| entry(forest, now, t));
        Memory {
            roots: of_tets.iter().map(|entry| entry.root.into()).collect(),
            paths: of_tets.iter().map(|entry| entry.path).collect(),
            pieces: of_tets.iter().map(|entry| entry.piece).collect(),
            n_requested: of_tets.iter().map(|entry| entry.n_requested).collect(),
            corners: corners(forest, &self.first_mesh, &now.triangles),
            reference: now.vertices.iter().map(|v| forest.reference[v.index()]).collect(),
        }
    }
}

struct Entry {
    root: TetId,
    path: u64,
    piece: u16,
    n_requested: u8,
}

fn entry(forest: &Forest, now: &Extracted, t: usize) -> Entry {
    let leaf = now.nodes[t];
    let local = forest.local(leaf);
    let mut piece = 0;
    for (i, v) in now.mesh.tets[t].into_iter().enumerate() {
        let vertex = now.vertices[v.index()];
        let place = local.iter().position(|&other| other == vertex.into()).unwrap_or(15);
        piece |= (place as u16) << (4 * i);
    }
    let (mut node, mut path, mut shift, mut n_requested) = (leaf, 0, 0, 0);
    while let Some(parent) = forest.parent(node) {
        let first = forest.nodes[parent.index()].first_child.get().unwrap_or(node);
        path |= u64::from(node.0 - first.0) << shift;
        shift += 3;
        n_requested += u8::from(forest.states[parent.index()].is_requested);
        node = parent;
    }
    Entry { root: TetId(node.0), path: path | 1 << shift, piece, n_requested }
}

/// For each triangle, the corner that the first vertex of the whole triangle is in the first tet that has it
/// as a facet.
fn corners(forest: &Forest, first: &TetMesh, triangles: &[TriangleId]) -> Vec<u8> {
    let mut of_first = vec![0; first.triangles.len()];
    for_each_tet_facet(&first.tets, &first.triangles, |sharing| {
        let Some(root) = sharing.tets.iter().map(|(tet, _)| *tet).min() else { return };
        let vertices = forest.nodes[root.index()].vertices;
        for &t in sharing.triangles {
            let begin = in_forest(first.triangles[t as usize][0]);
            of_first[t as usize] = vertices.iter().position(|&v| v == begin).unwrap_or(0) as u8;
        }
    });
    triangles.iter().map(|t| of_first[t.index()]).collect()
}
