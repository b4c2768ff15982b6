//! What a surface is like: angles, edges, crossings, rims, area and volume.

use serde::Serialize;

use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::{angle_at, area};
use crate::mesh::{Spread, cone_volume, edge_lengths, open_edges};
use crate::preflight::{open_rims, own_crossings};

/// Measures of a surface, double points merged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Measured {
    /// Points that triangles use.
    pub points: usize,
    /// Triangles.
    pub triangles: usize,
    /// The least angles of the triangles, in degrees: at most 60 each.
    pub angles: Spread,
    /// The shortest, the median and the longest edge.
    pub edges: [f64; 3],
    /// Pairs of triangles that have more in common than the vertices and edges that they share.
    pub crossings: usize,
    /// Closed chains of open edges.
    pub rims: usize,
    /// Edges that triangles do not run along as often one way as the other.
    pub open_edges: usize,
    /// The area.
    pub area: f64,
    /// The volume enclosed, positive if triangles face outward; `None` where there are open edges.
    pub volume: Option<f64>,
}

impl Measured {
    /// Measures a surface.
    ///
    /// Panics if there is no triangle, or one names a point that does not exist.
    pub fn of(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Self {
        let corners = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
        let least = |t: [Point; 3]| (0..3).map(|k| angle_at(t, k)).fold(f64::INFINITY, f64::min).to_degrees();
        let mut angles = threads.map(triangles.len(), |t| least(corners(&triangles[t])));
        let open_edges = open_edges(triangles).len();
        let [rims, _] = open_rims(points, triangles);
        let mut used = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let origin = points[used[0].index()];
        let volume = || triangles.iter().map(|t| cone_volume(t.iter().copied(), points, origin)).sum();
        Self {
            points: used.len(),
            triangles: triangles.len(),
            angles: Spread::of_values(&mut angles, true).expect("there are triangles"),
            edges: edge_lengths(points, triangles.iter().copied()).unwrap_or_default(),
            crossings: own_crossings(points, triangles, threads).len(),
            rims: rims.len(),
            open_edges,
            area: triangles.iter().map(|t| area(corners(t))).sum(),
            volume: (open_edges == 0).then(volume),
        }
    }
}
