//! Rows for quadratic fields: a vertex in a tet takes its value from the tet's corners and from the vertices
//! around them.
//!
//! With the weights `w_i` of a place `p` in a tet with corners `x_i`, values `u_i` and gradients `g_i` there,
//!
//! `u(p) = sum w_i (u_i + g_i . (p - x_i) / 2)`
//!
//! is exact for quadratic fields: the error of the sum of `w_i u_i` is the sum of
//! `w_i (x_i - p) . H (x_i - p) / 2`, which the other term cancels. The gradient at a corner is that of the
//! quadratic that takes the value at the corner and fits the values around it best (least squares), as in
//! Zhang and Naga 2005, *A new finite element gradient recovery method: superconvergence property*. It is
//! linear in these values, so the whole formula is one row.
//!
//! Only values on the same side of all walls are used: none across a triangle of the mesh or from another
//! region, where a field may have a kink. A vertex whose tet has all its corners on walls gets no such row:
//! values on walls must not depend on values off them.

use std::collections::BTreeMap;

use super::map;
use crate::base::{Csr, MaybeId, Point, TetId, Threads, VertexId};
use crate::geometry::vector::{dot, sub};
use crate::mesh::history::{Rows, merge_parts};
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::mesh::{CellKind, Mesh};

/// The most that the negative shares of a row may sum to. A row with more is scaled down towards the row for
/// linear fields, since it could amplify round-off.
const MAX_NEGATIVE: f64 = 0.5;

/// A fit is rejected if less than this fraction of one of its nine terms is independent of the terms before
/// it.
const MIN_INDEPENDENT: f64 = 1e-6;

/// Rows for quadratic fields, for those new vertices that can have one. `rows` are the rows for linear
/// fields, each over vertices of `old` that share a tet. The result does not depend on the number of threads.
///
/// Panics when a vertex id is beyond the points.
pub(crate) fn quadratic_rows(old: &Mesh, rows: &Rows<VertexId>, threads: &Threads) -> Rows<VertexId> {
    let near = Neighborhood::new(old, rows);
    let mut jobs: BTreeMap<(VertexId, u32), Vec<u32>> = BTreeMap::new();
    let mut wanted = Vec::new();
    for (&id, row) in rows.ids().iter().zip(rows.iter()) {
        if let Some(host) = near.host(row.from) {
            let key = |&corner: &VertexId| {
                let side = near.side(&[corner], &[host]);
                let key = (corner, side.iter().copied().min().unwrap_or(host));
                jobs.entry(key).or_insert(side);
                key
            };
            wanted.push((id, row, row.from.iter().map(key).collect::<Vec<_>>()));
        }
    }
    let jobs: Vec<_> = jobs.into_iter().collect();
    let gradients = map(&jobs, threads, |((corner, _), side)| near.gradient(*corner, side));
    let gradient = |key: &(VertexId, u32)| {
        let place = jobs.binary_search_by_key(key, |job| job.0).ok()?;
        gradients[place].as_ref()
    };
    let mut found = Rows::new();
    for (id, row, keys) in wanted {
        let gradients: Option<Vec<&Gradient>> = keys.iter().map(gradient).collect();
        if let Some(gradients) = gradients {
            let linear: Vec<(VertexId, f64)> =
                row.from.iter().copied().zip(row.shares.iter().copied()).collect();
            found.push_signed(id, &with_gradient_term(&old.points, &linear, &gradients), row.main);
        }
    }
    found
}

/// The gradient at a vertex as one factor for each vertex around it: factors times differences to its own
/// value, summed.
type Gradient = Vec<(VertexId, Point)>;

/// The row for linear fields with the gradient term added, scaled down where negative shares exceed
/// [`MAX_NEGATIVE`].
fn with_gradient_term(
    points: &[Point],
    linear: &[(VertexId, f64)],
    gradients: &[&Gradient],
) -> Vec<(VertexId, f64)> {
    let place = [0, 1, 2].map(|k| linear.iter().map(|&(v, share)| share * points[v.index()][k]).sum::<f64>());
    let mut term: Vec<(VertexId, f64)> = Vec::new();
    for (&(corner, share), gradient) in linear.iter().zip(gradients) {
        let half = sub(place, points[corner.index()]).map(|x| 0.5 * share * x);
        let parts = gradient.iter().map(|&(v, by)| (v, dot(half, by)));
        term.extend(parts.clone());
        term.push((corner, -parts.map(|part| part.1).sum::<f64>()));
    }
    let with = |part: f64| {
        let scaled = term.iter().map(|&(v, share)| (v, part * share));
        let mut row = linear.iter().copied().chain(scaled).collect();
        merge_parts(&mut row);
        row
    };
    let row = with(1.0);
    let negative: f64 = row.iter().map(|&(_, share)| (-share).max(0.0)).sum();
    if negative > MAX_NEGATIVE { with(MAX_NEGATIVE / negative) } else { row }
}

