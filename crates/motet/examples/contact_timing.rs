//! How long distances from one surface to another take: a stent lattice in a tube.
//!
//! `contact_timing [--threads N] [--seconds S] [--check]` prints one JSON object with medians in milliseconds: the tree built from
//! nothing, all vertices of the lattice asked, the tree refitted after a small motion, all asked again with the last
//! answers as guesses, and each asked on its own. `--check` holds every answer against all triangles, of one vertex in a hundred.

use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle;
use motet::geometry::vector::{dot, sub};
use motet::spatial::{Closest, NearestTriangle};

type Shape = (Vec<Point>, Vec<[VertexId; 3]>);

/// A tube of radius 1 and length 8 with bulges: 99,200 triangles.
fn tube() -> Shape {
    let (around, along) = (400, 125);
    let mut points = Vec::new();
    for i in 0..around {
        let angle = i as f64 / around as f64 * TAU;
        for j in 0..along {
            let z = 8.0 * j as f64 / (along - 1) as f64;
            let radius = 1.0 + 0.02 * (3.0 * angle + 1.3 * z).sin() + 0.01 * (7.0 * z).sin();
            points.push([radius * angle.cos(), radius * angle.sin(), z]);
        }
    }
    let mut triangles = Vec::new();
    for i in 0..around {
        for j in 0..along - 1 {
            let (a, b) = (i * along + j, (i + 1) % around * along + j);
            triangles.push([a, b, b + 1].map(VertexId::new));
            triangles.push([a, b + 1, a + 1].map(VertexId::new));
        }
    }
    (points, triangles)
}

/// A lattice of two families of helices between radii 0.91 and 0.95, closed: 27,864 vertices.
fn lattice() -> Shape {
    let (around, along) = (168usize, 114usize);
    let is_strut = |x: f64| (x.rem_euclid(1.0) - 0.5).abs() < 0.14;
    let keep = |i: usize, j: usize| {
        let (u, w) = ((i as f64 + 0.5) / around as f64 * 12.0, (j as f64 + 0.5) / along as f64 * 12.0);
        is_strut(u + w) || is_strut(u - w) || j < 3 || j >= along - 3
    };
    let skin = around * (along + 1);
    let mut points = Vec::new();
    for radius in [0.95, 0.91] {
        for i in 0..around {
            let angle = i as f64 / around as f64 * TAU;
            for j in 0..=along {
                let z = 1.0 + 6.0 * j as f64 / along as f64;
                points.push([radius * angle.cos(), radius * angle.sin(), z]);
            }
        }
    }
    let node = |i: usize, j: usize| (i % around) * (along + 1) + j;
    let mut quads = Vec::new();
    for i in 0..around {
        for j in (0..along).filter(|&j| keep(i, j)) {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            quads.extend([[a, b, c, d], [a, d, c, b].map(|v| v + skin)]);
            let sides = [
                (j > 0 && keep(i, j - 1), a, b),
                (j + 1 < along && keep(i, j + 1), c, d),
                (keep((i + around - 1) % around, j), d, a),
                (keep((i + 1) % around, j), b, c),
            ];
            let open = sides.into_iter().filter(|side| !side.0);
            quads.extend(open.map(|(_, x, y)| [x, x + skin, y + skin, y]));
        }
    }
    let mut used: Vec<usize> = quads.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let id = |v: usize| VertexId::new(used.partition_point(|&u| u < v));
    let triangles =
        quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(id)).collect();
    (used.iter().map(|&v| points[v]).collect(), triangles)
}

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
