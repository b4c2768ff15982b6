//! Shared by several tests: real meshes, random meshes, random numbers.

#![allow(dead_code, reason = "each test uses a part of it")]

pub(crate) mod adaptation;
pub(crate) mod cad;
pub(crate) mod criteria;
pub(crate) mod devices;
pub(crate) mod editor;
pub(crate) mod filling;
pub(crate) mod hard;
pub(crate) mod invariants;
pub(crate) mod prism;
pub(crate) mod random;
pub(crate) mod refined;
pub(crate) mod solid_angle;
pub(crate) mod wreck;

use std::collections::BTreeSet;
use std::path::PathBuf;

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::delaunay::Triangulation;
use motet::geometry::tet::centroid;
use motet::mesh::TetMesh;

/// Every tetrahedral mesh of the data folder, where it exists. The cross-checks read the same list.
pub(crate) fn data_meshes() -> Vec<(String, Mesh)> {
    let names = include_str!("../real_tet_meshes.txt").lines();
    let Some(folder) = data_folder() else { return Vec::new() };
    names.map(|name| (name.to_string(), motet::io::read(folder.join(name)).unwrap())).collect()
}

/// The data folder, where it exists; prints a note otherwise.
pub(crate) fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var("MOTET_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data").into());
    let folder = PathBuf::from(folder);
    if !folder.exists() {
        println!("skipped: no data in {}", folder.display());
        return None;
    }
    Some(folder)
}

/// An endless stream of random numbers (Steele, Lea and Flood 2014, *Fast splittable pseudorandom number
/// generators*).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Random points in a box, triangulated; two regions, 3 and 7, with a jagged interface, and some labelled
/// facets.
pub(crate) fn random_mesh(n: usize, seed: u64) -> TetMesh {
    let mut numbers = Numbers(seed);
    let mut points: Vec<Point> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f64)).collect();
    points.extend((0..n).map(|_| [(); 3].map(|()| numbers.unit())));
    let delaunay = Triangulation::new(&points, &Threads::single()).unwrap();
    let tets = delaunay.tets().to_vec();
    let corners = |t: &[VertexId; 4]| t.map(|v| points[v.index()]);
    let regions = tets.iter().map(|t| if centroid(corners(t))[0] < 0.5 { 3 } else { 7 }).collect();
    // Two of these tets may share a facet; a duplicate triangle would have to be held.
    let mut facets = BTreeSet::new();
    let triangles = tets.iter().step_by(29).map(|&[a, b, c, _]| [c, a, b]);
    let triangles: Vec<_> = triangles.filter(|&[a, b, c]| facets.insert(BTreeSet::from([a, b, c]))).collect();
    let patches = (0..triangles.len() as i32).map(|i| 1 + i % 3).collect();
    TetMesh { points, tets, regions, triangles, patches, ..TetMesh::default() }
}
