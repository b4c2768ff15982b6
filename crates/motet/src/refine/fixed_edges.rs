//! Keeps refinement away from edges that cells of other kinds hold, which must not be split.

use super::forest::{Extracted, Forest, in_forest};
use crate::base::{ForestVertexId, TetId, VertexId};
use crate::mesh::TetMesh;

/// Returns the ends, as forest vertices, of fixed edges that are split nevertheless.
pub(super) fn ends_of_split_fixed_edges(forest: &Forest, first: &TetMesh) -> Vec<ForestVertexId> {
    let is_split = |edge: &&[VertexId; 2]| {
        forest.root_edge(edge.map(in_forest)).is_some_and(|edge| forest.is_split[edge.index()])
    };
    first.fixed_edges.iter().filter(is_split).flatten().copied().map(in_forest).collect()
}

/// The neighbourhood of such edges: rings of tets, one more with every attempt.
#[derive(Debug, Default)]
pub(super) struct Neighborhood {
    is_near: Vec<bool>,
    n_rings: usize,
}

impl Neighborhood {
    /// Removes the marks of tets near the given forest vertices; at least one mark is removed.
    pub(super) fn remove_marks(
        &mut self,
        forest: &Forest,
        now: &Extracted,
        vertices: &[ForestVertexId],
        marked: &mut Vec<TetId>,
    ) {
        let mesh = &now.mesh;
        self.is_near.resize(mesh.points.len(), false);
        let numbers = now.numbers(forest.reference.len());
        let known = vertices.iter().filter_map(|v| numbers[v.index()].get());
        known.for_each(|v| self.is_near[v.index()] = true);
        (0..self.n_rings).for_each(|_| self.grow(mesh));
        self.n_rings += 1;
        let n = marked.len();
        while marked.len() == n && n > 0 {
            let before = self.is_near.iter().filter(|near| **near).count();
            marked.retain(|tet| !mesh.tets[tet.index()].iter().any(|v| self.is_near[v.index()]));
            self.grow(mesh);
            if self.is_near.iter().filter(|near| **near).count() == before {
                marked.clear();
            }
        }
    }

    /// Adds the vertices of all tets that touch the neighbourhood.
    fn grow(&mut self, mesh: &TetMesh) {
        let is_near = self.is_near.clone();
        for tet in mesh.tets.iter().filter(|tet| tet.iter().any(|v| is_near[v.index()])) {
            tet.iter().for_each(|v| self.is_near[v.index()] = true);
        }
    }
}
