//! Fills closed surfaces with tets that have every triangle among their facets:
//! `constrain [--stay] SURFACE...`.
//!
//! With `--stay`, points inserted on edges stay there.
//!
//! Prints counts, bodies with their volumes, and seconds; checks that every tet is positive.

use std::time::Instant;

use motet::base::{Threads, VertexId};
use motet::delaunay::{EdgePoints, constrain};
use motet::geometry::tet::volume;
use motet::mesh::{Surface, firsts_at_place};
use motet::preflight::renamed;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let is_stay = |word: &String| word == "--stay";
    let rule =
        if std::env::args().any(|word| is_stay(&word)) { EdgePoints::Stay } else { EdgePoints::MoveInside };
    for file in std::env::args().skip(1).filter(|word| !is_stay(word)) {
        let mesh = motet::io::read(&file)?;
        let mut surface = Surface::of(&mesh);
        if surface.triangles.is_empty() {
            surface = Surface::boundary_of(&mesh);
        }
        let points = surface.points;
        let triangles = renamed(&surface.triangles, &firsts_at_place(&points));
        let start = Instant::now();
        let result = constrain(&points, &triangles, rule, &Threads::single());
        let seconds = start.elapsed().as_secs_f64();
        let filled = match result {
            Ok(filled) => filled,
            Err(error) => {
                println!("{file}: {error} ({seconds:.3} s)");
                continue;
            }
        };
        let corners = |t: &[VertexId; 4]| t.map(|v| filled.points[v.index()]);
        let volumes: Vec<f64> = filled.tets.iter().map(|t| volume(corners(t))).collect();
        let n_bodies = filled.bodies.iter().max().map_or(0, |m| m + 1);
        let total: f64 = volumes.iter().sum();
        let enclosed: f64 = triangles
            .iter()
            .map(|t| t.map(|v| points[v.index()]))
            .map(|[a, b, c]| volume([[0.0; 3], a, b, c]))
            .sum();
        println!(
            "{file}: {} triangles, {} points on edges, {} points, {} tets, {n_bodies} bodies, {} not positive, volume {total:.12e} enclosed {enclosed:.12e}, {seconds:.3} s",
            triangles.len(),
            filled.on_edges.len(),
            filled.points.len() - points.len(),
            filled.tets.len(),
            volumes.iter().filter(|v| **v <= 0.0).count(),
        );
    }
    Ok(())
}
