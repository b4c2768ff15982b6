//! Triangles under other ids, such as those of [`crate::mesh::firsts_at_place`], so that surfaces that were written apart hang together.

use crate::base::VertexId;

/// Triangles with each vertex under its new id.
///
/// Panics when a triangle names a vertex beyond the map.
pub fn renamed(triangles: &[[VertexId; 3]], old_to_new: &[VertexId]) -> Vec<[VertexId; 3]> {
    triangles.iter().map(|t| t.map(|v| old_to_new[v.index()])).collect()
}
