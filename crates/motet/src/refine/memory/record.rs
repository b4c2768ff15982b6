//! Records what must be remembered of a refined mesh.

use super::super::forest::Extracted;
use super::super::forest::{Forest, NONE};
use super::super::refinement::Refinement;
use super::Memory;
use crate::base::Threads;
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;

impl Refinement {
    /// Returns what must be kept with the mesh so that [`recall`](Self::recall) can continue from there.
    pub fn memory_to_keep(&self, threads: &Threads) -> Memory {
        let (forest, now) = (&self.forest, &self.now);
        let of_tets = threads.map(now.nodes.len(), |t| entry(forest, now, t));
        Memory {
            roots: of_tets.iter().map(|entry| entry.root).collect(),
            paths: of_tets.iter().map(|entry| entry.path).collect(),
            pieces: of_tets.iter().map(|entry| entry.piece).collect(),
            n_requested: of_tets.iter().map(|entry| entry.n_requested).collect(),
            corners: corners(forest, &self.first_mesh, &now.triangles),
            reference: now.vertices.iter().map(|&v| forest.reference[v as usize]).collect(),
        }
    }
}

struct Entry {
    root: u32,
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
        let place = local.iter().position(|&other| other == vertex).unwrap_or(15);
        piece |= (place as u16) << (4 * i);
    }
    let (mut node, mut path, mut shift, mut n_requested) = (leaf, 0, 0, 0);
    while forest.nodes[node as usize].parent != NONE {
        let parent = forest.nodes[node as usize].parent;
        let above = &forest.nodes[parent as usize];
        path |= u64::from(node - above.first_child) << shift;
        shift += 3;
        n_requested += u8::from(forest.states[parent as usize].is_requested);
        node = parent;
    }
    Entry { root: node, path: path | 1 << shift, piece, n_requested }
}

/// For each triangle, the corner that the first vertex of the whole triangle is in the first tet that has it
/// as a facet.
fn corners(forest: &Forest, first: &TetMesh, triangles: &[u32]) -> Vec<u8> {
    let mut of_first = vec![0; first.triangles.len()];
    for_each_tet_facet(&first.tets, &first.triangles, |sharing| {
        let Some(root) = sharing.tets.iter().map(|(tet, _)| *tet).min() else { return };
        let vertices = forest.nodes[root.index()].vertices;
        for &t in sharing.triangles {
            let begin = first.triangles[t as usize][0].0;
            of_first[t as usize] = vertices.iter().position(|&v| v == begin).unwrap_or(0) as u8;
        }
    });
    triangles.iter().map(|&t| of_first[t as usize]).collect()
}
