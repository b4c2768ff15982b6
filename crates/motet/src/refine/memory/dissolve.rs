//! Finds tets that cannot be merged as before because what they fitted to has been removed.

use std::collections::HashSet;

use super::super::forest::FACET_EDGES;
use super::trees::{TreeNode, TreeNodeId, Trees};
use crate::base::{MaybeId, Point, TetId, VertexId, sorted_ids};
use crate::geometry::predicates::orient3d;
use crate::geometry::quality::eas;
use crate::geometry::tet::{EDGES, FACETS};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::tet_neighbors;

/// Motion has spoilt a tet if its EAS falls below this fraction of that in the reference.
const SPOILT: f64 = 0.9;

/// Dissolves nodes spoilt by motion: as a whole they would be inverted, or worse than every tet of the mesh.
pub(super) fn misshapen(trees: &mut Trees, reference: &[Point], points: &[Point], worst: f64) {
    for node in (0..trees.nodes.len()).map(TreeNodeId::new) {
        let corners = trees.nodes[node.index()].corners;
        let [was, is] = [reference, points].map(|points| corners.map(|v| points[v.index()]));
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
    let of_others = mesh.tets.iter().zip(&trees.node_of).filter(|(_, node)| node.is_none());
    let edges = of_others.flat_map(|(tet, _)| EDGES.map(|[i, j]| sorted_ids([tet[i], tet[j]])));
    let edges: HashSet<[VertexId; 2]> = edges.collect();
    if edges.is_empty() {
        return;
    }
    for node in (0..trees.nodes.len()).map(TreeNodeId::new) {
        let TreeNode { corners, middles, .. } = trees.nodes[node.index()];
        let mut split = EDGES.iter().zip(middles).filter(|(_, middle)| middle.is_some());
        if split.any(|(&[i, j], _)| edges.contains(&sorted_ids([corners[i], corners[j]]))) {
            trees.dissolve(node);
        }
    }
}

/// Dissolves cut tets whose neighbour does not share a facet cut by one or two middles. Such a cut is not a
/// step towards a facet divided in four, so the tet on the other side must be able to take it back, too.
pub(super) fn unmatched(trees: &mut Trees, mesh: &TetMesh) {
    let pairs = meetings(trees, mesh);
    let mut open: Vec<TreeNodeId> =
        pairs.iter().filter(|(_, other)| other.is_none()).map(|(node, _)| *node).collect();
    let is_dissolved = |trees: &Trees, node: TreeNodeId| !trees.nodes[node.index()].is_whole;
    open.extend(
        pairs
            .iter()
            .filter(|(_, other)| other.get().is_some_and(|other| is_dissolved(trees, other)))
            .map(|(node, _)| *node),
    );
    while let Some(node) = open.pop() {
        if is_dissolved(trees, node) {
            continue;
        }
        trees.dissolve(node);
        let first = pairs.partition_point(|(one, _)| *one < node);
        let others = pairs[first..].iter().take_while(|(one, _)| *one == node).map(|(_, other)| *other);
        open.extend(others.filter_map(MaybeId::get));
    }
}

/// Pairs each cut tet with each tet that shares a facet cut by one or two middles; none if the other side
/// does not have that facet. Sorted.
fn meetings(trees: &Trees, mesh: &TetMesh) -> Vec<(TreeNodeId, MaybeId<TreeNodeId>)> {
    // A part of such a facet has one of the middles, and so have all tets that share it.
    let mut is_middle = vec![false; mesh.points.len()];
    let cut = trees.nodes.iter().filter(|node| node.divided.is_none());
    cut.flat_map(|node| node.middles).filter_map(MaybeId::get).for_each(|v| is_middle[v.index()] = true);
    let near: Vec<TetId> = (0..mesh.tets.len())
        .filter(|&t| mesh.tets[t].iter().any(|v| is_middle[v.index()]))
        .map(TetId::new)
        .collect();
    let tets: Vec<[VertexId; 4]> = near.iter().map(|t| mesh.tets[t.index()]).collect();
    let neighbors = tet_neighbors(&tets);
    let mut pairs = Vec::new();
    for (t, behind) in near.iter().map(|t| t.index()).zip(&neighbors) {
        let Some(node) = trees.node_of[t].get() else { continue };
        if trees.nodes[node.index()].middles.iter().all(|middle| middle.is_none()) {
            continue;
        }
        for (i, other) in behind.iter().enumerate() {
            let Some(other) = other.get().map(|other| near[other.index()]) else { continue };
            let triangle = FACETS[i].map(|k| mesh.tets[t][k]);
            let Some(corners) = cut_facet(&trees.nodes[node.index()], triangle) else { continue };
            let has_it =
                |other: &TreeNodeId| cut_facet(&trees.nodes[other.index()], triangle) == Some(corners);
            pairs.push((node, trees.node_of[other.index()].get().filter(has_it).into()));
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
        let corners = FACETS[facet].map(|k| node.corners[k]);
        let middles = FACET_EDGES[facet].map(|e| node.middles[e]);
        triangle.iter().all(|v| corners.contains(v) || middles.contains(&(*v).into()))
    })?;
    let n = FACET_EDGES[facet].iter().filter(|e| node.middles[**e].is_some()).count();
    (n == 1 || n == 2).then(|| sorted_ids(FACETS[facet].map(|k| node.corners[k])))
}
