//! Linear elasticity, in which cells are stiffer the smaller they are (Tezduyar 1992; Stein, Tezduyar, Benney
//! 2003: "Jacobian-based stiffening").

use crate::algebra::{Block, Block3};
use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::vector::dot;
use crate::motion::elements::{gradients, mean_volume};
use crate::motion::methods::linear::Domain;
use crate::motion::methods::{Prepare, Prepared, Scene};
use crate::motion::options::Elastic;

impl Prepare for Elastic {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared> {
        let domain = Domain::new(scene, points);
        let of_tet = element_matrices(self, &domain.tets.vertices, points);
        domain.prepared(of_tet, (self.tolerance, self.factor_bytes), threads)
    }
}

/// Element matrices of linear elasticity (Zienkiewicz, Taylor, Zhu 2005, 6.2):
/// `lambda g_i g_j^T + mu (g_j g_i^T + g_i . g_j I)`, times the volume, with a modulus of
/// `(mean volume / volume)^stiffening`.
fn element_matrices<'a>(
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
