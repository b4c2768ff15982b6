//! Refinement: meshes that fit together, keep their shape over generations, and come back bit for bit.

mod common;

use std::collections::HashMap;

use common::{Numbers, random_mesh};
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::quality::{eas, mean_ratio};
use motet::geometry::tet::{FACETS, centroid, volume};
use motet::geometry::triangle::area;
use motet::geometry::vector::{add, distance};
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{TetMesh, TetPart};
use motet::refine::{Options, Refinement};

fn corners(mesh: &TetMesh, tet: [VertexId; 4]) -> [Point; 4] {
    tet.map(|v| mesh.points[v.index()])
}

/// Sums exactly enough: pairs of halves.
fn sum(all: &[f64]) -> f64 {
    match all {
        [] => 0.0,
        [one] => *one,
        _ => sum(&all[..all.len() / 2]) + sum(&all[all.len() / 2..]),
    }
}

fn volume_of(mesh: &TetMesh, region: Option<i32>) -> f64 {
    let tets = mesh.tets.iter().zip(&mesh.regions).filter(|(_, r)| region.is_none_or(|region| **r == region));
    sum(&tets.map(|(t, _)| volume(corners(mesh, *t)).abs()).collect::<Vec<_>>())
}

fn areas(mesh: &TetMesh) -> HashMap<i32, f64> {
    let mut by_patch: HashMap<i32, Vec<f64>> = HashMap::new();
    for (t, patch) in mesh.triangles.iter().zip(&mesh.patches) {
        let area = area(t.map(|v| mesh.points[v.index()]));
        by_patch.entry(*patch).or_default().push(area);
    }
    by_patch.into_iter().map(|(patch, areas)| (patch, sum(&areas))).collect()
}

