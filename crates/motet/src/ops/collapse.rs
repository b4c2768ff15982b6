//! A vertex drawn along an edge into its other end.

use crate::base::{TetId, VertexId};
use crate::kernel::{Change, Complex, VertexChange};

/// Proposes to draw `gone` into `kept`. `star` are the tets of `gone`. `false` when a tet would not be better than `bar`.
pub fn collapse(
    complex: &Complex,
    star: &[TetId],
    gone: VertexId,
    kept: VertexId,
    bar: f64,
    change: &mut Change,
) -> bool {
    change.clear();
    change.vertex = VertexChange::Remove(gone);
    change.cavity.extend_from_slice(star);
    for &tet in star {
        let mut vertices = complex.vertices(tet);
        if vertices.contains(&kept) {
            continue;
        }
        vertices[complex.place(tet, gone)] = kept;
        change.push(complex, vertices, complex.region(tet));
        if !(change.fill[change.fill.len() - 1].quality > bar) {
            return false;
        }
    }
    true
}