/// The tets of a mesh near some of its vertices: all that touch one of these vertices or a neighbour of one.
struct Neighborhood<'a> {
    points: &'a [Point],
    tets: Vec<[VertexId; 4]>,
    /// For each tet, the tets across the facets opposite its corners; none where the facet is a wall.
    beside: Vec<[MaybeId<TetId>; 4]>,
    /// For each vertex of the mesh, its id among the vertices of the tets.
    place: Vec<MaybeId<VertexId>>,
    /// The tets at each vertex.
    at: Csr<u32>,
}

impl<'a> Neighborhood<'a> {
    fn new(mesh: &'a Mesh, rows: &Rows<VertexId>) -> Self {
        let mut is_near = vec![false; mesh.points.len()];
        rows.iter().flat_map(|row| row.from).for_each(|v| is_near[v.index()] = true);
        let first = is_near.clone();
        for (_, tet) in mesh.cells.tets().filter(|(_, tet)| tet.iter().any(|v| first[v.index()])) {
            tet.iter().for_each(|v| is_near[v.index()] = true);
        }
        let labels = mesh.regions();
        let near = mesh.cells.tets().filter(|(_, tet)| tet.iter().any(|v| is_near[v.index()]));
        let (tets, regions): (Vec<_>, Vec<i32>) =
            near.map(|(cell, tet)| (tet, labels.as_ref().map_or(0, |l| l.ids[cell.index()]))).unzip();
        let triangles: Vec<[VertexId; 3]> = mesh
            .cells
            .iter()
            .filter(|(_, kind, v)| *kind == CellKind::TRIANGLE && v.iter().any(|v| is_near[v.index()]))
            .map(|(_, _, v)| [v[0], v[1], v[2]])
            .collect();
        let mut beside = vec![[MaybeId::NONE; 4]; tets.len()];
        for_each_tet_facet(&tets, &triangles, |facet| {
            if let [(a, i), (b, j)] = *facet.tets
                && !facet.is_wall(&regions)
            {
                beside[a.index()][i] = b.into();
                beside[b.index()][j] = a.into();
            }
        });
        let mut place = vec![MaybeId::NONE; mesh.points.len()];
        let mut n_places = 0;
        let mut of_corners: Vec<[VertexId; 4]> = Vec::with_capacity(tets.len());
        for tet in &tets {
            of_corners.push(tet.map(|v| {
                place[v.index()].get_or_insert_with(|| {
                    n_places += 1;
                    VertexId(n_places - 1)
                })
            }));
        }
        let at = Csr::from_pairs(n_places as usize, || {
            (0..).zip(&of_corners).flat_map(|(t, tet)| tet.map(|v| (v.index(), t)))
        });
        Self { points: &mesh.points, tets, beside, place, at }
    }

    fn at(&self, vertex: VertexId) -> &[u32] {
        self.place[vertex.index()].get().map_or(&[][..], |place| self.at.list(place.index()))
    }

    /// A tet with all these corners, at least one of which is on no wall; `None` if there is none.
    fn host(&self, corners: &[VertexId]) -> Option<u32> {
        let is_free = |v: &VertexId| {
            let is_open = |&t: &u32| {
                let facets = self.tets[t as usize].iter().zip(&self.beside[t as usize]);
                facets.into_iter().all(|(opposite, beside)| opposite == v || beside.is_some())
            };
            self.at(*v).iter().all(is_open)
        };
        if corners.len() < 2 || !corners.iter().any(is_free) {
            return None;
        }
        let holds = |t: &&u32| corners.iter().all(|v| self.tets[**t as usize].contains(v));
        self.at(corners[0]).iter().find(holds).copied()
    }

