//! Helpers to check refined meshes.

use std::collections::HashMap;

use super::invariants::corners;
use motet::base::{Point, TetId, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::{FACETS, centroid};
use motet::geometry::vector::distance;
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{TetMesh, TetPart};

/// Facets by their sorted vertices, with the number of tets that use them.
pub(crate) fn facets(mesh: &TetMesh) -> HashMap<[VertexId; 3], u32> {
    let mut uses = HashMap::new();
    for tet in &mesh.tets {
        for facet in FACETS {
            let mut key = facet.map(|i| tet[i]);
            key.sort_unstable();
            *uses.entry(key).or_default() += 1;
        }
    }
    uses
}

pub(crate) fn worst(mesh: &TetMesh, of: impl Fn([Point; 4]) -> f64) -> f64 {
    mesh.tets.iter().map(|t| of(corners(mesh, *t)).abs()).fold(f64::INFINITY, f64::min)
}

pub(crate) fn median_eas(mesh: &TetMesh) -> f64 {
    let mut all: Vec<f64> = mesh.tets.iter().map(|t| eas(corners(mesh, *t)).abs()).collect();
    let middle = all.len() / 2;
    *all.select_nth_unstable_by(middle, f64::total_cmp).1
}

pub(crate) fn ball_in_box() -> TetMesh {
    TetPart::of(&sphere_in_box(6, 2)).unwrap().mesh
}

/// The `n` tets nearest to a place.
pub(crate) fn nearest(mesh: &TetMesh, place: Point, n: usize) -> Vec<TetId> {
    let far = |i: &TetId| distance(centroid(corners(mesh, mesh.tets[i.index()])), place);
    let mut all: Vec<TetId> = (0..mesh.tets.len()).map(TetId::new).collect();
    all.sort_by(|a, b| far(a).total_cmp(&far(b)));
    all.truncate(n);
    all
}
