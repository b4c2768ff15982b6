//! Fills closed surfaces with tets that have every triangle among their facets: `constrain SURFACE... [-o OUT.vtu]`.
//!
//! Prints counts, bodies with their volumes, and seconds; checks that every tet is positive.

use std::time::Instant;

use motet::base::{Threads, VertexId};
use motet::delaunay::{EdgePoints, constrain};
use motet::geometry::tet::volume;
use motet::mesh::Surface;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rule = if std::env::var("MOTET_STAY").is_ok() { EdgePoints::Stay } else { EdgePoints::MoveInside };
    for file in std::env::args().skip(1) {
        let mesh = motet::io::read(&file)?;
        let mut surface = Surface::of(&mesh);
        if surface.triangles.is_empty() {
            surface = Surface::boundary_of(&mesh);
        }
        let (points, triangles) = welded(&surface);
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
        let enclosed: f64 = triangles.iter().map(|t| t.map(|v| points[v.index()])).map(|[a, b, c]| volume([[0.0; 3], a, b, c])).sum();
        println!(
            "{file}: {} triangles, {} points on edges, {} points, {} tets, {n_bodies} bodies, {} not positive, volume {total:.12e} enclosed {enclosed:.12e}, {seconds:.3} s",
            triangles.len(), filled.on_edges.len(), filled.points.len() - points.len(), filled.tets.len(), volumes.iter().filter(|v| **v <= 0.0).count(),
        );
    }
    Ok(())
}

/// Points that coincide become one.
fn welded(surface: &Surface) -> (Vec<[f64; 3]>, Vec<[VertexId; 3]>) {
    let mut order: Vec<u32> = (0..surface.points.len() as u32).collect();
    let key = |v: u32| surface.points[v as usize].map(|x| (x + 0.0).to_bits());
    order.sort_by_key(|&v| (key(v), v));
    let mut to = vec![VertexId(0); surface.points.len()];
    let mut kept = VertexId(0);
    for (i, &v) in order.iter().enumerate() {
        if i == 0 || key(order[i - 1]) != key(v) {
            kept = VertexId(v);
        }
        to[v as usize] = kept;
    }
    (surface.points.clone(), surface.triangles.iter().map(|t| t.map(|v| to[v.index()])).collect())
}
