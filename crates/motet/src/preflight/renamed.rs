//! Renumbers the vertices of triangles, for example by [`crate::mesh::firsts_at_place`], so that surfaces
//! that were written separately become connected.

use crate::base::VertexId;

/// The triangles with each vertex replaced by its new id.
///
/// Panics if a triangle names a vertex beyond the map.
pub fn renamed(triangles: &[[VertexId; 3]], old_to_new: &[VertexId]) -> Vec<[VertexId; 3]> {
    triangles.iter().map(|t| t.map(|v| old_to_new[v.index()])).collect()
}
