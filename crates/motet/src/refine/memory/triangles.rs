//! Merges the triangles of a mesh again, as its tets are merged.

use super::super::forest::FACET_EDGES;
use super::super::forest::eight;
use super::trees::{TreeNode, Trees};
use super::{Memory, unfit};
use crate::base::{Result, TetId, TriangleId, VertexId, sorted_ids};
use crate::geometry::tet::FACETS;
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;

/// The triangles before division.
pub(super) struct Gathered {
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) patches: Vec<i32>,
    /// For each triangle of the mesh, which of these it is a part of.
    pub(super) part_of: Vec<TriangleId>,
}

/// Returns the triangles before division, in order.
pub(super) fn gather(mesh: &TetMesh, memory: &Memory, trees: &Trees) -> Result<Gathered> {
    let mut beside: Vec<[Option<TetId>; 2]> = vec![[None; 2]; mesh.triangles.len()];
    // Few tets have three vertices on triangles.
    let mut has_triangle = vec![false; mesh.points.len()];
    mesh.triangles.as_flattened().iter().for_each(|v| has_triangle[v.index()] = true);
    let is_near = |tet: &[VertexId; 4]| tet.iter().filter(|v| has_triangle[v.index()]).count() > 2;
    let near: Vec<TetId> = (0..mesh.tets.len()).filter(|&t| is_near(&mesh.tets[t])).map(TetId::new).collect();
    let tets: Vec<[VertexId; 4]> = near.iter().map(|t| mesh.tets[t.index()]).collect();
    for_each_tet_facet(&tets, &mesh.triangles, |sharing| {
        let mut tets = [0, 1].map(|k| sharing.tets.get(k).map(|(tet, _)| near[tet.index()]));
        tets.sort_unstable();
        sharing.triangles.iter().for_each(|&t| beside[t as usize] = tets);
    });
    let mut keys = Vec::with_capacity(beside.len());
    for (t, tets) in beside.iter().enumerate() {
        let (mut whole, mut most) = (mesh.triangles[t], None);
        // Only the corner of the first tet is recorded. If others have changed that tet, the second still
        // tells which whole the parts belong to.
        for tet in tets.iter().flatten() {
            let (of_tet, n_divided) = whole_of(mesh.triangles[t], memory.corners[t], trees, *tet)?;
            if most.is_none_or(|most| n_divided > most) {
                (whole, most) = (of_tet, Some(n_divided));
            }
        }
        keys.push((sorted_ids(whole), t, whole));
    }
    // Duplicate triangles, with the same vertices, stay apart.
    let mut firsts: Vec<(usize, [VertexId; 3])> = Vec::new();
    let mut part_of = vec![0; keys.len()];
    keys.sort_unstable();
    for same in keys.chunk_by(|x, y| x.0 == y.0) {
        let is_part = |t: usize, whole: [VertexId; 3]| mesh.triangles[t].iter().any(|v| !whole.contains(v));
        for (i, &(_, t, whole)) in same.iter().enumerate() {
            let is_new = i == 0 || !is_part(t, whole);
            if is_new {
                firsts.push((t, whole));
            } else if mesh.patches[t] != mesh.patches[same[0].1] {
                return Err(unfit(&format!(
                    "triangle {t} has a different patch from the other parts of its divided triangle"
                )));
            }
            part_of[t] = if is_new { t } else { same[0].1 };
        }
    }
    firsts.sort_unstable();
    let of_first = |t: usize| TriangleId::new(firsts.partition_point(|(first, _)| *first < t));
    let part_of = part_of.into_iter().map(of_first).collect();
    let patches = firsts.iter().map(|(t, _)| mesh.patches[*t]).collect();
    Ok(Gathered { triangles: firsts.into_iter().map(|(_, whole)| whole).collect(), patches, part_of })
}

/// Returns the undivided triangle that a triangle is a part of, as far as the tet is part of a larger one,
/// and how many divisions lead from it to the part.
fn whole_of(
    triangle: [VertexId; 3],
    corner: u8,
    trees: &Trees,
    tet: TetId,
) -> Result<([VertexId; 3], usize)> {
    let Some(top) = trees.top_of(tet) else { return Ok((triangle, 0)) };
    let Some(leaf) = trees.node_of[tet.index()].get() else { return Ok((triangle, 0)) };
    let mut node = &trees.nodes[leaf.index()];
    let place = |v: &VertexId| node.local(*v).unwrap_or(0);
    let inside = || unfit("a triangle lies inside a divided tet");
    let places = [0, 1, 2].map(|i| place(&triangle[i]));
    let mut facet = facet_of(places).ok_or_else(inside)?;
    // A cut tet has only a part of the facet; a tet divided together with its neighbour has a whole facet, a
    // smaller one.
    let mut n_divided = usize::from(places.iter().any(|k| *k > 3));
    while let Some(parent) = node.parent.get().filter(|_| !std::ptr::eq(node, &trees.nodes[top.index()])) {
        let parent = &trees.nodes[parent.index()];
        let Some((way, _)) = parent.divided else { break };
        let child = eight(way)[node.place];
        facet = facet_of(facet.map(|k| usize::from(child[k]))).ok_or_else(inside)?;
        node = parent;
        n_divided += 1;
    }
    Ok((rotated_to(facet, corner, node, triangle), n_divided))
}

/// The vertices of a facet, starting from the given corner if the facet has it.
fn rotated_to(facet: [usize; 3], corner: u8, node: &TreeNode, triangle: [VertexId; 3]) -> [VertexId; 3] {
    let vertices = facet.map(|k| node.corners[k]);
    // An undivided triangle keeps its first vertex.
    let begin = match vertices.iter().position(|v| *v == triangle[0]) {
        Some(begin) if triangle.iter().all(|v| vertices.contains(v)) => begin,
        _ => facet.iter().position(|k| *k == usize::from(corner)).unwrap_or(0),
    };
    [0, 1, 2].map(|i| vertices[(begin + i) % 3])
}

/// The corners of the facet that three local vertices lie on, oriented as these are; `None` if there is no
/// such facet.
fn facet_of(locals: [usize; 3]) -> Option<[usize; 3]> {
    (0..4).find_map(|facet| {
        let mut rows = [[0; 3]; 3];
        for (row, local) in rows.iter_mut().zip(locals) {
            *row = place_on(facet, local)?;
        }
        let [a, b, c] = rows;
        let turn: i32 =
            (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3])).sum();
        let [x, y, z] = FACETS[facet];
        if turn < 0 { Some([x, z, y]) } else { Some([x, y, z]) }
    })
}

/// Twice the barycentric coordinates of a local vertex on a facet.
fn place_on(facet: usize, local: usize) -> Option<[i32; 3]> {
    let mut weights = [0; 3];
    if let Some(k) = FACETS[facet].iter().position(|corner| *corner == local) {
        weights[k] = 2;
        return Some(weights);
    }
    let k = FACET_EDGES[facet].iter().position(|e| 4 + e == local)?;
    (weights[(k + 1) % 3], weights[(k + 2) % 3]) = (1, 1);
    Some(weights)
}
