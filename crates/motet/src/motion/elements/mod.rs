//! Linear finite elements on tets: shape functions, and the systems of the vertices that they couple.

mod assemble;

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, cross, dot, scale, sub};

pub(crate) use assemble::{NumberedTets, Numbering, System};

/// The gradients of the shape functions, and the absolute volume; `None` where that is zero or not finite.
pub(crate) fn gradients([p, q, r, s]: [Point; 4]) -> Option<([Point; 4], f64)> {
    let (a, b, c) = (sub(q, p), sub(r, p), sub(s, p));
    let volume_6 = dot(a, cross(b, c));
    if volume_6 == 0.0 || !volume_6.is_finite() {
        return None;
    }
    let [x, y, z] = [cross(b, c), cross(c, a), cross(a, b)].map(|n| scale(n, 1.0 / volume_6));
    Some(([scale(add(add(x, y), z), -1.0), x, y, z], volume_6.abs() / 6.0))
}

/// The mean volume, as a unit in which numbers are neither large nor small.
pub(crate) fn mean_volume(tets: &[[VertexId; 4]], points: &[Point]) -> f64 {
    let volumes = tets.iter().filter_map(|tet| Some(gradients(tet.map(|v| points[v.index()]))?.1));
    volumes.sum::<f64>() / tets.len().max(1) as f64
}

/// The matrix `stiffness g_i . g_j`.
pub(crate) fn laplacian(gradients: &[Point; 4], stiffness: f64) -> [[f64; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| stiffness * dot(gradients[i], gradients[j])))
}