    /// The tets at `vertices` that are connected to those in `start` without crossing a wall, in ascending
    /// order; `start` are tets at these vertices, too.
    fn side(&self, vertices: &[VertexId], start: &[u32]) -> Vec<u32> {
        let mut all: Vec<u32> = vertices.iter().flat_map(|&v| self.at(v)).copied().collect();
        all.sort_unstable();
        all.dedup();
        let mut is_found = vec![false; all.len()];
        let mut open = Vec::with_capacity(all.len());
        let mut find = |tet: u32, open: &mut Vec<u32>| {
            if let Ok(place) = all.binary_search(&tet)
                && !std::mem::replace(&mut is_found[place], true)
            {
                open.push(tet);
            }
        };
        start.iter().for_each(|&tet| find(tet, &mut open));
        while let Some(tet) = open.pop() {
            let beside = self.beside[tet as usize].iter().filter_map(|other| other.get());
            beside.for_each(|other| find(other.0, &mut open));
        }
        let mut found = is_found.into_iter();
        all.retain(|_| found.next() == Some(true));
        all
    }

    fn vertices(&self, tets: &[u32]) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = tets.iter().flat_map(|&t| self.tets[t as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The gradient at a corner of the quadratic that best fits two rings of vertices; `None` where these do
    /// not determine it.
    fn gradient(&self, corner: VertexId, side: &[u32]) -> Option<Gradient> {
        let mut ring = self.vertices(&self.side(&self.vertices(side), side));
        ring.retain(|&v| v != corner);
        let offsets: Vec<Point> =
            ring.iter().map(|v| sub(self.points[v.index()], self.points[corner.index()])).collect();
        let fit = fit(&offsets)?;
        Some(ring.into_iter().zip(fit).collect())
    }
}

/// The nine terms of a quadratic that is 0 at the origin.
const N: usize = 9;

fn terms([x, y, z]: Point) -> [f64; N] {
    [x, y, z, x * x, y * y, z * z, x * y, y * z, z * x]
}

/// For each place, the factor of its value in the gradient at the origin of the quadratic that is 0 there and
/// fits all values best. The weights of the fit fall with the square of the distance. `None` where the places
/// do not determine it.
fn fit(offsets: &[Point]) -> Option<Vec<Point>> {
    let squared = offsets.iter().map(|&d| dot(d, d)).sum::<f64>() / offsets.len() as f64;
    let length = squared.sqrt();
    let weighted: Vec<([f64; N], f64)> =
        offsets.iter().map(|&d| (terms(d.map(|x| x / length)), squared / dot(d, d))).collect();
    let mut matrix = [[0.0; N]; N];
    for (terms, weight) in &weighted {
        for (row, a) in matrix.iter_mut().zip(terms) {
            row.iter_mut().zip(terms).for_each(|(entry, b)| *entry += weight * a * b);
        }
    }
    let factor = cholesky(&matrix)?;
    let inverse = [0, 1, 2].map(|k| solve(&factor, k));
    let of_place = |(terms, weight): &([f64; N], f64)| {
        inverse.map(|row| weight / length * row.iter().zip(terms).map(|(a, b)| a * b).sum::<f64>())
    };
    Some(weighted.iter().map(of_place).collect())
}

/// The lower Cholesky factor of a symmetric matrix; `None` if it is singular, nearly so, or contains NaN.
fn cholesky(matrix: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut factor = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            let rest = matrix[i][j] - known;
            if i != j {
                factor[i][j] = rest / factor[j][j];
            } else if rest > MIN_INDEPENDENT * matrix[i][i] {
                factor[i][i] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(factor)
}

/// Column `k` of the inverse of the matrix with this Cholesky factor.
fn solve(factor: &[[f64; N]; N], k: usize) -> [f64; N] {
    let mut x = [0.0; N];
    x[k] = 1.0;
    for i in 0..N {
        let known: f64 = (0..i).map(|j| factor[i][j] * x[j]).sum();
        x[i] = (x[i] - known) / factor[i][i];
    }
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| factor[j][i] * x[j]).sum();
        x[i] = (x[i] - known) / factor[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Field;
    use crate::mesh::history::{History, Origins, Row};
    use crate::mesh::shapes::box_grid;

    fn value([x, y, z]: Point) -> f64 {
        1.0 + x - 2.0 * y + 3.0 * z + x * x - 0.5 * y * y + 0.25 * z * z + x * y - 2.0 * y * z + 0.3 * z * x
    }

    /// For each tet of a mesh, the row of a place in it.
    fn one_a_tet(mesh: &Mesh) -> Rows<VertexId> {
        let mut rows = Rows::new();
        for (place, (_, tet)) in mesh.cells.tets().enumerate() {
            let shares = [0.1, 0.2, 0.3, 0.4];
            let parts: Vec<_> = tet.into_iter().zip(shares).collect();
            rows.push(VertexId::new(place), &parts, tet[3]);
        }
        rows
    }

    fn at(mesh: &Mesh, row: &Row<'_, VertexId>, of: impl Fn(Point) -> f64) -> f64 {
        row.from.iter().zip(row.shares).map(|(v, share)| share * of(mesh.points[v.index()])).sum()
    }

    fn compare(mesh: &Mesh, value: impl Fn(Point) -> f64) -> usize {
        let linear = one_a_tet(mesh);
        let rows = quadratic_rows(mesh, &linear, &Threads::single());
        for (&id, row) in rows.ids().iter().zip(rows.iter()) {
            let of = linear.of(id).expect("the row that it was made of");
            let place = [0, 1, 2].map(|k| at(mesh, &of, |p| p[k]));
            let (found, expected) = (at(mesh, &row, &value), value(place));
            assert!((found - expected).abs() < 1e-11, "{found}, expected {expected}, at {place:?}");
        }
        rows.len()
    }

    fn shaken(n: usize) -> Mesh {
        let mut mesh = box_grid([n; 3], [[-1.0; 3], [1.0; 3]]);
        for (i, p) in mesh.points.iter_mut().enumerate() {
            let shift = |k: usize| 0.1 / n as f64 * ((7 * i + 3 * k) as f64).sin();
            *p = [0, 1, 2].map(|k| p[k] + shift(k));
        }
        mesh
    }

    #[test]
    fn quadratic_fields_are_exact_and_tets_on_walls_alone_are_left_out() {
        let mesh = shaken(6);
        let n_rows = compare(&mesh, value);
        let on_wall: Vec<bool> = box_grid([6; 3], [[-1.0; 3], [1.0; 3]])
            .points
            .iter()
            .map(|p| p.iter().any(|x| (x.abs() - 1.0).abs() < 1e-9))
            .collect();
        let expected = mesh.cells.tets().filter(|(_, tet)| !tet.iter().all(|v| on_wall[v.index()])).count();
        assert!(expected > 1000);
        assert_eq!(n_rows, expected);
    }

    #[test]
    fn a_field_may_have_a_kink_between_regions() {
        let mut mesh = shaken(8);
        let grid = box_grid([8; 3], [[-1.0; 3], [1.0; 3]]);
        for (p, flat) in mesh.points.iter_mut().zip(&grid.points) {
            if flat[0].abs() < 1e-9 {
                p[0] = 0.0;
            }
        }
        let mut regions = vec![0; mesh.cells.len()];
        for (cell, tet) in grid.cells.tets() {
            let x: f64 = tet.iter().map(|v| grid.points[v.index()][0]).sum();
            regions[cell.index()] = if x < 0.0 { 1 } else { 2 };
        }
        mesh.set_cell_field(Field::scalars("region", regions));
        assert!(
            compare(&mesh, |p| if p[0] < 0.0 { value(p) } else { value(p) + 5.0 * p[0] - p[0] * p[0] })
                > 2000
        );
    }

    #[test]
    fn few_vertices_have_no_row() {
        assert_eq!(compare(&box_grid([1; 3], [[0.0; 3], [1.0; 3]]), value), 0);
    }

    #[test]
    fn values_stay_between_those_around() {
        let mesh = shaken(6);
        let mut history = History::identity(mesh.points.len(), mesh.cells.len());
        let linear = one_a_tet(&mesh);
        let rows = quadratic_rows(&mesh, &linear, &Threads::single());
        let kept = vec![MaybeId::NONE; linear.len()];
        let origins = Origins::new(mesh.points.len(), kept, linear).unwrap();
        history.vertices = origins.with_quadratic(rows).unwrap();
        let step: Vec<f64> =
            mesh.points.iter().map(|p| if p[0] + 0.3 * p[1] < 0.0 { 0.0 } else { 1.0 }).collect();
        let carried = history.transfer_points(&Field::scalars("step", step)).unwrap();
        let carried = carried.values.to_f64().unwrap();
        assert!(carried.iter().all(|x| (0.0..=1.0).contains(x)));
        assert!(carried.iter().filter(|x| **x == 0.0).count() > 100);
    }
}
