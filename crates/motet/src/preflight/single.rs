//! Triangles that are degenerate by themselves, and duplicates.

use super::fault::{Fault, FaultKind};
use super::surfaces::Surfaces;
use crate::base::{Csr, Threads, VertexId, sorted_ids};
use crate::geometry::predicates::collinear;
use crate::geometry::vector::in_range;

/// Whether a triangle is sound by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// It has three distinct corners, and area.
    Sound,
    /// A corner is not finite.
    NotFinite,
    /// It names a vertex twice.
    Repeated,
    /// The corners of the triangle lie on a line.
    Flat,
}

/// The shape of each triangle.
pub(super) fn shapes(surfaces: &Surfaces, threads: &Threads) -> Vec<Shape> {
    threads.map(surfaces.triangles.len(), |t| {
        let [a, b, c] = surfaces.triangles[t];
        let corners = surfaces.corners(t as u32);
        match () {
            () if a == b || b == c || c == a => Shape::Repeated,
            () if !corners.iter().all(|&p| in_range(p)) => Shape::NotFinite,
            () if collinear(corners[0], corners[1], corners[2]) => Shape::Flat,
            () => Shape::Sound,
        }
    })
}

/// The duplicates among triangles of three distinct vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Duplicates {
    /// For each triangle, the first one of its surface with the same vertices; a triangle that names a vertex
    /// twice is its own first.
    pub(super) first_in_surface: Vec<u32>,
    /// For each triangle, the first one of all surfaces with the same vertices.
    pub(super) first_in_all: Vec<u32>,
    /// Which triangles remain without duplicates in one surface: two that face opposite sides enclose nothing
    /// and cancel, and of those that face the same side one remains. `false` for triangles that name a vertex
    /// twice.
    pub(super) remains: Vec<bool>,
}

impl Duplicates {
    pub(super) fn new(surfaces: &Surfaces) -> Self {
        let mut keyed: Vec<([VertexId; 3], u32, u32)> = surfaces
            .ids()
            .map(|t| (sorted_ids(surfaces.triangles[t as usize]), surfaces.surface(t), t))
            .filter(|([a, b, c], ..)| a != b && b != c)
            .collect();
        keyed.sort_unstable();
        let mut duplicates = Self {
            first_in_surface: surfaces.ids().collect(),
            first_in_all: surfaces.ids().collect(),
            remains: vec![false; surfaces.triangles.len()],
        };
        for same in keyed.chunk_by(|x, y| x.0 == y.0) {
            let first = same.iter().map(|&(.., t)| t).min().unwrap_or(0);
            same.iter().for_each(|&(.., t)| duplicates.first_in_all[t as usize] = first);
            for of_one in same.chunk_by(|x, y| x.1 == y.1) {
                of_one.iter().for_each(|&(.., t)| duplicates.first_in_surface[t as usize] = of_one[0].2);
                if let Some(t) = majority_first(surfaces, of_one.iter().map(|&(.., t)| t)) {
                    duplicates.remains[t as usize] = true;
                }
            }
        }
        duplicates
    }
}

/// Of triangles with the same vertices, the first that faces the side of the majority; `None` if as many face
/// either side.
fn majority_first(surfaces: &Surfaces, same: impl Iterator<Item = u32> + Clone) -> Option<u32> {
    let is_rising = |t: u32| {
        let [a, b, c] = surfaces.triangles[t as usize];
        // Rotating the corners does not change the number of rising steps: one, or two.
        [a < b, b < c, c < a].iter().filter(|rises| **rises).count() == 2
    };
    let (n, n_rising) = (same.clone().count(), same.clone().filter(|&t| is_rising(t)).count());
    let mut of_more = same.filter(|&t| is_rising(t) == (2 * n_rising > n));
    if 2 * n_rising == n { None } else { of_more.next() }
}

/// The faults of single triangles: points that are not finite, triangles without area, duplicates, and facets
/// that surfaces share.
pub(super) fn faults(surfaces: &Surfaces, shapes: &[Shape], duplicates: &Duplicates) -> Vec<Fault> {
    let mut faults = not_finite(surfaces);
    for (t, &shape) in surfaces.ids().zip(shapes) {
        let mut record = |kind, is_fatal, triangles| {
            let vertices = &surfaces.triangles[t as usize];
            let surface = surfaces.surface(t);
            faults.push(Fault::new(kind, is_fatal, surface, triangles, vertices, surfaces.points));
        };
        match shape {
            Shape::Repeated => record(FaultKind::RepeatedVertex, true, vec![t]),
            Shape::Flat => record(FaultKind::ZeroArea, true, vec![t]),
            Shape::Sound | Shape::NotFinite => {}
        }
        let (own, first) = (duplicates.first_in_surface[t as usize], duplicates.first_in_all[t as usize]);
        if own != t {
            record(FaultKind::Duplicate, true, vec![own, t]);
        } else if first != t {
            record(FaultKind::SharedFacet, false, vec![first, t]);
        }
    }
    faults
}

/// One fault for each vertex, with its triangles.
fn not_finite(surfaces: &Surfaces) -> Vec<Fault> {
    let is_bad = |v: &VertexId| !in_range(surfaces.points[v.index()]);
    let vertices: Vec<VertexId> = (0..surfaces.points.len()).map(VertexId::new).filter(is_bad).collect();
    let place = |v: &VertexId| vertices.binary_search(v).ok();
    let triangles = Csr::from_pairs(vertices.len(), || {
        surfaces.ids().flat_map(|t| {
            surfaces.triangles[t as usize].iter().filter_map(place).map(move |place| (place, t))
        })
    });
    let mut faults = Vec::new();
    for (v, around) in vertices.iter().zip(triangles.iter()).filter(|(_, around)| !around.is_empty()) {
        let mut around = around.to_vec();
        around.dedup();
        let (kind, surface) = (FaultKind::NonFinitePoint, surfaces.surface(around[0]));
        faults.push(Fault::new(kind, true, surface, around, &[*v], surfaces.points));
    }
    faults
}
