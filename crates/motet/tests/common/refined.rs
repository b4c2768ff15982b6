//! What holds of a refined mesh, and what is needed to see it.

use std::collections::HashMap;

use motet::base::{Point, TetId, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::{FACETS, centroid, volume};
use motet::geometry::triangle::area;
use motet::geometry::vector::distance;
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{TetMesh, TetPart};

pub(crate) fn corners(mesh: &TetMesh, tet: [VertexId; 4]) -> [Point; 4] {
    tet.map(|v| mesh.points[v.index()])
}

/// Sums exactly enough: pairs of halves.
pub(crate) fn sum(all: &[f64]) -> f64 {
    match all {
        [] => 0.0,
        [one] => *one,
        _ => sum(&all[..all.len() / 2]) + sum(&all[all.len() / 2..]),
    }
}

pub(crate) fn volume_of(mesh: &TetMesh, region: Option<i32>) -> f64 {
    let tets = mesh.tets.iter().zip(&mesh.regions).filter(|(_, r)| region.is_none_or(|region| **r == region));
    sum(&tets.map(|(t, _)| volume(corners(mesh, *t)).abs()).collect::<Vec<_>>())
}

pub(crate) fn areas(mesh: &TetMesh) -> HashMap<i32, f64> {
    let mut by_patch: HashMap<i32, Vec<f64>> = HashMap::new();
    for (t, patch) in mesh.triangles.iter().zip(&mesh.patches) {
        let area = area(t.map(|v| mesh.points[v.index()]));
        by_patch.entry(*patch).or_default().push(area);
    }
    by_patch.into_iter().map(|(patch, areas)| (patch, sum(&areas))).collect()
}

/// Facets by their vertices, rising, and by how many tets they are used.
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

pub(crate) fn boundary_area(mesh: &TetMesh) -> f64 {
    let boundary = facets(mesh).into_iter().filter(|(_, n)| *n == 1);
    sum(&boundary.map(|(t, _)| area(t.map(|v| mesh.points[v.index()]))).collect::<Vec<_>>())
}

/// Holds a refined mesh against the first one.
pub(crate) fn fits(first: &TetMesh, mesh: &TetMesh) {
    mesh.validate().unwrap();
    let uses = facets(mesh);
    assert!(uses.values().all(|&n| n <= 2), "no facet has three tets");
    // A facet of one tet inside would add to the area.
    let (before, after) = (boundary_area(first), boundary_area(mesh));
    assert!((after / before - 1.0).abs() < 1e-12, "boundary {before} became {after}");
    let mut regions = first.regions.clone();
    regions.sort_unstable();
    regions.dedup();
    for region in regions {
        let (before, after) = (volume_of(first, Some(region)), volume_of(mesh, Some(region)));
        assert!((after / before - 1.0).abs() < 1e-13, "region {region}: {before} became {after}");
    }
    let (before, after) = (areas(first), areas(mesh));
    assert_eq!(before.len(), after.len());
    assert!(before.iter().all(|(patch, area)| (after[patch] / area - 1.0).abs() < 1e-12));
    for triangle in &mesh.triangles {
        let mut key = *triangle;
        key.sort_unstable();
        assert!(uses.contains_key(&key), "a triangle is a facet");
    }
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
