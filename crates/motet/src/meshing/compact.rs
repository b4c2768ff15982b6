//! Removes unused points.

use crate::base::{Point, VertexId};

/// For each of `n` vertices, whether it occurs in `vertices`.
pub(crate) fn used_vertices<'a>(n: usize, vertices: impl Iterator<Item = &'a VertexId>) -> Vec<bool> {
    let mut is_used = vec![false; n];
    vertices.for_each(|v| is_used[v.index()] = true);
    is_used
}

/// Returns the used points and the new number of each point; the number is meaningless for unused ones.
pub(crate) fn compact(points: &[Point], is_used: &[bool]) -> (Vec<Point>, Vec<VertexId>) {
    let mut old_to_new = vec![VertexId(0); points.len()];
    let mut kept = Vec::new();
    for (v, &point) in points.iter().enumerate().filter(|(v, _)| is_used[*v]) {
        old_to_new[v] = VertexId::new(kept.len());
        kept.push(point);
    }
    (kept, old_to_new)
}
