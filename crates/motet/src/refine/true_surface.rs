//! Puts new boundary points on the true surface, as far as no tet inverts.

use super::forest::{Extracted, Forest};
use crate::base::{Point, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::tet::FACETS;
use crate::geometry::vector::{add, distance, scale, sub};
use crate::mesh::BAD_EAS;
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::spatial::NearestTriangle;

/// A point moves at most this fraction of the length of its edge: an arc with this ratio of height to chord
/// spans about two thirds of a half circle.
const MAX_DISPLACEMENT: f64 = 0.3;
/// An edge counts as an edge of the surface if both ends lie within this fraction of its length from the
/// surface.
const END_TOLERANCE: f64 = 0.05;
/// A tet is spoilt if it becomes bad and keeps less than this fraction of its EAS.
const MIN_EAS_RATIO: f64 = 0.5;
/// How often a displacement is halved before the point is left where it was.
const HALVINGS: usize = 3;

/// The result of putting points on a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OnSurface {
    /// Number of points put on the surface.
    pub n_moved: usize,
    /// Number of points moved only part of the way, or not at all, because a tet would have been spoilt.
    pub n_short: usize,
    /// Length of the longest displacement, in the unit of coordinates.
    pub farthest: f64,
}

/// Returns new coordinates for all points of the mesh, and a summary.
pub(super) fn put_on_surface(
    now: &Extracted,
    forest: &Forest,
    surface: &NearestTriangle,
) -> (Vec<Point>, OnSurface) {
    let mesh = &now.mesh;
    let displacements = displacements(now, forest, surface);
    let mut shares: Vec<f64> = displacements.iter().map(|d| if d.is_some() { 1.0 } else { 0.0 }).collect();
    let place = |v: VertexId, shares: &[f64]| match displacements[v.index()] {
        Some(displacement) => add(mesh.points[v.index()], scale(displacement, shares[v.index()])),
        None => mesh.points[v.index()],
    };
    let moving: Vec<&[VertexId; 4]> =
        mesh.tets.iter().filter(|tet| tet.iter().any(|v| displacements[v.index()].is_some())).collect();
    for round in 0.. {
        let is_spoilt = |tet: &&&[VertexId; 4]| {
            let (was, is) = (eas(tet.map(|v| mesh.points[v.index()])), eas(tet.map(|v| place(v, &shares))));
            // The sign of an EAS is that of the volume.
            let (was, is) = (was.abs(), is * was.signum());
            is <= 0.0 || is < MIN_EAS_RATIO * was && is < BAD_EAS
        };
        let spoilt: Vec<VertexId> = moving.iter().filter(is_spoilt).flat_map(|tet| **tet).collect();
        if !spoilt.iter().any(|v| shares[v.index()] > 0.0) {
            break;
        }
        let mut vertices = spoilt;
        vertices.sort_unstable();
        vertices.dedup();
        let factor = if round < HALVINGS { 0.5 } else { 0.0 };
        vertices.iter().for_each(|v| shares[v.index()] *= factor);
    }
    let moved = || (0..displacements.len()).filter_map(|v| displacements[v].map(|d| (shares[v], d)));
    let done = OnSurface {
        n_moved: moved().filter(|(share, _)| *share == 1.0).count(),
        n_short: moved().filter(|(share, _)| *share < 1.0).count(),
        farthest: moved().map(|(share, d)| share * distance(d, [0.0; 3])).fold(0.0, f64::max),
    };
    let points = (0..mesh.points.len()).map(|v| place(VertexId::new(v), &shares)).collect();
    (points, done)
}

/// For each boundary point that a division made on an edge of the surface, the vector to the surface; `None`
/// for all other points, and for points already on it.
fn displacements(now: &Extracted, forest: &Forest, surface: &NearestTriangle) -> Vec<Option<Point>> {
    let mesh = &now.mesh;
    let mut is_boundary = vec![false; mesh.points.len()];
    for_each_tet_facet(&mesh.tets, &[], |sharing| {
        if let &[(tet, facet)] = sharing.tets {
            FACETS[facet].iter().for_each(|&k| is_boundary[mesh.tets[tet.index()][k].index()] = true);
        }
    });
    let numbers = now.numbers(forest.reference.len());
    let displacement = |v: usize| {
        let origin = now.vertices[v].index().checked_sub(forest.n_first_vertices)?;
        let [p, q] = forest.edges[forest.origin[origin].index()].ends.map(|end| numbers[end.index()].get());
        let ([p, q], point) = ([p?, q?].map(|end| mesh.points[end.index()]), mesh.points[v]);
        let length = distance(p, q);
        let near = |p: Point, part: f64| surface.closest_within(p, part * length).map(|found| found.point);
        let found = near(point, MAX_DISPLACEMENT)?;
        (found != point && near(p, END_TOLERANCE).is_some() && near(q, END_TOLERANCE).is_some())
            .then(|| sub(found, point))
    };
    (0..mesh.points.len()).map(|v| if is_boundary[v] { displacement(v) } else { None }).collect()
}
