//! Finds tets that cannot be merged as before because what they fitted to has been removed.

use std::collections::HashSet;

use super::super::forest::FACET_EDGES;
use super::super::forest::NONE;
use super::trees::{Knot, Trees};
use crate::base::{Id, Point, VertexId, rising};
use crate::geometry::predicates::orient3d;
use crate::geometry::quality::eas;
use crate::geometry::tet::{EDGES, FACETS};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::{NO_TET, tet_neighbors};

/// Motion has spoilt a tet if its EAS falls below this fraction of that in the reference.
const SPOILT: f64 = 0.9;

/// Dissolves knots spoilt by motion: as a whole they would be inverted, or worse than every tet of the mesh.
pub(super) fn misshapen(trees: &mut Trees, reference: &[Point], points: &[Point], worst: f64) {
    for knot in 0..trees.knots.len() as u32 {
        let vertices: [VertexId; 4] = std::array::from_fn(|i| trees.knots[knot as usize].vertices[i]);
        let [was, is] = [reference, points].map(|points| vertices.map(|v| points[v.index()]));
        let side = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d);
        let is_worse = || eas(is).abs() < worst && eas(is).abs() < SPOILT * eas(was).abs();
        if side(is) == 0 || side(is) != side(was) || is_worse() {
            trees.dissolve(knot);
        }
    }
}

/// Dissolves knots with a split edge that a tet from elsewhere has unsplit: this is possible beside a middle
/// vertex that has moved off its edge.
pub(super) fn bridged(trees: &mut Trees, mesh: &TetMesh) {
    let of_others = mesh.tets.iter().zip(&trees.knot_of).filter(|(_, knot)| **knot == NONE);
    let edges = of_others.flat_map(|(tet, _)| EDGES.map(|[i, j]| rising([tet[i], tet[j]])));
    let edges: HashSet<[VertexId; 2]> = edges.collect();
    if edges.is_empty() {
        return;
    }
    for knot in 0..trees.knots.len() as u32 {
        let vertices = trees.knots[knot as usize].vertices;
        let mut split = EDGES.iter().enumerate().filter(|(e, _)| vertices[4 + e] != VertexId::NONE);
        if split.any(|(_, &[i, j])| edges.contains(&rising([vertices[i], vertices[j]]))) {
            trees.dissolve(knot);
        }
    }
}

/// Dissolves cut tets whose neighbour does not share a facet cut by one or two middles. Such a cut is not a
/// step towards a facet divided in four, so the tet on the other side must be able to take it back, too.
pub(super) fn unmatched(trees: &mut Trees, mesh: &TetMesh) {
    let pairs = meetings(trees, mesh);
    let mut open: Vec<u32> =
        pairs.iter().filter(|(_, other)| *other == NONE).map(|(knot, _)| *knot).collect();
    let is_gone = |trees: &Trees, knot: u32| !trees.knots[knot as usize].is_whole;
    open.extend(
        pairs.iter().filter(|(_, other)| *other != NONE && is_gone(trees, *other)).map(|(knot, _)| *knot),
    );
    while let Some(knot) = open.pop() {
        if is_gone(trees, knot) {
            continue;
        }
        trees.dissolve(knot);
        let first = pairs.partition_point(|(one, _)| *one < knot);
        let others = pairs[first..].iter().take_while(|(one, _)| *one == knot).map(|(_, other)| *other);
        open.extend(others.filter(|other| *other != NONE));
    }
}

/// Pairs each cut tet with each tet that shares a facet cut by one or two middles; [`NONE`] if the other side
/// does not have that facet. Sorted.
fn meetings(trees: &Trees, mesh: &TetMesh) -> Vec<(u32, u32)> {
    let neighbors = tet_neighbors(&mesh.tets);
    let mut pairs = Vec::new();
    for (t, behind) in neighbors.iter().enumerate() {
        let knot = trees.knot_of[t];
        if knot == NONE || trees.knots[knot as usize].vertices[4..].iter().all(|v| *v == VertexId::NONE) {
            continue;
        }
        for (i, &other) in behind.iter().enumerate().filter(|(_, other)| **other != NO_TET) {
            let triangle = FACETS[i].map(|k| mesh.tets[t][k]);
            let Some(corners) = cut_facet(&trees.knots[knot as usize], triangle) else { continue };
            let other = Some(trees.knot_of[other as usize]).filter(|&other| {
                other != NONE && cut_facet(&trees.knots[other as usize], triangle) == Some(corners)
            });
            pairs.push((knot, other.unwrap_or(NONE)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The corners, in ascending order, of the facet of a cut tet that contains a triangle; `None` unless one or
/// two of its edges are split.
fn cut_facet(knot: &Knot, triangle: [VertexId; 3]) -> Option<[VertexId; 3]> {
    let facet = (0..4).find(|&facet| {
        let corners = FACETS[facet].map(|k| knot.vertices[k]);
        let middles = FACET_EDGES[facet].map(|e| knot.vertices[4 + e]);
        triangle.iter().all(|v| corners.contains(v) || middles.contains(v))
    })?;
    let n = FACET_EDGES[facet].iter().filter(|e| knot.vertices[4 + **e] != VertexId::NONE).count();
    (n == 1 || n == 2).then(|| rising(FACETS[facet].map(|k| knot.vertices[k])))
}
