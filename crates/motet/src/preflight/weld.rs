//! Points at exactly the same place under one id, so that surfaces that were written apart hang together.

use crate::base::{Point, VertexId};
use crate::mesh::firsts_at_place;

/// For each point the smallest id at exactly the same place: what [`renamed`] takes. A point with a coordinate that is no
/// number stays itself.
pub fn weld(points: &[Point]) -> Vec<VertexId> {
    firsts_at_place(points)
}

/// Triangles with each vertex under its new id.
///
/// Panics when a triangle names a vertex beyond the map.
pub fn renamed(triangles: &[[VertexId; 3]], old_to_new: &[VertexId]) -> Vec<[VertexId; 3]> {
    triangles.iter().map(|t| t.map(|v| old_to_new[v.index()])).collect()
}
