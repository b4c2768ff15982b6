//! What refinement has to preserve, compared with the first mesh: volumes, areas, matching facets, positions,
//! and the quality of tets.

use std::collections::{BTreeMap, BTreeSet};

use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::{eas, mean_ratio};
use motet::geometry::tet::volume;
use motet::geometry::triangle::area;
use motet::mesh::TetMesh;
use motet::mesh::tet_facets::for_each_tet_facet;
use motet::refine::Refinement;

/// The permitted relative difference of volumes and areas.
const TOLERANCE: f64 = 1e-13;

/// Tets with an EAS below this part of the first mesh's worst are counted.
pub(crate) const LEAST: f64 = 0.9;

/// A sum with the part lost by rounding (Neumaier 1974, *Rundungsfehleranalyse einiger Verfahren zur
/// Summation endlicher Summen*).
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - sum) + x } else { (x - sum) + self.sum };
        self.sum = sum;
    }

    fn value(self) -> f64 {
        self.sum + self.lost
    }
}

/// The volume of a mesh and of its parts.
#[derive(Clone, Debug, Default)]
struct Sizes {
    volume: f64,
    regions: BTreeMap<i32, f64>,
    patches: BTreeMap<i32, f64>,
    /// The area of all facets that belong to one tet only.
    boundary: f64,
    /// Facets of three tets or more.
    n_crowded: usize,
    /// Triangles that are not a facet of a tet.
    n_loose: usize,
}

fn by_label(of: impl Iterator<Item = (i32, f64)>) -> BTreeMap<i32, f64> {
    let mut sums: BTreeMap<i32, Sum> = BTreeMap::new();
    of.for_each(|(label, x)| sums.entry(label).or_default().add(x));
    sums.into_iter().map(|(label, sum)| (label, sum.value())).collect()
}

pub(crate) fn corners<const N: usize>(mesh: &TetMesh, vertices: [VertexId; N]) -> [Point; N] {
    vertices.map(|v| mesh.points[v.index()])
}

impl Sizes {
    fn of(mesh: &TetMesh) -> Self {
        let volumes = || mesh.tets.iter().map(|t| volume(corners(mesh, *t)).abs());
        let areas = mesh.triangles.iter().map(|t| area(corners(mesh, *t)));
        let (mut all, mut boundary) = (Sum::default(), Sum::default());
        volumes().for_each(|x| all.add(x));
        let (mut n_crowded, mut n_loose) = (0, 0);
        for_each_tet_facet(&mesh.tets, &mesh.triangles, |sharing| match *sharing.tets {
            [] => n_loose += sharing.triangles.len(),
            [(tet, i)] => {
                let [a, b, c] = motet::geometry::tet::FACETS[i].map(|k| mesh.tets[tet.index()][k]);
                boundary.add(area(corners(mesh, [a, b, c])));
            }
            [_, _] => {}
            _ => n_crowded += 1,
        });
        Self {
            volume: all.value(),
            regions: by_label(mesh.regions.iter().copied().zip(volumes())),
            patches: by_label(mesh.patches.iter().copied().zip(areas)),
            boundary: boundary.value(),
            n_crowded,
            n_loose,
        }
    }
}

/// The quality of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quality {
    pub(crate) worst: f64,
    pub(crate) median: f64,
    pub(crate) worst_ratio: f64,
    /// Number of tets below [`LEAST`] of a given worst EAS.
    pub(crate) n_below: usize,
}

impl Quality {
    fn of(mesh: &TetMesh, least: f64, threads: &Threads) -> Self {
        let all = |of: fn([Point; 4]) -> f64| {
            threads.map(mesh.tets.len(), |i| of(corners(mesh, mesh.tets[i])).abs())
        };
        let worst = |all: &[f64]| all.iter().copied().fold(f64::INFINITY, f64::min);
        let (mut shapes, middle) = (all(eas), mesh.tets.len() / 2);
        Self {
            worst: worst(&shapes),
            n_below: shapes.iter().filter(|x| **x < least).count(),
            worst_ratio: worst(&all(mean_ratio)),
            median: *shapes.select_nth_unstable_by(middle, f64::total_cmp).1,
        }
    }
}

/// The first mesh, with which a refined one is compared.
pub(crate) struct First {
    pub(crate) mesh: TetMesh,
    pub(crate) quality: Quality,
    sizes: Sizes,
}

/// The result of a comparison.
pub(crate) struct Kept {
    pub(crate) quality: Quality,
    /// Roots with tets below [`LEAST`] of the first mesh's worst EAS.
    pub(crate) roots: BTreeSet<u32>,
    /// Broken promises, in words.
    pub(crate) broken: Vec<String>,
}

impl First {
    pub(crate) fn new(mesh: TetMesh, threads: &Threads) -> Self {
        let (quality, sizes) = (Quality::of(&mesh, 0.0, threads), Sizes::of(&mesh));
        Self { mesh, quality, sizes }
    }

    /// Compares a refined mesh with the first one.
    pub(crate) fn compare(&self, refinement: &Refinement, threads: &Threads) -> Kept {
        let mesh = refinement.mesh();
        let least = LEAST * self.quality.worst;
        let mut kept = Kept {
            quality: Quality::of(mesh, least, threads),
            roots: BTreeSet::new(),
            broken: self.broken(mesh),
        };
        let mut n_reported = 0;
        for left in refinement.left(threads).iter().filter(|left| left.eas < least) {
            kept.roots.insert(left.root.0);
            n_reported += 1;
        }
        if n_reported != kept.quality.n_below {
            kept.broken.push(format!("{} tets are bad, {n_reported} are reported", kept.quality.n_below));
        }
        kept
    }

    fn broken(&self, mesh: &TetMesh) -> Vec<String> {
        let mut broken = self.sizes.broken(mesh);
        if !mesh.points.starts_with(&self.mesh.points) {
            broken.push("vertices of the first mesh moved".into());
        }
        broken
    }
}

/// Asserts that a mesh, possibly with other vertices, has the sizes of an earlier one.
pub(crate) fn fits(before: &TetMesh, mesh: &TetMesh) {
    let broken = Sizes::of(before).broken(mesh);
    assert!(broken.is_empty(), "{broken:?}");
}

impl Sizes {
    fn broken(&self, mesh: &TetMesh) -> Vec<String> {
        let (old, new) = (self, Self::of(mesh));
        let mut broken = Vec::new();
        if let Err(error) = mesh.validate() {
            broken.push(error.to_string());
        }
        if new.n_crowded != old.n_crowded || (old.n_loose == 0 && new.n_loose > 0) {
            broken.push(format!(
                "{} facets of three tets, {} triangles that are none",
                new.n_crowded, new.n_loose
            ));
        }
        let mut hold = |what: &str, before: f64, after: f64| {
            // This comparison fails for NaN.
            let is_same = ((after - before) / before).abs() <= TOLERANCE;
            if !(is_same || before == after) {
                broken.push(format!("{what} {before} became {after}, {:e} more", after / before - 1.0));
            }
        };
        hold("volume", old.volume, new.volume);
        hold("boundary", old.boundary, new.boundary);
        for (name, old, new) in
            [("region", &old.regions, &new.regions), ("patch", &old.patches, &new.patches)]
        {
            for label in old.keys().chain(new.keys()) {
                let size = |of: &BTreeMap<i32, f64>| of.get(label).copied().unwrap_or(0.0);
                hold(&format!("{name} {label}"), size(old), size(new));
            }
        }
        broken
    }
}
