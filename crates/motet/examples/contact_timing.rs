//! Timing of distances from one surface to another: a stent lattice in a tube.
//!
//! `contact_timing [--threads N] [--seconds S] [--check] [--distances PREFIX]` prints one JSON object with
//! medians in milliseconds: building the tree, querying all vertices of the lattice, refitting the tree after
//! a small motion, querying all again with the last answers as guesses, and querying each one separately;
//! then both surfaces as bodies of a `Contact`: set-up, refit, their nearest places alone and everything, at
//! first and at further steps. The values in seconds are for bench-compare.
//!
//! `--check` compares the answers for one vertex in a hundred with a search over all triangles. `--distances`
//! writes the distances of all vertices to `PREFIX.f64`, and those after the last of the written steps to
//! `PREFIX_step.f64`. `contact_timing --write FOLDER` only writes the input of the measurements: points as
//! f64, triangles as u32, at rest and at eight steps.

mod common;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use motet::base::{BodyId, MaybeId, Point, Threads, TriangleId, VertexId};
use motet::contact::{Body, Contact, Options, Room};
use motet::geometry::triangle;
use motet::geometry::vector::{dot, sub};
use motet::spatial::{Closest, NearestTriangle};
use serde_json::Value;

use common::{Shape, lattice, tube};

/// Number of steps that are written for other programs to measure.
const STEPS: usize = 8;

/// The warning distance, which part of the lattice is below.
const WARN: f64 = 0.03;

/// Points at a time step: moved by up to 0.0005 in each direction, one hundredth of the gap.
fn moved(points: &[Point], step: usize) -> Vec<Point> {
    let wave = |x: f64| 5e-4 * (3.0 * x + step as f64).sin();
    points.iter().map(|p| [p[0] + wave(p[2]), p[1] + wave(p[0]), p[2] + wave(p[1])]).collect()
}

/// Points of the tube and of the lattice at a time step, with relative motion between them.
fn at_step([tube, lattice]: [&[Point]; 2], step: usize) -> [Vec<Point>; 2] {
    [moved(tube, step), moved(lattice, step + 1)]
}

/// The median time in milliseconds.
fn median(budget: f64, mut work: impl FnMut(usize) -> f64) -> f64 {
    median_of(repeated(budget, &mut work))
}

/// Seconds of at least nine repeats, and of more while the budget lasts.
fn repeated(budget: f64, mut work: impl FnMut(usize) -> f64) -> Vec<f64> {
    let begin = Instant::now();
    let mut all = Vec::new();
    while all.len() < 9 || begin.elapsed().as_secs_f64() < budget {
        all.push(work(all.len()));
    }
    all
}

fn median_of(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    milliseconds(all[all.len() / 2])
}

fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

/// The seconds that a piece of work takes, and its result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let out = std::hint::black_box(work());
    (start.elapsed().as_secs_f64(), out)
}

fn by_brute_force(points: &[Point], triangles: &[[VertexId; 3]], p: Point) -> (f64, usize) {
    let distance_squared = |t: &[VertexId; 3]| {
        let corners = t.map(|v| points[v.index()]);
        let offset = sub(triangle::at(corners, triangle::closest(corners, p)), p);
        dot(offset, offset)
    };
    let all = triangles.iter().map(distance_squared).zip(0..);
    all.fold((f64::INFINITY, 0), |best, next| if next.0 < best.0 { next } else { best })
}

fn triangles_of(found: &[Option<Closest>]) -> Vec<MaybeId<TriangleId>> {
    found.iter().map(|c| c.map(|c| TriangleId::new(c.triangle)).into()).collect()
}

