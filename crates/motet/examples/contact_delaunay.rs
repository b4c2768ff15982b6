//! Accuracy of distances by Delaunay tets compared with exact ones: one JSON line for each pair of surfaces
//! and method.
//!
//! `contact_delaunay [--threads N] [--case NAME]`. The real surfaces are read from the folder `MOTET_DATA`.
//! Errors are relative to the exact distance. `delaunay` is `Between`: the distance from a vertex to the real
//! features of other bodies in its tets; `stars` measures to all triangles around these features; `paper`
//! takes the tets of 2008, with every edge and facet taken for real: a vertex has the least distance of its
//! tets, two edges have the distance of their lines, or else the length of the shortest edge between them.
//! The two-two tets of the gap are also compared with the true distance of their edges. `nearest_tenth` covers the tenth
//! of all vertices nearest to another body.

mod common;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use motet::base::{Point, Threads, VertexId};
use motet::contact::{Between, BetweenOptions, GapKind, GapTet, paper};
use motet::geometry::distance::segment_segment;
use motet::geometry::distance::triangle_triangle::closest_below;
use motet::geometry::vector::{add, scale};
use motet::io;
use motet::mesh::shapes::{Stent, ball, wire};
use motet::mesh::{Mesh, Surface};
use motet::spatial::NearestTriangle;
use serde_json::{Value, json};

use common::{Shape, lattice, tube};

type Outcome<T> = Result<T, Box<dyn Error>>;

struct Case {
    name: String,
    points: Vec<Point>,
    bodies: Vec<Vec<[VertexId; 3]>>,
}

impl Case {
    fn new(name: impl Into<String>, shapes: &[Shape]) -> Self {
        let (mut points, mut bodies) = (Vec::new(), Vec::new());
        for (own, triangles) in shapes {
            let n = points.len();
            bodies.push(triangles.iter().map(|t| t.map(|v| VertexId::new(v.index() + n))).collect());
            points.extend_from_slice(own);
        }
        Self { name: name.into(), points, bodies }
    }
}

fn of(mesh: &Mesh) -> Shape {
    let surface = Surface::of(mesh);
    (surface.points, surface.triangles)
}

fn sphere(centre: Point, n: usize) -> Shape {
    let (points, triangles) = of(&ball(n, 1));
    (points.iter().map(|p| add(*p, centre)).collect(), triangles)
}

/// A coil of wire radius 0.04, at distances of 0.03 to 0.09 from the tube's wall.
fn coil() -> Outcome<Shape> {
    let turn = |i: u32| 0.06 * f64::from(i);
    let line: Vec<Point> =
        (0..1600).map(turn).map(|a| [0.9 * a.cos(), 0.9 * a.sin(), 1.0 + 0.06 * a]).collect();
    let segments: Vec<_> = (1..line.len()).map(|i| [i - 1, i].map(VertexId::new)).collect();
    Ok(of(&wire(&line, &segments, 0.04, 10)?))
}

fn stent() -> Outcome<Shape> {
    let stent = Stent {
        length: 6.0,
        rings: 12,
        crowns: 10,
        strut_width: 0.05,
        thickness: 0.05,
        link_length: 0.05,
        ..Stent::default()
    };
    let (points, triangles) = of(&stent.mesh(0.93)?);
    Ok((points.iter().map(|p| add(*p, [0.0, 0.0, 1.0])).collect(), triangles))
}

fn made() -> Outcome<Vec<Case>> {
    let mut cases = vec![
        Case::new("stent lattice in a tube", &[lattice(), tube()]),
        Case::new("zigzag stent in a tube", &[stent()?, tube()]),
        Case::new("coil in a tube", &[coil()?, tube()]),
    ];
    for percent in [1, 10, 100] {
        let apart = 2.0 + f64::from(percent) / 100.0;
        // Turned a little, so that no two vertices face each other.
        let centre = scale([0.9, 0.4, (1.0f64 - 0.97).sqrt()], apart);
        cases.push(Case::new(
            format!("spheres {percent} % apart"),
            &[sphere([0.0; 3], 12), sphere(centre, 12)],
        ));
    }
    Ok(cases)
}

/// Reads rows of three numbers from a file.
fn rows(file: &Path) -> Outcome<Vec<Point>> {
    let text = std::fs::read_to_string(file)?;
    let row = |line: &str| -> Outcome<Point> {
        let numbers = line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        Ok(numbers.try_into().map_err(|_| "a row of three numbers was expected")?)
    };
    text.lines().filter(|line| !line.trim().is_empty()).map(row).collect()
}

