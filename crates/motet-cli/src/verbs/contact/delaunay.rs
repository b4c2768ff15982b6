//! Gaps by the Delaunay tets that span them, compared with the exact ones.

use std::time::Instant;

use motet::base::{BodyId, Point, Threads, VertexId};
use motet::contact::{Between, BetweenOptions, Contact, GapKind, GapTet, Gaps};
use motet::geometry::predicates::orient3d;
use motet::mesh::{CellKind, Cells, Field};
use motet::{Mesh, Result};
use serde::Serialize;

/// How accurate the gaps by Delaunay tets are, over all vertices that have a gap by both methods.
#[derive(Debug, Serialize)]
pub(crate) struct DelaunayAccuracy {
    pub(crate) gap_tets: usize,
    /// The least gap by Delaunay tets.
    pub(crate) least: Option<f64>,
    /// Number of vertices compared; the others have no gap by one of the two methods.
    pub(crate) compared: usize,
    /// The share of the compared vertices whose gaps agree to a relative 1e-12.
    pub(crate) exact: f64,
    pub(crate) largest_over: f64,
    pub(crate) largest_under: f64,
    pub(crate) seconds: f64,
}

/// The Delaunay tets that span the gaps of a contact, and the seconds that they took.
pub(crate) fn between(contact: &Contact, threads: &Threads) -> Result<(Between, f64)> {
    let begin = Instant::now();
    let ids = (0..contact.n_bodies()).map(BodyId::new);
    let bodies: Vec<_> = ids.clone().map(|body| contact.triangles(body).to_vec()).collect();
    let options =
        BetweenOptions { sides: ids.map(|body| contact.side(body)).collect(), ..BetweenOptions::default() };
    let between = Between::new(contact.points(), &bodies, &options, threads)?;
    Ok((between, begin.elapsed().as_secs_f64()))
}

/// Replaces the exact gaps by those of the tets. Also returns the error of each.
pub(crate) fn replace(
    gaps: &mut Gaps,
    between: &Between,
    seconds: f64,
    warn: Option<f64>,
) -> (DelaunayAccuracy, Vec<f64>) {
    let mut accuracy = DelaunayAccuracy {
        gap_tets: between.tets.len(),
        least: between.least.map(|least| least.distance),
        compared: 0,
        exact: 0.0,
        largest_over: 0.0,
        largest_under: 0.0,
        seconds,
    };
    let (mut errors, mut n_exact) = (Vec::new(), 0);
    for body in &mut gaps.bodies {
        for (i, v) in body.vertices.iter().enumerate() {
            let (exact, found) = (body.gap[i].abs(), between.gap[v.index()]);
            let error = found - exact;
            errors.push(error);
            if error.is_finite() {
                accuracy.compared += 1;
                n_exact += usize::from(error.abs() <= 1e-12 * exact);
                accuracy.largest_over = accuracy.largest_over.max(error);
                accuracy.largest_under = accuracy.largest_under.max(-error);
            }
            // No path through free space starts where a vertex must not be: there the exact depth stays.
            if found.is_finite() || body.gap[i] > 0.0 {
                body.gap[i] = found.copysign(body.gap[i]);
            }
            body.warning[i] = warn.is_some_and(|warn| body.gap[i] < warn);
        }
    }
    accuracy.exact = n_exact as f64 / accuracy.compared.max(1) as f64;
    (accuracy, errors)
}

/// The gap tets with four vertices as a mesh, and the number of the others, which are flat.
pub(crate) fn tets(contact: &Contact, between: &Between) -> (Mesh, usize) {
    let tets = || between.tets.iter().filter(|tet| tet.corners().is_some());
    let mut used: Vec<VertexId> = tets().filter_map(GapTet::corners).flatten().collect();
    used.sort_unstable();
    used.dedup();
    let points = used.iter().map(|v| contact.points()[v.index()]).collect();
    let mut cells = Cells::new();
    for mut vertices in tets().filter_map(GapTet::corners) {
        if is_turned(vertices.map(|v| contact.points()[v.index()])) {
            vertices.swap(2, 3);
        }
        let new = |v: VertexId| VertexId::new(used.binary_search(&v).unwrap_or_default());
        cells.push(CellKind::TETRA, vertices.map(new));
    }
    let mut mesh = Mesh::new(points, cells);
    let kind = |kind: GapKind| match kind {
        GapKind::TwoTwo => 22,
        GapKind::ThreeOne => 31,
        GapKind::TwoOneOne => 211,
        GapKind::Ones => 1111,
        _ => 0,
    };
    mesh.set_cell_field(Field::scalars("kind", tets().map(|tet| kind(tet.kind)).collect::<Vec<i32>>()));
    let distance = |d: f64| if d.is_finite() { d } else { f64::NAN };
    mesh.set_cell_field(Field::scalars(
        "distance",
        tets().map(|tet| distance(tet.distance)).collect::<Vec<f64>>(),
    ));
    let pairs = |i: usize| tets().map(|tet| tet.bodies[i].0 as i32 + 1).collect::<Vec<i32>>();
    mesh.set_cell_field(Field::scalars("body", pairs(0)));
    mesh.set_cell_field(Field::scalars("other_body", pairs(1)));
    let n_flat = between.tets.len() - mesh.cells.len();
    (mesh, n_flat)
}

/// Whether a tet has the wrong orientation.
fn is_turned([a, b, c, d]: [Point; 4]) -> bool {
    orient3d(a, b, c, d) < 0
}