/// Measures the vertices of the lattice against the tube; returns their distances at rest and after the last
/// step.
fn by_vertex(
    [(points, triangles), (queries, _)]: [&Shape; 2],
    budget: f64,
    threads: &Threads,
    out: &mut Value,
) -> (NearestTriangle, [Vec<Option<Closest>>; 2]) {
    out["seconds"] = repeated(budget, |_| {
        timed(|| NearestTriangle::new(points, triangles, threads).closest_all(queries, None, threads)).0
    })
    .into();
    out["build_ms"] = median(budget, |_| timed(|| NearestTriangle::new(points, triangles, threads)).0).into();
    let rest = NearestTriangle::new(points, triangles, threads);
    let each = || queries.iter().map(|p| rest.closest(*p)).collect::<Vec<_>>();
    out["one_by_one_ms"] = median(budget, |_| timed(each).0).into();
    out["cold_ms"] = median(budget, |_| timed(|| rest.closest_all(queries, None, threads)).0).into();
    let mut tree = rest.clone();
    let mut found = rest.closest_all(queries, None, threads);
    let at_rest = found.clone();
    let (mut refit, mut warm) = (Vec::new(), Vec::new());
    let mut take = |step| {
        let [points, queries] = at_step([points, queries], step);
        let guesses = triangles_of(&found);
        let (moving, ()) = timed(|| tree.refit(&points, threads));
        let (asking, answer) = timed(|| tree.closest_all(&queries, Some(&guesses), threads));
        found = answer;
        refit.push(moving);
        warm.push(asking);
        moving + asking
    };
    out["step_ms"] = median(2.0 * budget, &mut take).into();
    take(STEPS - 1);
    out["refit_ms"] = median_of(refit).into();
    out["warm_ms"] = median_of(warm).into();
    (rest, [at_rest, found])
}

/// Both surfaces as bodies over one list of points.
fn contact([tube, lattice]: [&Shape; 2], threads: &Threads) -> motet::base::Result<Contact> {
    let n = tube.0.len();
    let points = [&tube.0[..], &lattice.0].concat();
    let body = |name: &str, triangles: &[[VertexId; 3]], first: usize| {
        let triangles = triangles.iter().map(|t| t.map(|v| VertexId::new(first + v.index()))).collect();
        Body { name: name.into(), triangles, room: Room::No }
    };
    let bodies = vec![body("tube", &tube.1, 0), body("lattice", &lattice.1, n)];
    Contact::new(points, bodies, Options { warn: Some(WARN), ..Options::default() }, threads)
}

/// Times the contact handle: the nearest places of the two surfaces alone, and everything that it measures.
/// Returns the gaps of the lattice after the last step.
fn whole(shapes: [&Shape; 2], budget: f64, threads: &Threads, out: &mut Value) -> motet::Result<Vec<f64>> {
    let rest = contact(shapes, threads)?;
    out["contact_new_ms"] = median(budget, |_| timed(|| contact(shapes, threads)).0).into();
    let mut nearest = Vec::new();
    let first = median(budget, |_| {
        let mut contact = rest.clone();
        let (seconds, answer) = timed(|| contact.nearest(threads));
        nearest = answer;
        seconds
    });
    out["nearest_cold_ms"] = first.into();
    out["nearest_distance"] = least(&nearest);
    out["measure_cold_ms"] = median(budget, |_| {
        let mut contact = rest.clone();
        timed(|| contact.measure(threads)).0
    })
    .into();
    let mut contact = rest;
    let points_at = |step| at_step([&shapes[0].0, &shapes[1].0], step).concat();
    let mut refit = Vec::new();
    let warm = median(budget, |step| {
        let points = points_at(step);
        refit.push(timed(|| contact.refit(&points, threads)).0);
        timed(|| contact.nearest(threads)).0
    });
    out["contact_refit_ms"] = median_of(refit).into();
    out["nearest_warm_ms"] = warm.into();
    out["measure_ms"] = median(budget, |step| {
        let moved = contact.refit(&points_at(step), threads);
        timed(|| moved.map(|()| contact.measure(threads))).0
    })
    .into();
    contact.refit(&points_at(STEPS - 1), threads)?;
    out["nearest_distance_step"] = least(&contact.nearest(threads));
    let mut gaps = contact.measure(threads);
    out["warned_vertices"] =
        gaps.bodies.iter().flat_map(|b| &b.warning).filter(|warns| **warns).count().into();
    Ok(gaps.bodies.swap_remove(1).gap)
}

