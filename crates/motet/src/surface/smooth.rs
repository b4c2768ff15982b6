//! Smooths a surface without shrinking it (Taubin 1995, *A signal processing approach to fair surface
//! design*).

use super::features::{Features, Kind};
use super::sheet::Sheet;
use crate::base::{Csr, Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, distance, scale, sub};

/// How far a pass first moves each vertex towards the mean of its neighbours, over its distance from it.
const TOWARDS: f64 = 0.5;
/// And then away from it. Waves of the surface pass unchanged whose eigenvalue is `1 / TOWARDS - 1 / AWAY`,
/// 0.11; shorter ones are damped, longer ones amplified by less than 0.1 % a pass.
const AWAY: f64 = 0.53;

/// The points of a surface after some passes of smoothing. A pass moves each vertex towards the mean of its
/// neighbours, the near ones with more weight, and then away from it, so that volumes stay. Vertices on rims,
/// borders of labels, creases of more than `feature_angle` degrees between triangles at least `least_height`
/// high, and edges with more than two triangles do not move.
///
/// # Errors
/// When a stop was requested.
///
/// Panics if a triangle names a point that does not exist.
pub fn smooth(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    labels: &[u32],
    passes: usize,
    [feature_angle, least_height]: [f64; 2],
    threads: &Threads,
) -> Result<Vec<Point>> {
    let sheet = Sheet::new(points.to_vec(), triangles.to_vec(), labels.to_vec());
    let features = Features::of(&sheet, feature_angle, least_height);
    let neighbours = neighbours(&sheet, &features);
    let mut smoothed = sheet.points;
    for pass in 0..passes {
        threads.watch().report_and_check("smoothing the surface", pass, passes)?;
        for step in [TOWARDS, -AWAY] {
            smoothed =
                threads.map(smoothed.len(), |v| match towards_mean(&smoothed, v, neighbours.list(v)) {
                    Some(way) => add(smoothed[v], scale(way, step)),
                    None => smoothed[v],
                });
        }
    }
    Ok(smoothed)
}

/// The neighbours of each vertex that moves, with their weights: the inverse of their distance at first.
fn neighbours(sheet: &Sheet, features: &Features) -> Csr<(VertexId, f64)> {
    let is_free = |v: VertexId| features.kind(v) == Kind::Free && !sheet.star(v).is_empty();
    let weight = |v: VertexId, u: VertexId| {
        let apart = distance(sheet.points[v.index()], sheet.points[u.index()]);
        (u, 1.0 / apart.max(f64::MIN_POSITIVE))
    };
    let of = |v: VertexId| match is_free(v) {
        true => sheet.neighbours(v).into_iter().map(|u| (v.index(), weight(v, u))).collect(),
        false => Vec::new(),
    };
    let pairs: Vec<(usize, (VertexId, f64))> =
        (0..sheet.points.len()).map(VertexId::new).flat_map(of).collect();
    Csr::from_pairs(sheet.points.len(), || pairs.iter().copied())
}

/// The way from a vertex to the mean of its neighbours; `None` where it does not move.
fn towards_mean(points: &[Point], v: usize, neighbours: &[(VertexId, f64)]) -> Option<Point> {
    let total: f64 = neighbours.iter().map(|(_, weight)| weight).sum();
    let part = |sum: Point, (u, weight): &(VertexId, f64)| {
        add(sum, scale(sub(points[u.index()], points[v]), weight / total))
    };
    (total > 0.0 && total.is_finite()).then(|| neighbours.iter().fold([0.0; 3], part))
}
