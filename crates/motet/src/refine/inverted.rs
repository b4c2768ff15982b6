//! Where points moved, eight good tets may make a bad one: such divisions are not taken back.

use super::extract::Extracted;
use super::forest::Forest;
use crate::base::{Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::mesh::TetMesh;

/// The vertices of the forest at tets that face the other way than the tet of the first mesh that they lie in was given to.
pub(super) fn vertices_of_inverted(
    forest: &Forest,
    first: &TetMesh,
    out: &Extracted,
    threads: &Threads,
) -> Vec<u32> {
    let side = threads.map(out.mesh.tets.len(), |t| {
        let root = forest.root(out.nodes[t]) as usize;
        let is_turned = first.tets[root][0].0 != forest.nodes[root].vertices[0];
        let [a, b, c, d] = out.mesh.tets[t].map(|v| out.mesh.points[v.index()]);
        if is_turned { -orient3d(a, b, c, d) } else { orient3d(a, b, c, d) }
    });
    let inverted = out.mesh.tets.iter().zip(side).filter(|(_, side)| *side <= 0);
    let vertices = inverted.flat_map(|(tet, _)| *tet).map(|v: VertexId| out.vertices[v.index()]);
    let mut vertices: Vec<u32> = vertices.collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
