//! A Laplace equation for each coordinate of the displacement, with a diffusivity that falls with the
//! distance from the wall (Jasak and Tukovic 2006).

use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::tet::centroid;
use crate::motion::elements::{gradients, laplacian};
use crate::motion::methods::linear::Domain;
use crate::motion::methods::{Prepare, Prepared, Reference, Scene};
use crate::motion::nodes::not_sliding;
use crate::motion::options::{FacetSet, Laplace};
use crate::spatial::NearestTriangle;

/// A Laplace equation, and where it is stiff.
#[derive(Debug)]
pub(crate) struct LaplaceEquation {
    law: Laplace,
    wall: FacetSet,
}

impl LaplaceEquation {
    /// The equation on a mesh. The wall is that of the law, or else all of the boundary that does not slide.
    pub(crate) fn new(law: &Laplace, reference: &Reference<'_>) -> Self {
        let all = || not_sliding(reference.boundary, &reference.options.sliding);
        Self { law: law.clone(), wall: law.wall.clone().unwrap_or_else(all) }
    }
}

impl Prepare for LaplaceEquation {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared> {
        let domain = Domain::new(scene, points);
        let of_tet = element_matrices(&self.law, &domain.tets.vertices, points, &self.wall, threads);
        domain.prepared(of_tet, (self.law.tolerance, self.law.factor_bytes), threads)
    }
}

/// Element matrices of the Laplace equation: `g_i . g_j` times the volume and the diffusivity, which is the
/// distance of the centre from the wall to the power `-exponent`.
fn element_matrices<'a>(
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
