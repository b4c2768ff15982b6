//! The matrices of tets with linear shape functions.

use crate::algebra::{Block, Block3};
use crate::base::{Point, Threads, VertexId};
use crate::geometry::tet::centroid;
use crate::geometry::vector::{add, cross, dot, scale, sub};
use crate::motion::options::{Elastic, FacetSet, Laplace};
use crate::spatial::NearestTriangle;

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
fn mean_volume(tets: &[[VertexId; 4]], points: &[Point]) -> f64 {
    let volumes = tets.iter().filter_map(|tet| Some(gradients(tet.map(|v| points[v.index()]))?.1));
    volumes.sum::<f64>() / tets.len().max(1) as f64
}

/// Element matrices of linear elasticity (Zienkiewicz, Taylor, Zhu 2005, 6.2):
/// `lambda g_i g_j^T + mu (g_j g_i^T + g_i . g_j I)`, times the volume, with a modulus of
/// `(mean volume / volume)^stiffening`.
pub(super) fn elastic<'a>(
    law: &Elastic,
    tets: &'a [[VertexId; 4]],
    points: &'a [Point],
) -> impl Fn(usize) -> [[Block3; 4]; 4] + 'a {
    let (nu, stiffening) = (law.poisson, law.stiffening);
    let lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let mu = 0.5 / (1.0 + nu);
    let mean = mean_volume(tets, points);
    move |t| {
        let Some((g, volume)) = gradients(tets[t].map(|v| points[v.index()])) else {
            return [[Block3::ZERO; 4]; 4];
        };
        let weight = volume * (mean / volume).powf(stiffening);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let both = mu * dot(g[i], g[j]);
                std::array::from_fn(|a| {
                    std::array::from_fn(|b| {
                        let shear = if a == b { both } else { 0.0 };
                        weight * (lambda * g[i][a] * g[j][b] + mu * g[j][a] * g[i][b] + shear)
                    })
                })
            })
        })
    }
}

/// Element matrices of the Laplace equation: `g_i . g_j` times the volume and the diffusivity, which is the
/// distance of the centre from the wall to the power `-exponent`.
pub(super) fn laplace<'a>(
    law: &Laplace,
    tets: &'a [[VertexId; 4]],
    points: &'a [Point],
    wall: &FacetSet,
    threads: &Threads,
) -> impl Fn(usize) -> [[f64; 4]; 4] + 'a {
    let triangles: Vec<[VertexId; 3]> = wall.triangles().collect();
    let nearest = NearestTriangle::new(points, &triangles, threads);
    let corners = |t: usize| tets[t].map(|v| points[v.index()]);
    let distances = threads.map(tets.len(), |t| {
        nearest.closest(centroid(corners(t))).map_or(1.0, |found| found.distance_squared.sqrt())
    });
    let exponent = law.exponent;
    move |t| {
        let Some((g, volume)) = gradients(tets[t].map(|v| points[v.index()])) else { return [[0.0; 4]; 4] };
        // The centre of a tet at the wall is a quarter of its height away from it: zero only by rounding.
        let weight = volume * distances[t].max(1e-9 * volume.cbrt()).powf(-exponent);
        laplacian(&g, weight)
    }
}

/// The matrix `stiffness g_i . g_j`.
pub(crate) fn laplacian(gradients: &[Point; 4], stiffness: f64) -> [[f64; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| stiffness * dot(gradients[i], gradients[j])))
}
