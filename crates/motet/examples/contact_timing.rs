//! How long distances from one surface to another take: a stent lattice in a tube.
//!
//! `contact_timing [--threads N] [--seconds S] [--check]` prints one JSON object with medians in milliseconds: the tree built from
//! nothing, all vertices of the lattice asked, the tree refitted after a small motion, all asked again with the last
//! answers as guesses, and each asked on its own. `--check` holds every answer against all triangles, of one vertex in a hundred.

mod common;

use std::error::Error;
use std::time::Instant;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle;
use motet::geometry::vector::{dot, sub};
use motet::spatial::{Closest, NearestTriangle};

use common::{lattice, tube};

/// Points at a time step: moved by up to 0.0005 in each direction, which is one hundredth of the gap.
fn moved(points: &[Point], step: usize) -> Vec<Point> {
    let wave = |x: f64| 5e-4 * (3.0 * x + step as f64).sin();
    points.iter().map(|p| [p[0] + wave(p[2]), p[1] + wave(p[0]), p[2] + wave(p[1])]).collect()
}

/// The median time in milliseconds.
fn median(budget: f64, mut work: impl FnMut(usize) -> f64) -> f64 {
    let begin = Instant::now();
    let mut all = Vec::new();
    while all.len() < 9 || begin.elapsed().as_secs_f64() < budget {
        all.push(work(all.len()));
    }
    median_of(all)
}

fn median_of(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    milliseconds(all[all.len() / 2])
}

fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

/// Seconds that a piece of work takes, and what it gives.
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

fn main() -> Result<(), Box<dyn Error>> {
    let (mut threads, mut budget, mut check) = (1, 1.0, false);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--threads" => threads = value()?.parse()?,
            "--seconds" => budget = value()?.parse()?,
            "--check" => check = true,
            _ => return Err(format!("what is {word}?").into()),
        }
    }
    let threads = Threads::new(threads)?;
    let (points, triangles) = tube();
    let (queries, inner) = lattice();
    let build = median(budget, |_| timed(|| NearestTriangle::new(&points, &triangles)).0);
    let tree = NearestTriangle::new(&points, &triangles);
    let each = |p: &Point| tree.closest(*p);
    let one_by_one = median(budget, |_| timed(|| queries.iter().map(each).collect::<Vec<_>>()).0);
    let found: Vec<Option<Closest>> = queries.iter().map(each).collect();
    let least = found.iter().flatten().map(|c| c.distance_squared).fold(f64::INFINITY, f64::min).sqrt();
    let mut out = serde_json::json!({
        "queries": queries.len(), "inner_triangles": inner.len(), "triangles": triangles.len(),
        "threads": threads.count(), "build_ms": build, "one_by_one_ms": one_by_one, "least_distance": least,
    });
    out["memory_bytes"] = tree.memory().into();
    let many = median(budget, |_| timed(|| tree.closest_all(&queries, None, &threads)).0);
    let all = tree.closest_all(&queries, None, &threads);
    let mut tree = tree.clone();
    let (mut refit, mut warm) = (Vec::new(), Vec::new());
    let mut guesses: Vec<u32> = all.iter().map(|c| c.map_or(u32::MAX, |c| c.triangle as u32)).collect();
    let step = median(2.0 * budget, |step| {
        let (points, queries) = (moved(&points, step), moved(&queries, step + 1));
        refit.push(timed(|| tree.refit(&points)).0);
        let (seconds, found) = timed(|| tree.closest_all(&queries, Some(&guesses), &threads));
        warm.push(seconds);
        guesses
            .iter_mut()
            .zip(found)
            .for_each(|(guess, c)| *guess = c.map_or(u32::MAX, |c| c.triangle as u32));
        refit[refit.len() - 1] + seconds
    });
    out["cold_ms"] = many.into();
    out["build_and_cold_ms"] = milliseconds((build + many) / 1e3).into();
    out["refit_ms"] = median_of(refit).into();
    out["warm_ms"] = median_of(warm).into();
    out["step_ms"] = step.into();
    if check {
        out["differ"] = found.iter().zip(&all).filter(|(x, y)| x != y).count().into();
        let asked = queries.iter().zip(&found).step_by(100);
        let wrong = asked.filter(|(p, c)| {
            c.map(|c| (c.distance_squared, c.triangle)) != Some(by_brute_force(&points, &triangles, **p))
        });
        out["wrong"] = wrong.count().into();
    }
    println!("{out}");
    Ok(())
}
