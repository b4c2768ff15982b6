//! Finds tets that cannot be merged as before because what they fitted to has been removed.

use std::collections::HashSet;

use super::super::forest::FACET_EDGES;
use super::super::forest::NONE;
use super::trees::{TreeNode, Trees};
use crate::base::{Id, Point, VertexId, sorted_ids};
use crate::geometry::predicates::orient3d;
use crate::geometry::quality::eas;
use crate::geometry::tet::{EDGES, FACETS};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::{NO_TET, tet_neighbors};

/// Motion has spoilt a tet if its EAS falls below this fraction of that in the reference.
const SPOILT: f64 = 0.9;

/// Dissolves nodes spoilt by motion: as a whole they would be inverted, or worse than every tet of the mesh.
pub(super) fn misshapen(trees: &mut Trees, reference: &[Point], points: &[Point], worst: f64) {
    for node in 0..trees.nodes.len() as u32 {
        let vertices: [VertexId; 4] = std::array::from_fn(|i| trees.nodes[node as usize].vertices[i]);
        let [was, is] = [reference, points].map(|points| vertices.map(|v| points[v.index()]));
        let side = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d);
        let is_worse = || eas(is).abs() < worst && eas(is).abs() < SPOILT * eas(was).abs();
        if side(is) == 0 || side(is) != side(was) || is_worse() {
            trees.dissolve(node);
        }
    }
}

/// Dissolves nodes with a split edge that a tet from elsewhere has unsplit: this is possible beside a middle
/// vertex that has moved off its edge.
pub(super) fn bridged(trees: &mut Trees, mesh: &TetMesh) {
    let of_others = mesh.tets.iter().zip(&trees.node_of).filter(|(_, node)| **node == NONE);
    let edges = of_others.flat_map(|(tet, _)| EDGES.map(|[i, j]| sorted_ids([tet[i], tet[j]])));
    let edges: HashSet<[VertexId; 2]> = edges.collect();
    if edges.is_empty() {
        return;
    }
    for node in 0..trees.nodes.len() as u32 {
        let vertices = trees.nodes[node as usize].vertices;
        let mut split = EDGES.iter().enumerate().filter(|(e, _)| vertices[4 + e] != VertexId::NONE);
        if split.any(|(_, &[i, j])| edges.contains(&sorted_ids([vertices[i], vertices[j]]))) {
            trees.dissolve(node);
        }
    }
}

/// Dissolves cut tets whose neighbour does not share a facet cut by one or two middles. Such a cut is not a
/// step towards a facet divided in four, so the tet on the other side must be able to take it back, too.
pub(super) fn unmatched(trees: &mut Trees, mesh: &TetMesh) {
    let pairs = meetings(trees, mesh);
    let mut open: Vec<u32> =
        pairs.iter().filter(|(_, other)| *other == NONE).map(|(node, _)| *node).collect();
    let is_dissolved = |trees: &Trees, node: u32| !trees.nodes[node as usize].is_whole;
    open.extend(
        pairs
            .iter()
            .filter(|(_, other)| *other != NONE && is_dissolved(trees, *other))
            .map(|(node, _)| *node),
    );
    while let Some(node) = open.pop() {
        if is_dissolved(trees, node) {
            continue;
        }
        trees.dissolve(node);
        let first = pairs.partition_point(|(one, _)| *one < node);
        let others = pairs[first..].iter().take_while(|(one, _)| *one == node).map(|(_, other)| *other);
        open.extend(others.filter(|other| *other != NONE));
    }
}

/// Pairs each cut tet with each tet that shares a facet cut by one or two middles; [`NONE`] if the other side
/// does not have that facet. Sorted.
fn meetings(trees: &Trees, mesh: &TetMesh) -> Vec<(u32, u32)> {
    let neighbors = tet_neighbors(&mesh.tets);
    let mut pairs = Vec::new();
    for (t, behind) in neighbors.iter().enumerate() {
        let node = trees.node_of[t];
        if node == NONE || trees.nodes[node as usize].vertices[4..].iter().all(|v| *v == VertexId::NONE) {
            continue;
        }
        for (i, &other) in behind.iter().enumerate().filter(|(_, other)| **other != NO_TET) {
            let triangle = FACETS[i].map(|k| mesh.tets[t][k]);
            let Some(corners) = cut_facet(&trees.nodes[node as usize], triangle) else { continue };
            let other = Some(trees.node_of[other as usize]).filter(|&other| {
                other != NONE && cut_facet(&trees.nodes[other as usize], triangle) == Some(corners)
            });
            pairs.push((node, other.unwrap_or(NONE)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The corners, in ascending order, of the facet of a cut tet that contains a triangle; `None` unless one or
/// two of its edges are split.
fn cut_facet(node: &TreeNode, triangle: [VertexId; 3]) -> Option<[VertexId; 3]> {
    let facet = (0..4).find(|&facet| {
        let corners = FACETS[facet].map(|k| node.vertices[k]);
        let middles = FACET_EDGES[facet].map(|e| node.vertices[4 + e]);
        triangle.iter().all(|v| corners.contains(v) || middles.contains(v))
    })?;
    let n = FACET_EDGES[facet].iter().filter(|e| node.vertices[4 + **e] != VertexId::NONE).count();
    (n == 1 || n == 2).then(|| sorted_ids(FACETS[facet].map(|k| node.vertices[k])))
}
