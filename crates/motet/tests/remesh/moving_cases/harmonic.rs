//! Harmonic motion: linear tets as springs, the stiffer the smaller they are; the simplest form of
//! "pseudo-elastic" solvers.

use motet::base::{Point, VertexId};
use motet::geometry::tet::{EDGES, FACETS, volume};
use motet::geometry::triangle::area_vector;
use motet::geometry::vector::{dot, scale};
use motet::mesh::TetMesh;

/// The relative residual at which the solution is accepted.
const TOLERANCE: f64 = 1e-10;

/// The displacement of every vertex: as prescribed, otherwise minimising the energy `sum over tets of
/// integral of |grad u|^2 / volume`.
pub fn harmonic(mesh: &TetMesh, prescribed: &[Option<Point>]) -> Vec<Point> {
    let system = System::of(mesh, prescribed);
    let mut displacement: Vec<Point> = prescribed.iter().map(|d| d.unwrap_or_default()).collect();
    for axis in 0..3 {
        if prescribed.iter().flatten().any(|d| d[axis] != 0.0) {
            let mut u: Vec<f64> = displacement.iter().map(|d| d[axis]).collect();
            system.solve(&mut u);
            displacement.iter_mut().zip(u).for_each(|(d, u)| d[axis] = u);
        }
    }
    displacement
}

/// The rows of the matrix for the unknowns.
struct System {
    unknowns: Vec<VertexId>,
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    diagonal: Vec<f64>,
}

impl System {
    fn of(mesh: &TetMesh, prescribed: &[Option<Point>]) -> Self {
        let mut is_used = vec![false; mesh.points.len()];
        mesh.tets.as_flattened().iter().for_each(|v| is_used[v.index()] = true);
        let is_unknown = |v: VertexId| is_used[v.index()] && prescribed[v.index()].is_none();
        let mut entries: Vec<(u64, f64)> = Vec::with_capacity(12 * mesh.tets.len());
        for tet in &mesh.tets {
            let corners = tet.map(|v| mesh.points[v.index()]);
            // The gradient of a vertex's hat function is its facet's area vector over three volumes.
            let gradients = FACETS
                .map(|facet| scale(area_vector(facet.map(|i| corners[i])), 1.0 / (3.0 * volume(corners))));
            for [i, j] in EDGES {
                let value = dot(gradients[i], gradients[j]);
                for (row, column) in [(tet[i], tet[j]), (tet[j], tet[i])] {
                    if is_unknown(row) {
                        entries.push((u64::from(row.0) << 32 | u64::from(column.0), value));
                    }
                }
            }
        }
        entries.sort_unstable_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)));
        let unknowns: Vec<_> = (0..mesh.points.len()).map(VertexId::new).filter(|&v| is_unknown(v)).collect();
        let mut system =
            Self { unknowns, offsets: vec![0], columns: vec![], values: vec![], diagonal: vec![] };
        for row in entries.chunk_by(|x, y| x.0 >> 32 == y.0 >> 32) {
            for same in row.chunk_by(|x, y| x.0 == y.0) {
                system.columns.push(same[0].0 as u32);
                system.values.push(same.iter().map(|entry| entry.1).sum());
            }
            let start = system.offsets[system.offsets.len() - 1];
            system.offsets.push(system.values.len());
            // A constant has no energy.
            system.diagonal.push(-system.values[start..].iter().sum::<f64>());
        }
        system
    }

    /// The matrix times `u`, in the rows of the unknowns.
    fn times(&self, u: &[f64]) -> Vec<f64> {
        let row = |r: usize| {
            let range = self.offsets[r]..self.offsets[r + 1];
            let off: f64 = range.map(|i| self.values[i] * u[self.columns[i] as usize]).sum();
            off + self.diagonal[r] * u[self.unknowns[r].index()]
        };
        (0..self.unknowns.len()).map(row).collect()
    }

    /// Conjugate gradients, scaled by the diagonal. Known values stay.
    fn solve(&self, u: &mut [f64]) {
        let mut residual: Vec<f64> = self.times(u).iter().map(|r| -r).collect();
        let mut way = vec![0.0; u.len()];
        let sum = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let (mut first, mut last) = (None, 1.0);
        for _ in 0..10 * self.unknowns.len() {
            let scaled: Vec<f64> = residual.iter().zip(&self.diagonal).map(|(r, d)| r / d).collect();
            let now = sum(&residual, &scaled);
            let first = *first.get_or_insert(now);
            if now <= TOLERANCE * TOLERANCE * first {
                return;
            }
            for (v, s) in self.unknowns.iter().zip(&scaled) {
                way[v.index()] = s + now / last * way[v.index()];
            }
            last = now;
            let image = self.times(&way);
            let own: f64 = self.unknowns.iter().zip(&image).map(|(v, i)| way[v.index()] * i).sum();
            let step = now / own;
            self.unknowns.iter().for_each(|v| u[v.index()] += step * way[v.index()]);
            residual.iter_mut().zip(&image).for_each(|(r, i)| *r -= step * i);
        }
    }
}