fn least(nearest: &[([BodyId; 2], Option<motet::contact::Nearest>)]) -> Value {
    nearest.iter().filter_map(|(_, nearest)| *nearest).map(|nearest| nearest.distance).next().into()
}

/// Writes the input of the measurements for other programs: raw, little-endian.
fn write(folder: &Path, [tube, lattice]: [&Shape; 2]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let put =
        |name: &str, points: &[Point]| write_raw(&folder.join(name), points.as_flattened().iter().copied());
    for (name, shape) in [("tube", tube), ("lattice", lattice)] {
        put(&format!("{name}.f64"), &shape.0)?;
        let corners = shape.1.as_flattened().iter().flat_map(|v| v.0.to_le_bytes());
        std::fs::write(folder.join(format!("{name}.u32")), corners.collect::<Vec<u8>>())?;
    }
    for step in 0..STEPS {
        let [tube, lattice] = at_step([&tube.0, &lattice.0], step);
        put(&format!("tube_{step}.f64"), &tube)?;
        put(&format!("lattice_{step}.f64"), &lattice)?;
    }
    Ok(())
}

fn write_raw(path: &Path, numbers: impl Iterator<Item = f64>) -> std::io::Result<()> {
    std::fs::write(path, numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

fn distances(found: &[Option<Closest>]) -> impl Iterator<Item = f64> {
    found.iter().map(|c| c.map_or(f64::INFINITY, |c| c.distance_squared.sqrt()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut threads, mut budget, mut check, mut prefix) = (1, 1.0, false, None);
    let (tube, lattice) = (tube(), lattice());
    let shapes = [&tube, &lattice];
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--threads" => threads = value()?.parse()?,
            "--seconds" => budget = value()?.parse()?,
            "--check" => check = true,
            "--distances" => prefix = Some(value()?),
            "--write" => return Ok(write(value()?.as_ref(), shapes)?),
            _ => return Err(format!("what is {word}?").into()),
        }
    }
    let threads = Threads::new(threads)?;
    let (points, triangles) = &tube;
    let queries = &lattice.0;
    let mut out = serde_json::json!({
        "queries": queries.len(), "inner_triangles": lattice.1.len(), "triangles": triangles.len(),
        "threads": threads.count(), "version": env!("CARGO_PKG_VERSION"),
    });
    let (tree, [at_rest, at_last]) = by_vertex(shapes, budget, &threads, &mut out);
    out["memory_bytes"] = tree.memory().into();
    out["least_distance"] = distances(&at_rest).fold(f64::INFINITY, f64::min).into();
    let gaps = whole(shapes, budget, &threads, &mut out)?;
    if let Some(prefix) = prefix {
        write_raw(format!("{prefix}.f64").as_ref(), distances(&at_rest))?;
        write_raw(format!("{prefix}_step.f64").as_ref(), distances(&at_last))?;
    }
    if check {
        let each = queries.iter().map(|p| tree.closest(*p));
        out["differ"] = each.zip(&at_rest).filter(|(x, y)| x != *y).count().into();
        out["gaps_differ"] = gaps.iter().zip(distances(&at_last)).filter(|(x, y)| **x != *y).count().into();
        let sampled = queries.iter().zip(&at_rest).step_by(100);
        let wrong = sampled.filter(|(p, c)| {
            c.map(|c| (c.distance_squared, c.triangle)) != Some(by_brute_force(points, triangles, **p))
        });
        out["wrong"] = wrong.count().into();
    }
    for (name, value) in out.as_object().cloned().unwrap_or_default() {
        if let (Some(what), Some(milliseconds)) = (name.strip_suffix("_ms"), value.as_f64()) {
            out[format!("{what}_seconds")] = (milliseconds / 1e3).into();
        }
    }
    println!("{out}");
    Ok(())
}
