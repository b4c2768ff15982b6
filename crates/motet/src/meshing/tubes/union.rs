//! The union of the parts of a surface of wires, with the sizes of its triangles.

use std::collections::{BTreeMap, BTreeSet};

use super::super::compact::{compact, used_vertices};
use crate::base::{Point, Threads, VertexId, sorted_ids};
use crate::mesh::shapes::Soup;
use crate::preflight::renamed;
use crate::preflight::union::{Failure, unite};

/// So many rings of triangles beside the place where parts met are made even with it.
const RINGS: usize = 2;

/// A closed surface.
#[derive(Clone, Debug, Default)]
pub(super) struct United {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// The length of the sides of the parts at each point.
    pub(super) sizes: Vec<f64>,
    /// Whether each point is so far from where parts met that its triangles are as even as they were made.
    pub(super) is_far: Vec<bool>,
    /// The number of places where parts met.
    pub(super) clusters: usize,
    /// How many of these could be divided only after points had been shifted by a tiny length.
    pub(super) shifted: usize,
}

/// The union of the parts of a soup, each of which is closed and faces outward; they may cross and touch, and
/// each may cross itself. Points nearer than `near` are one place.
///
/// # Errors
/// When dividing fails, or the result would not be closed and free of crossings.
pub(super) fn union(soup: &Soup, near: f64, threads: &Threads) -> Result<United, Failure> {
    let union = unite(&soup.points, &soup.triangles, near, threads)?;
    let (kept, origins): (Vec<[VertexId; 3]>, Vec<u32>) = union.pieces.into_iter().unzip();
    let is_used = used_vertices(union.points.len(), kept.as_flattened().iter());
    let (points, old_to_new) = compact(&union.points, &is_used);
    let triangles = renamed(&kept, &old_to_new);
    let mut sizes = vec![f64::INFINITY; points.len()];
    for (t, &origin) in triangles.iter().zip(&origins) {
        for v in t {
            sizes[v.index()] = sizes[v.index()].min(soup.sizes[origin as usize]);
        }
    }
    let is_near: Vec<bool> = origins.iter().map(|&t| union.is_cut[t as usize]).collect();
    let is_far = far(points.len(), &triangles, &is_near);
    Ok(United { points, triangles, sizes, is_far, shifted: union.shifted, clusters: union.clusters })
}

/// The points that are more than [`RINGS`] edges away from triangles that are near the place where parts met.
fn far(n_points: usize, triangles: &[[VertexId; 3]], is_near: &[bool]) -> Vec<bool> {
    let mut is_far = vec![true; n_points];
    triangles.iter().zip(is_near).filter(|of| *of.1).for_each(|(t, _)| {
        t.iter().for_each(|v| is_far[v.index()] = false);
    });
    for _ in 0..RINGS {
        let beside = |t: &&[VertexId; 3]| t.iter().any(|v| !is_far[v.index()]);
        let ring: Vec<VertexId> = triangles.iter().filter(beside).flatten().copied().collect();
        ring.into_iter().for_each(|v| is_far[v.index()] = false);
    }
    is_far
}

/// The edges that more than two triangles share.
pub(super) fn branching_edges(triangles: &[[VertexId; 3]]) -> usize {
    let mut edges: Vec<[VertexId; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(sorted_ids)).collect();
    edges.sort_unstable();
    edges.chunk_by(|x, y| x == y).filter(|same| same.len() > 2).count()
}

/// The vertices whose triangles are not one fan, beside those of edges that more than two triangles share.
pub(super) fn pinched_vertices(triangles: &[[VertexId; 3]]) -> usize {
    let mut fans: BTreeMap<VertexId, Vec<[VertexId; 2]>> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (v, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            fans.entry(v).or_default().push(edge);
        }
    }
    let is_pinched = |edges: &Vec<[VertexId; 2]>| {
        let mut reached = BTreeSet::from([edges[0][0]]);
        let mut at = edges[0][1];
        while reached.insert(at) {
            match edges.iter().find(|edge| edge[0] == at) {
                Some(edge) => at = edge[1],
                None => break,
            }
        }
        reached.len() < edges.len()
    };
    fans.values().filter(|edges| is_pinched(edges)).count()
}
