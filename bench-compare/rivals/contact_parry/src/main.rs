//! Distances of points from a triangle surface by parry. Usage: contact_parry FOLDER THREADS RUNS DISTANCES
//!
//! At each step parry refits its tree; the distance from the previous nearest triangle bounds each search.

use parry3d_f64::math::Vector;
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::TriMesh;
use std::time::Instant;

/// Number of time steps in the folder.
const STEPS: usize = 8;

/// The factor by which the bound exceeds a known distance, so that the search finds that distance again.
const SLACK: f64 = 1.0 + 1e-9;

fn points(path: String) -> Vec<Vector> {
    let bytes = std::fs::read(path).expect("points");
    let number = |b: &[u8]| f64::from_le_bytes(b.try_into().unwrap());
    bytes.chunks_exact(24).map(|p| Vector::new(number(&p[..8]), number(&p[8..16]), number(&p[16..]))).collect()
}

fn triangles(path: String) -> Vec<[u32; 3]> {
    let bytes = std::fs::read(path).expect("triangles");
    let number = |b: &[u8]| u32::from_le_bytes(b.try_into().unwrap());
    bytes.chunks_exact(12).map(|t| [number(&t[..4]), number(&t[4..8]), number(&t[8..])]).collect()
}

fn write(path: String, answers: &[(f64, u32)]) {
    std::fs::write(path, answers.iter().flat_map(|a| a.0.to_le_bytes()).collect::<Vec<u8>>()).expect("distances");
}

/// The distance from the surface, and the nearest triangle.
fn first(mesh: &TriMesh, p: Vector) -> (f64, u32) {
    let (place, (triangle, _)) = mesh.project_local_point_and_get_location(p, false);
    ((place.point - p).length(), triangle)
}

/// The distance from the surface and the nearest triangle, given the previous nearest triangle `last`.
fn again(mesh: &TriMesh, p: Vector, last: u32) -> (f64, u32) {
    let known = mesh.triangle(last).distance_to_local_point(p, false);
    match mesh.project_local_point_and_get_location_with_max_dist(p, false, known * SLACK) {
        Some((place, (triangle, _))) => ((place.point - p).length(), triangle),
        None => (known, last),
    }
}

/// Queries all points, divided among threads.
fn all(queries: &[Vector], answers: &mut [(f64, u32)], threads: usize, ask: impl Fn(Vector, u32) -> (f64, u32) + Sync) {
    let part = queries.len().div_ceil(threads);
    let work = |queries: &[Vector], answers: &mut [(f64, u32)]| {
        queries.iter().zip(answers).for_each(|(p, answer)| *answer = ask(*p, answer.1));
    };
    std::thread::scope(|scope| {
        let mut parts: Vec<_> = queries.chunks(part).zip(answers.chunks_mut(part)).collect();
        let (queries, answers) = parts.pop().unwrap();
        for (queries, answers) in parts {
            scope.spawn(|| work(queries, answers));
        }
        work(queries, answers);
    });
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let (folder, distances) = (&words[1], &words[4]);
    let (threads, runs): (usize, usize) = (words[2].parse().unwrap(), words[3].parse().unwrap());
    let corners = triangles(format!("{folder}/tube.u32"));
    let (tube, queries) = (points(format!("{folder}/tube.f64")), points(format!("{folder}/lattice.f64")));
    let mut answers = vec![(0.0, 0); queries.len()];
    let make = || TriMesh::new(tube.clone(), corners.clone()).expect("a surface");
    let mut mesh = make();
    let (mut building, mut asking) = (Vec::new(), Vec::new());
    for _ in 0..runs {
        building.push(seconds(|| mesh = make()));
        asking.push(seconds(|| all(&queries, &mut answers, threads, |p, _| first(&mesh, p))));
    }
    write(format!("{distances}.f64"), &answers);
    let (mut moving, mut warm) = (Vec::new(), Vec::new());
    for step in 0..STEPS {
        let (tube, queries) = (points(format!("{folder}/tube_{step}.f64")), points(format!("{folder}/lattice_{step}.f64")));
        moving.push(seconds(|| mesh.set_vertices(&tube)));
        warm.push(seconds(|| all(&queries, &mut answers, threads, |p, last| again(&mesh, p, last))));
    }
    write(format!("{distances}_step.f64"), &answers);
    let sums = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<_>>();
    println!(
        "{{\"seconds\": {:?}, \"build_seconds\": {}, \"cold_seconds\": {}, \"refit_seconds\": {}, \"warm_seconds\": {}, \
         \"step_seconds\": {}, \"version\": \"0.31.1\"}}",
        sums(&building, &asking),
        median(building),
        median(asking),
        median(moving.clone()),
        median(warm.clone()),
        median(sums(&moving, &warm)),
    );
}
