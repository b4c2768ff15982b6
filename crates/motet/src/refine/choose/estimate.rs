//! Estimates, one number per tet, from values at the vertices: where a field is badly resolved, and where a
//! flow rotates.
//!
//! Fields are linear in each tet. All error estimates are 0 for a field that is linear throughout.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::tet;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot, norm, scale, sub};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::tet_neighbors;

/// The derivatives of a velocity: row `i` is the gradient of its component `i`.
pub type Tensor = [Point; 3];

pub(in crate::refine) fn corners(mesh: &TetMesh, vertices: [VertexId; 4]) -> [Point; 4] {
    vertices.map(|v| mesh.points[v.index()])
}

/// The gradients of the barycentric coordinates of the four vertices; all 0 in a tet without volume.
fn weight_gradients(corners: [Point; 4]) -> [Point; 4] {
    let volume_6 = tet::volume_6(corners);
    if volume_6 == 0.0 {
        return [[0.0; 3]; 4];
    }
    // Each decreases towards the facet opposite, whose area vector points out of a positive tet.
    tet::FACETS.map(|facet| scale(area_vector(facet.map(|i| corners[i])), -2.0 / volume_6))
}

/// The gradient in each tet of a field given at the vertices.
///
/// Panics when there is not a value for each point.
pub fn gradients(mesh: &TetMesh, values: &[f64], threads: &Threads) -> Vec<Point> {
    assert_eq!(values.len(), mesh.points.len(), "a value for each point");
    threads.map(mesh.tets.len(), |t| gradient(mesh, mesh.tets[t], |v| values[v.index()]))
}

fn gradient(mesh: &TetMesh, vertices: [VertexId; 4], value: impl Fn(VertexId) -> f64) -> Point {
    let weights = weight_gradients(corners(mesh, vertices));
    // Differences, so that a constant contributes exactly nothing.
    let first = value(vertices[0]);
    (1..4).fold([0.0; 3], |sum, i| add(sum, scale(weights[i], value(vertices[i]) - first)))
}

/// The jump estimate of each tet: the square root of `h / 24` times the integral, over its interior facets,
/// of the squared jump of the normal derivative, where `h` is the longest edge (Kelly, Gago, Zienkiewicz and
/// Babuska 1983, *A posteriori error analysis and adaptive processes in the finite element method*). Its unit
/// is that of the field times the root of a volume over a length.
///
/// Panics when there is not a value for each point.
pub fn gradient_jump(mesh: &TetMesh, values: &[f64], threads: &Threads) -> Vec<f64> {
    let gradients = gradients(mesh, values, threads);
    let neighbors = tet_neighbors(&mesh.tets);
    threads.map(mesh.tets.len(), |t| {
        let corners = corners(mesh, mesh.tets[t]);
        let jumps = (0..4).filter_map(|i| Some((i, neighbors[t][i].get()?))).map(|(i, neighbor)| {
            let normal = area_vector(tet::FACETS[i].map(|k| corners[k]));
            let area = norm(normal);
            let jump = dot(sub(gradients[neighbor.index()], gradients[t]), normal);
            // The square of the derivative along the unit normal, times the area.
            if area > 0.0 { jump * jump / area } else { 0.0 }
        });
        (longest_edge(corners) / 24.0 * jumps.sum::<f64>()).sqrt()
    })
}

/// The recovery estimate of each tet: the L2 norm of the difference between the gradient in the tet and the
/// gradient recovered at the vertices, a volume-weighted mean over the tets around each (Zienkiewicz and Zhu
/// 1987, *A simple error estimator and adaptive procedure for practical engineering analysis*).
///
/// Panics when there is not a value for each point.
pub fn recovery(mesh: &TetMesh, values: &[f64], threads: &Threads) -> Vec<f64> {
    let gradients = gradients(mesh, values, threads);
    let volumes = threads.map(mesh.tets.len(), |t| tet::volume(corners(mesh, mesh.tets[t])).abs());
    let recovered = at_vertices(mesh, &gradients, &volumes);
    threads.map(mesh.tets.len(), |t| {
        let off = mesh.tets[t].map(|v| sub(recovered[v.index()], gradients[t]));
        // The integral of the product of two weights is a twentieth of the volume, that of the square of one
        // a tenth.
        let whole = off.into_iter().fold([0.0; 3], add);
        let squares: f64 = off.iter().map(|d| dot(*d, *d)).sum();
        (volumes[t] / 20.0 * (squares + dot(whole, whole))).sqrt()
    })
}

/// Returns at each vertex the weighted mean of the values of the tets around it; 0 where all weights are 0.
/// It is exact for the gradient of a quadratic field where the star of the vertex is symmetric about it.
pub(super) fn at_vertices(mesh: &TetMesh, of_tets: &[Point], weights: &[f64]) -> Vec<Point> {
    let mut sums = vec![([0.0; 3], 0.0); mesh.points.len()];
    for ((vertices, value), weight) in mesh.tets.iter().zip(of_tets).zip(weights) {
        for v in vertices {
            let (sum, all) = &mut sums[v.index()];
            *sum = add(*sum, scale(*value, *weight));
            *all += weight;
        }
    }
    sums.into_iter().map(|(sum, all)| if all > 0.0 { scale(sum, 1.0 / all) } else { [0.0; 3] }).collect()
}

/// The derivatives of a velocity in each tet.
///
/// Panics when there is not a velocity for each point.
pub fn velocity_gradients(mesh: &TetMesh, velocity: &[Point], threads: &Threads) -> Vec<Tensor> {
    assert_eq!(velocity.len(), mesh.points.len(), "a velocity for each point");
    threads.map(mesh.tets.len(), |t| {
        [0, 1, 2].map(|axis| gradient(mesh, mesh.tets[t], |v| velocity[v.index()][axis]))
    })
}

/// The vorticity in each tet: the curl of the velocity.
///
/// Panics when there is not a velocity for each point.
pub fn vorticity(mesh: &TetMesh, velocity: &[Point], threads: &Threads) -> Vec<Point> {
    let curl = |[x, y, z]: Tensor| [z[1] - y[2], x[2] - z[0], y[0] - x[1]];
    velocity_gradients(mesh, velocity, threads).into_iter().map(curl).collect()
}

/// The Q criterion in each tet: half the squared norm of the rate of rotation less that of the rate of
/// strain, positive where a flow rotates more than it strains (Hunt, Wray and Moin 1988, *Eddies, streams,
/// and convergence zones in turbulent flows*).
///
/// Panics when there is not a velocity for each point.
pub fn q_criterion(mesh: &TetMesh, velocity: &[Point], threads: &Threads) -> Vec<f64> {
    let q = |du: Tensor| {
        let products = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| du[i][j] * du[j][i]);
        -0.5 * products.sum::<f64>()
    };
    velocity_gradients(mesh, velocity, threads).into_iter().map(q).collect()
}

/// The length of the longest edge.
pub(super) fn longest_edge(corners: [Point; 4]) -> f64 {
    tet::EDGES.into_iter().map(|[i, j]| norm(sub(corners[i], corners[j]))).fold(0.0, f64::max)
}
