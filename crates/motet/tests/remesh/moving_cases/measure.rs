//! Quantities that must not change, or not get worse, while a mesh is moved and repaired.

use std::collections::BTreeMap;

use motet::base::{Point, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet;
use motet::geometry::tet::FACETS;
use motet::geometry::triangle::area;
use motet::geometry::vector::distance;
use motet::mesh::TetMesh;
use motet::mesh::tet_facets::tet_neighbors;

/// The EAS below which a tet is bad.
pub const BAD: f64 = 0.2;

/// The quality of the tets of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Quality {
    pub bad: usize,
    pub inverted: usize,
    pub worst: f64,
}

pub fn quality(mesh: &TetMesh) -> Quality {
    let mut quality = Quality { bad: 0, inverted: 0, worst: f64::INFINITY };
    for tet in &mesh.tets {
        let eas = eas(tet.map(|v| mesh.points[v.index()]));
        quality.bad += usize::from(eas < BAD);
        quality.inverted += usize::from(eas <= 0.0);
        quality.worst = quality.worst.min(eas);
    }
    quality
}

/// The volume of each region.
pub fn volumes(mesh: &TetMesh) -> BTreeMap<i32, f64> {
    let mut volumes = BTreeMap::new();
    for (vertices, &region) in mesh.tets.iter().zip(&mesh.regions) {
        *volumes.entry(region).or_default() += tet::volume(vertices.map(|v| mesh.points[v.index()]));
    }
    volumes
}

/// The number and the total area of the triangles of each patch.
pub fn patches(mesh: &TetMesh) -> BTreeMap<i32, (usize, f64)> {
    let mut patches: BTreeMap<i32, (usize, f64)> = BTreeMap::new();
    for (vertices, &patch) in mesh.triangles.iter().zip(&mesh.patches) {
        let entry = patches.entry(patch).or_default();
        *entry = (entry.0 + 1, entry.1 + area(vertices.map(|v| mesh.points[v.index()])));
    }
    patches
}

/// The facets of one tet only, as the sorted bits of their points: equal for equal surfaces.
pub fn boundary(mesh: &TetMesh) -> Vec<[[u64; 3]; 3]> {
    let neighbors = tet_neighbors(&mesh.tets);
    let mut facets = Vec::new();
    for (tet, behind) in mesh.tets.iter().zip(&neighbors) {
        for i in (0..4).filter(|&i| behind[i].is_none()) {
            let mut facet = FACETS[i].map(|place| mesh.points[tet[place].index()].map(f64::to_bits));
            let first = (0..3).min_by_key(|&i| facet[i]).unwrap_or_default();
            facet.rotate_left(first);
            facets.push(facet);
        }
    }
    facets.sort_unstable();
    facets
}

/// The labelled triangles, with their patches and the bits of their points, in the order of the mesh.
pub fn labelled(mesh: &TetMesh) -> Vec<(i32, [[u64; 3]; 3])> {
    let bits = |v: VertexId| mesh.points[v.index()].map(f64::to_bits);
    mesh.triangles.iter().zip(&mesh.patches).map(|(t, &patch)| (patch, t.map(bits))).collect()
}

/// The edges where patches meet, each with the patches that do.
pub fn features(mesh: &TetMesh) -> Vec<([VertexId; 2], Vec<i32>)> {
    let mut edges: BTreeMap<[VertexId; 2], Vec<i32>> = BTreeMap::new();
    for (&[a, b, c], &patch) in mesh.triangles.iter().zip(&mesh.patches) {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            edges.entry([a.min(b), a.max(b)]).or_default().push(patch);
        }
    }
    edges.values_mut().for_each(|patches| {
        patches.sort_unstable();
        patches.dedup();
    });
    edges.into_iter().filter(|(_, patches)| patches.len() > 1).collect()
}

/// The total length of feature edges, with vertices at the positions given by `place`.
pub fn length(features: &[([VertexId; 2], Vec<i32>)], place: impl Fn(VertexId) -> Point) -> f64 {
    features.iter().map(|([a, b], _)| distance(place(*a), place(*b))).sum()
}

/// The points of the vertices of triangles, each with a patch it lies on.
pub fn on_patches(mesh: &TetMesh) -> impl Iterator<Item = (Point, i32)> {
    let corners = mesh.triangles.iter().zip(&mesh.patches).flat_map(|(t, &p)| t.map(|v| (v, p)));
    corners.map(|(v, patch)| (mesh.points[v.index()], patch))
}

/// Asserts that every tet is positive, no facet has three tets, and every labelled triangle is a facet.
pub fn assert_valid(mesh: &TetMesh) {
    mesh.validate().expect("the arrays fit");
    let complex = motet::kernel::Complex::new(mesh).expect("tets join");
    complex.verify().expect("every invariant holds");
    motet::mesh::tet_facets::for_each_tet_facet(&mesh.tets, &mesh.triangles, |sharing| {
        assert!(sharing.triangles.is_empty() || !sharing.tets.is_empty(), "a triangle is no facet");
        assert!(sharing.triangles.len() < 2, "a triangle is there twice");
    });
}
