//! The curvature of a field at each vertex: its second derivatives, recovered from values at the vertices.

use super::estimate::{at_vertices, corners, gradients};
use crate::base::{Csr, Point, TetId, Threads, VertexId};
use crate::geometry::symmetric::{Symmetric, eigenvalues};
use crate::geometry::tet;
use crate::geometry::vector::{add, scale};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::tet_neighbors;

/// How many times values spread from vertices where they are reliable to neighbours where they are not.
const ROUNDS: usize = 2;

/// The second derivatives of a field at each vertex, by double recovery: gradients, averaged over the tets
/// around each vertex by volume (Zienkiewicz and Zhu 1987), and the gradients of these averaged again
/// (Vallet, Manole, Dompierre, Dufour and Guibault 2007, *Numerical comparison of some Hessian recovery
/// techniques*).
///
/// Means at a boundary are one-sided, and their error there is as large as the derivatives themselves. So
/// tets with a vertex on the boundary do not count. A vertex that has no other tets gets the mean of those
/// neighbours that have, in two rounds, and only where there are none the mean of all its tets.
///
/// For a quadratic field the result is exact where stars are symmetric about their vertex, as in a lattice.
/// Elsewhere an error of a few percent remains however small the tets are; this is acceptable for sizes,
/// which depend on the square root.
///
/// Panics when there is not a value for each point.
pub fn hessians(mesh: &TetMesh, values: &[f64], threads: &Threads) -> Vec<Symmetric> {
    Recovery::new(mesh, threads).hessians(values, threads)
}

/// The curvature of fields at each vertex: the largest absolute eigenvalue of the second derivatives of any
/// of them, in the unit of the field over that of an area. NaN where a value that it depends on is NaN.
///
/// Panics when there is not a value for each point in each field.
pub fn curvatures<'a>(
    mesh: &TetMesh,
    fields: impl IntoIterator<Item = &'a [f64]>,
    threads: &Threads,
) -> Vec<f64> {
    let recovery = Recovery::new(mesh, threads);
    let mut largest = vec![0.0; mesh.points.len()];
    for values in fields {
        let hessians = recovery.hessians(values, threads);
        let of_field = threads.map(hessians.len(), |v| {
            let [low, _, high] = eigenvalues(hessians[v]);
            low.abs().max(high.abs())
        });
        for (largest, of_field) in largest.iter_mut().zip(of_field) {
            // NaN stays NaN.
            if of_field.is_nan() || of_field > *largest {
                *largest = of_field;
            }
        }
    }
    largest
}

/// What recovery needs of a mesh, independent of the field.
struct Recovery<'a> {
    mesh: &'a TetMesh,
    volumes: Vec<f64>,
    /// Volumes of the tets that have no vertex on the boundary; 0 for the others.
    inner: Vec<f64>,
    /// For each vertex, whether it has such a tet.
    is_inner: Vec<bool>,
    vertex_to_tets: Csr<TetId>,
}

impl<'a> Recovery<'a> {
    fn new(mesh: &'a TetMesh, threads: &Threads) -> Self {
        let volumes = threads.map(mesh.tets.len(), |t| tet::volume(corners(mesh, mesh.tets[t])).abs());
        let mut is_boundary = vec![false; mesh.points.len()];
        for (tet, neighbors) in mesh.tets.iter().zip(tet_neighbors(&mesh.tets)) {
            for i in (0..4).filter(|&i| neighbors[i].is_none()) {
                tet::FACETS[i].into_iter().for_each(|k| is_boundary[tet[k].index()] = true);
            }
        }
        let mut is_inner = vec![false; mesh.points.len()];
        let mut inner = volumes.clone();
        for (tet, volume) in mesh.tets.iter().zip(&mut inner) {
            match tet.iter().any(|v| is_boundary[v.index()]) {
                true => *volume = 0.0,
                false => tet.iter().for_each(|v| is_inner[v.index()] |= *volume > 0.0),
            }
        }
        Self { mesh, volumes, inner, is_inner, vertex_to_tets: vertex_to_tets(mesh) }
    }

    fn hessians(&self, values: &[f64], threads: &Threads) -> Vec<Symmetric> {
        let gradients_at = at_vertices(self.mesh, &gradients(self.mesh, values, threads), &self.volumes);
        // Row k: the gradient of the derivative along axis k.
        let rows: [Vec<Point>; 3] = [0, 1, 2].map(|k| {
            let derivative: Vec<f64> = gradients_at.iter().map(|gradient| gradient[k]).collect();
            self.spread(&gradients(self.mesh, &derivative, threads))
        });
        let [x, y, z] = &rows;
        threads.map(self.mesh.points.len(), |v| {
            let ([xx, xy, xz], [yx, yy, yz], [zx, zy, zz]) = (x[v], y[v], z[v]);
            [xx, yy, zz, 0.5 * (xy + yx), 0.5 * (yz + zy), 0.5 * (xz + zx)]
        })
    }

    /// Returns means at the vertices of values of the tets: over interior tets where there are any, spread
    /// from there to the neighbouring vertices.
    fn spread(&self, of_tets: &[Point]) -> Vec<Point> {
        let mut means = at_vertices(self.mesh, of_tets, &self.inner);
        let mut is_known = self.is_inner.clone();
        for _ in 0..ROUNDS {
            let found: Vec<(usize, Point)> = (0..means.len())
                .filter(|&v| !is_known[v])
                .filter_map(|v| Some((v, self.mean_of_neighbors(v, &means, &is_known)?)))
                .collect();
            for (v, mean) in found {
                (means[v], is_known[v]) = (mean, true);
            }
        }
        if is_known.contains(&false) {
            let of_all = at_vertices(self.mesh, of_tets, &self.volumes);
            (0..means.len()).filter(|&v| !is_known[v]).for_each(|v| means[v] = of_all[v]);
        }
        means
    }

    /// Mean over known neighbours; a neighbour counts once for each tet it shares.
    fn mean_of_neighbors(&self, v: usize, values: &[Point], is_known: &[bool]) -> Option<Point> {
        let tets = self.vertex_to_tets.list(v).iter();
        let known = tets.flat_map(|t| self.mesh.tets[t.index()]).filter(|u| is_known[u.index()]);
        let (sum, n) = known.fold(([0.0; 3], 0.0), |(sum, n), u| (add(sum, values[u.index()]), n + 1.0));
        (n > 0.0).then(|| scale(sum, 1.0 / n))
    }
}

/// The tets around each vertex, in ascending order.
pub(super) fn vertex_to_tets(mesh: &TetMesh) -> Csr<TetId> {
    let ids = |t: usize, tet: &[VertexId; 4]| tet.map(|v| (v.index(), TetId::new(t)));
    Csr::from_pairs(mesh.points.len(), || mesh.tets.iter().enumerate().flat_map(|(t, tet)| ids(t, tet)))
}