/// The braided stent in its final position, with its wires as tubes.
fn braid(folder: &Path) -> Outcome<Shape> {
    let mut nodes = rows(&folder.join("pos_stent.txt"))?;
    for more in ["u_crimping.txt", "u_positioning.txt"] {
        nodes.iter_mut().zip(rows(&folder.join(more))?).for_each(|(p, u)| *p = add(*p, u));
    }
    let text = std::fs::read_to_string(folder.join("conn_stent.txt"))?;
    let ids = text.split_whitespace().map(str::parse).collect::<Result<Vec<u32>, _>>()?;
    let segments: Vec<_> = ids.as_chunks::<2>().0.iter().map(|s| s.map(|v| VertexId(v - 1))).collect();
    Ok(of(&wire(&nodes, &segments, 0.065, 8)?))
}

fn real(data: &Path) -> Outcome<Vec<Case>> {
    let braided = data.join("devices/endobeams_braided_stent");
    let vessel = of(&io::read(braided.join("arcStretchObj.obj"))?);
    let leaflet = |name: &str| -> Outcome<Shape> {
        Ok(of(&io::read(data.join(format!("devices/sv_aortic_valve/PAT003_07_{name}.vtu")))?))
    };
    let mut cases = vec![
        Case::new("braided stent in its vessel", &[braid(&braided)?, vessel]),
        Case::new("aortic valve leaflets", &[leaflet("LCC")?, leaflet("NCC")?, leaflet("RCC")?]),
    ];
    let pipe = data.join("tetmeshes/sv_ale_pipe");
    let wall = |name: &str| -> Outcome<Shape> { Ok(of(&io::read(pipe.join(name))?)) };
    cases.push(Case::new("pipe wall, inner and outer", &[wall("wall_inner.vtp")?, wall("wall_outer.vtp")?]));
    Ok(cases)
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let out = std::hint::black_box(work());
    ((start.elapsed().as_secs_f64() * 1e4).round() / 1e4, out)
}

/// The exact distance of each vertex from the other bodies.
fn exact(case: &Case, threads: &Threads) -> Vec<f64> {
    let mut gap = vec![f64::INFINITY; case.points.len()];
    let trees: Vec<NearestTriangle> =
        case.bodies.iter().map(|b| NearestTriangle::new(&case.points, b, &Threads::single())).collect();
    for (a, body) in case.bodies.iter().enumerate() {
        let mut own: Vec<VertexId> = body.as_flattened().to_vec();
        own.sort_unstable();
        own.dedup();
        let queries: Vec<Point> = own.iter().map(|v| case.points[v.index()]).collect();
        for (_, tree) in trees.iter().enumerate().filter(|(b, _)| *b != a) {
            for (v, found) in own.iter().zip(tree.closest_all(&queries, None, threads)) {
                let distance = found.map_or(f64::INFINITY, |c| c.distance_squared.sqrt());
                gap[v.index()] = gap[v.index()].min(distance);
            }
        }
    }
    gap
}

/// The least distance between triangles of different bodies.
fn exact_least(case: &Case, start: f64) -> f64 {
    let trees: Vec<NearestTriangle> =
        case.bodies.iter().map(|b| NearestTriangle::new(&case.points, b, &Threads::single())).collect();
    let corners = |b: usize, t: u32| case.bodies[b][t as usize].map(|v| case.points[v.index()]);
    let mut least = start * start;
    for b in 1..trees.len() {
        for a in 0..b {
            let pair = |(): &mut (), i: u32, j: u32, bound: f64| {
                closest_below(corners(a, i), corners(b, j), bound).map(|c| c.distance_squared)
            };
            if let Some((found, _, _)) = trees[a].closest_pair(&trees[b], least, &Threads::single(), pair) {
                least = least.min(found);
            }
        }
    }
    least.sqrt()
}

/// The paper's distance for each vertex: the least over its gap tets.
fn by_the_paper(between: &Between, points: &[Point]) -> Vec<f64> {
    let mut gap = vec![f64::INFINITY; points.len()];
    for tet in &between.tets {
        if let Some(distance) = paper::within(tet, points) {
            tet.corners().iter().flatten().for_each(|v| gap[v.index()] = gap[v.index()].min(distance));
        }
    }
    gap
}

/// The distance of the two edges of each two-two tet by the paper's formula, and the true one.
fn two_two_by_the_paper(between: &Between, points: &[Point]) -> Vec<(f64, f64)> {
    let two_two = between.tets.iter().filter(|tet| tet.kind == GapKind::TwoTwo);
    let both = |tet: &GapTet| {
        let [p, q, r, s] = tet.corners()?.map(|v| points[v.index()]);
        Some((paper::two_two([p, q], [r, s]), segment_segment::closest([p, q], [r, s]).distance()))
    };
    two_two.filter_map(both).collect()
}

fn rounded(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { format!("{x:.3e}").parse().unwrap_or(x) }
}

