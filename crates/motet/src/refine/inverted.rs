//! Finds tets that undoing a division would invert: where points moved, eight good parts may make a bad
//! whole.

use super::forest::{Extracted, Forest};
use crate::base::{ForestVertexId, Point, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::mesh::TetMesh;

/// Returns the forest vertices, in ascending order, of all tets whose orientation differs from that of their
/// root in the reference.
pub(super) fn vertices_of_inverted(
    forest: &Forest,
    first: &TetMesh,
    out: &Extracted,
    threads: &Threads,
) -> Vec<ForestVertexId> {
    let side_of = |tet: [VertexId; 4], points: &[Point]| {
        let [a, b, c, d] = tet.map(|v| points[v.index()]);
        orient3d(a, b, c, d)
    };
    let of_roots = threads.map(first.tets.len(), |root| side_of(first.tets[root], &forest.reference));
    let is_inverted = threads.map(out.mesh.tets.len(), |t| {
        side_of(out.mesh.tets[t], &out.mesh.points) != of_roots[forest.root(out.nodes[t]).index()]
    });
    let inverted = out.mesh.tets.iter().zip(is_inverted).filter(|(_, is_inverted)| *is_inverted);
    let vertices = inverted.flat_map(|(tet, _)| *tet).map(|v: VertexId| out.vertices[v.index()]);
    let mut vertices: Vec<ForestVertexId> = vertices.collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
