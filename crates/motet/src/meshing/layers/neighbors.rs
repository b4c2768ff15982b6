//! Finds the triangle beyond each edge of each triangle.

use crate::base::{VertexId, sorted_ids};

/// No triangle lies beyond an edge, or more than one.
pub(super) const NONE: u32 = u32::MAX;

/// For edge `k` of each triangle, from its corner `k` to the next, the other triangle there; [`NONE`] if
/// there is not exactly one.
pub(super) fn neighbors(triangles: &[[VertexId; 3]]) -> Vec<[u32; 3]> {
    let mut sides: Vec<([VertexId; 2], u32, usize)> = (0..)
        .zip(triangles)
        .flat_map(|(t, triangle)| {
            (0..3).map(move |k| (sorted_ids([triangle[k], triangle[(k + 1) % 3]]), t, k))
        })
        .collect();
    sides.sort_unstable();
    let mut behind = vec![[NONE; 3]; triangles.len()];
    for same in sides.chunk_by(|x, y| x.0 == y.0) {
        if let &[(_, s, i), (_, t, k)] = same {
            behind[s as usize][i] = t;
            behind[t as usize][k] = s;
        }
    }
    behind
}