/// Statistics of the errors, relative to the exact distance.
fn errors(pairs: &[(f64, f64)]) -> Value {
    let seen: Vec<f64> = pairs
        .iter()
        .filter(|(gap, exact)| gap.is_finite() && *exact > 0.0)
        .map(|(gap, exact)| gap / exact - 1.0)
        .collect();
    let mut over: Vec<f64> = seen.iter().map(|e| e.max(0.0)).collect();
    over.sort_by(f64::total_cmp);
    let at = |share: f64| over.get((share * (over.len() as f64 - 1.0)) as usize).map(|e| rounded(*e));
    let under = seen.iter().fold(0.0, |m: f64, e| m.max(-e));
    let share = |n: usize| (n as f64 / pairs.len() as f64 * 1e4).round() / 1e4;
    json!({
        "n": pairs.len(),
        "share_exact": share(seen.iter().filter(|e| e.abs() <= 1e-12).count()),
        "share_unseen": share(pairs.iter().filter(|(gap, _)| gap.is_infinite()).count()),
        "share_over": share(seen.iter().filter(|e| **e > 1e-12).count()),
        "share_under": share(seen.iter().filter(|e| **e < -1e-12).count()),
        "over_median": at(0.5), "over_95": at(0.95), "over_most": at(1.0), "under_most": rounded(under),
    })
}

fn report(case: &Case, threads: &Threads) -> Outcome<()> {
    let (exact_s, exact) = timed(|| exact(case, threads));
    let new = |stars: bool| {
        let options = BetweenOptions { stars, ..BetweenOptions::default() };
        timed(|| Between::new(&case.points, &case.bodies, &options, threads))
    };
    let (delaunay_s, delaunay) = new(false);
    let (stars_s, stars) = new(true);
    let (delaunay, stars) = (delaunay?, stars?);
    let mut kept = delaunay.clone();
    let (update_s, updated) = timed(|| kept.update(&case.points, threads));
    updated?;
    let vertices = delaunay.nearest_vertices.map_or(f64::INFINITY, |pair| pair.distance);
    let (exact_least_s, least) = timed(|| exact_least(case, vertices));
    let (_, paper) = timed(|| by_the_paper(&delaunay, &case.points));
    let least_of = |between: &Between| between.least.map_or(f64::INFINITY, |l| l.distance);
    let paper_least = paper.iter().copied().fold(f64::INFINITY, f64::min);
    let count = |b: &Vec<[VertexId; 3]>| b.len();
    println!(
        "{}",
        json!({
            "case": case.name, "method": "exact", "triangles": case.bodies.iter().map(count).collect::<Vec<_>>(),
            "least": least, "vertices_s": exact_s, "least_s": exact_least_s, "threads": threads.count(),
        })
    );
    let mut near: Vec<f64> = exact.iter().copied().filter(|d| d.is_finite()).collect();
    near.sort_by(f64::total_cmp);
    let tenth = near[near.len() / 10];
    let rows = [
        ("delaunay", &delaunay.gap, least_of(&delaunay), delaunay_s),
        ("stars", &stars.gap, least_of(&stars), stars_s),
        ("paper", &paper, paper_least, delaunay_s),
    ];
    for (method, gap, found, seconds) in rows {
        let all: Vec<(f64, f64)> =
            gap.iter().copied().zip(exact.iter().copied()).filter(|(_, e)| e.is_finite()).collect();
        let near: Vec<(f64, f64)> = all.iter().copied().filter(|(_, e)| *e <= tenth).collect();
        let error = if found == least { 0.0 } else { rounded(found / least - 1.0) };
        let mut line = json!({
            "case": case.name, "method": method, "least_error": error.is_finite().then_some(error),
            "least": found, "seconds": seconds, "all": errors(&all), "nearest_tenth": errors(&near),
        });
        if method == "delaunay" {
            line["update_s"] = update_s.into();
            line["gap_tets"] = delaunay.tets.len().into();
            line["nearest_vertices"] = vertices.into();
        }
        println!("{line}");
    }
    let two_two = errors(&two_two_by_the_paper(&delaunay, &case.points));
    println!("{}", json!({ "case": case.name, "method": "paper, two-two tets only", "all": two_two }));
    Ok(())
}

fn main() -> Outcome<()> {
    let (mut threads, mut only) = (1, None);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--threads" => threads = value()?.parse()?,
            "--case" => only = Some(value()?),
            _ => return Err(format!("what is {word}?").into()),
        }
    }
    let threads = Threads::new(threads)?;
    let mut cases = made()?;
    match std::env::var_os("MOTET_DATA") {
        Some(folder) => cases.extend(real(Path::new(&folder))?),
        None => eprintln!("MOTET_DATA is not set: no real surfaces"),
    }
    for case in cases.iter().filter(|case| only.as_ref().is_none_or(|only| case.name.contains(only.as_str())))
    {
        report(case, &threads)?;
    }
    Ok(())
}