/// Facets by their vertices, rising, and by how many tets they are used.
fn facets(mesh: &TetMesh) -> HashMap<[VertexId; 3], u32> {
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

fn boundary_area(mesh: &TetMesh) -> f64 {
    let boundary = facets(mesh).into_iter().filter(|(_, n)| *n == 1);
    sum(&boundary.map(|(t, _)| area(t.map(|v| mesh.points[v.index()]))).collect::<Vec<_>>())
}

/// Holds a refined mesh against the first one.
fn fits(first: &TetMesh, mesh: &TetMesh) {
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

fn worst(mesh: &TetMesh, of: impl Fn([Point; 4]) -> f64) -> f64 {
    mesh.tets.iter().map(|t| of(corners(mesh, *t)).abs()).fold(f64::INFINITY, f64::min)
}

fn median_eas(mesh: &TetMesh) -> f64 {
    let mut all: Vec<f64> = mesh.tets.iter().map(|t| eas(corners(mesh, *t)).abs()).collect();
    let middle = all.len() / 2;
    *all.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn ball_in_box() -> TetMesh {
    TetPart::of(&sphere_in_box(6, 2)).unwrap().mesh
}

/// The `n` tets nearest to a place.
fn nearest(mesh: &TetMesh, place: Point, n: usize) -> Vec<TetId> {
    let far = |i: &TetId| distance(centroid(corners(mesh, mesh.tets[i.index()])), place);
    let mut all: Vec<TetId> = (0..mesh.tets.len()).map(TetId::new).collect();
    all.sort_by(|a, b| far(a).total_cmp(&far(b)));
    all.truncate(n);
    all
}

#[test]
fn eight_generations_about_a_point_keep_the_shape() {
    let threads = Threads::single();
    for (name, first) in [("ball in a box", ball_in_box()), ("random", random_mesh(300, 5))] {
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        let w = worst(&first, eas);
        let place = add(first.points[27], [0.01, 0.02, 0.03]);
        let mut n = first.tets.len();
        for generation in 1..=8 {
            let marked = nearest(refinement.mesh(), place, 300);
            let summary = refinement.refine(&marked, &threads).unwrap();
            let mesh = refinement.mesh();
            println!(
                "{name} {generation}: {summary:?} worst {:.3} mean ratio {:.3} median {:.3}",
                worst(mesh, eas) / w,
                worst(mesh, mean_ratio) / worst(&first, mean_ratio),
                median_eas(mesh)
            );
            assert!(summary.n_tets > n + 300);
            n = summary.n_tets;
        }
        assert!(refinement.generations().max() >= Some(4));
        fits(&first, refinement.mesh());
        assert!(worst(refinement.mesh(), eas) >= 0.9 * w);
    }
}

#[test]
fn coarsening_brings_the_first_mesh_back_bit_for_bit() {
    let threads = Threads::single();
    for first in [ball_in_box(), random_mesh(300, 8)] {
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        assert_eq!(refinement.mesh(), &first);
        for _ in 0..5 {
            let marked = nearest(refinement.mesh(), first.points[27], 200);
            refinement.refine(&marked, &threads).unwrap();
        }
        let deepest = refinement.generations().max().unwrap();
        assert!(deepest >= 3);
        for step in 0..=deepest {
            assert!(refinement.mesh() != &first, "not before step {step}");
            let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
            refinement.coarsen(&all, &threads).unwrap();
            fits(&first, refinement.mesh());
            if refinement.mesh() == &first {
                break;
            }
        }
        assert_eq!(refinement.mesh(), &first);
    }
}

#[test]
fn the_mesh_follows_from_what_is_divided_whatever_came_before() {
    let threads = Threads::single();
    let first = random_mesh(300, 11);
    let new = || Refinement::new(&first, Options::default(), &threads).unwrap();
    let (mut straight, mut astray) = (new(), new());
    let there = nearest(&first, [0.2; 3], 60);
    straight.refine(&there, &threads).unwrap();
    // Elsewhere first, then there, and elsewhere taken back.
    astray.refine(&nearest(&first, [0.9; 3], 60), &threads).unwrap();
    let centres: Vec<Point> =
        there.iter().map(|t| centroid(corners(&first, first.tets[t.index()]))).collect();
    let roots: Vec<TetId> = astray.roots().collect();
    let marked: Vec<TetId> =
        (0..roots.len()).filter(|&i| there.contains(&roots[i])).map(TetId::new).collect();
    assert_eq!(centres.len(), there.len());
    astray.refine(&marked, &threads).unwrap();
    let roots: Vec<TetId> = astray.roots().collect();
    let back: Vec<TetId> = (0..roots.len()).filter(|&i| !there.contains(&roots[i])).map(TetId::new).collect();
    astray.coarsen(&back, &threads).unwrap();
    assert_eq!(astray.mesh(), straight.mesh());
}

#[test]
fn points_that_moved_stay_where_they_are() {
    let threads = Threads::single();
    let first = ball_in_box();
    let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
    let place = first.points[27];
    refinement.refine(&nearest(&first, place, 200), &threads).unwrap();
    let sheared = |p: &Point| [p[0] + 0.2 * p[1], p[1] - 0.1 * p[2], 1.1 * p[2]];
    let moved: Vec<Point> = refinement.mesh().points.iter().map(sheared).collect();
    refinement.set_points(&moved).unwrap();
    refinement.refine(&nearest(refinement.mesh(), sheared(&place), 200), &threads).unwrap();
    // A shear takes middles to middles.
    let mut straight = Refinement::new(&first, Options::default(), &threads).unwrap();
    straight.refine(&nearest(&first, place, 200), &threads).unwrap();
    let mut again = first.clone();
    again.points = first.points.iter().map(sheared).collect();
    fits(&again, refinement.mesh());
    let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
    refinement.coarsen(&all, &threads).unwrap();
    let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
    refinement.coarsen(&all, &threads).unwrap();
    assert_eq!(refinement.mesh(), &again);
    assert!(refinement.set_points(&moved).is_err());
    assert!(refinement.refine(&[TetId(1 << 30)], &threads).is_err());
}

#[test]
fn the_order_of_marks_and_threads_change_nothing() {
    let (one, three) = (Threads::single(), Threads::new(3).unwrap());
    let first = random_mesh(400, 9);
    let mut numbers = Numbers(3);
    let mut a = Refinement::new(&first, Options::default(), &one).unwrap();
    let mut b = Refinement::new(&first, Options::default(), &three).unwrap();
    for _ in 0..3 {
        let mut marked: Vec<TetId> =
            (0..a.mesh().tets.len() as u32).map(TetId).filter(|_| numbers.unit() < 0.03).collect();
        a.refine(&marked, &one).unwrap();
        marked.reverse();
        b.refine(&marked, &three).unwrap();
        assert_eq!(a.mesh(), b.mesh());
        fits(&first, a.mesh());
    }
}
