//! Fills generated bodies whose faces are flat up to rounding, and counts the outcomes by kind.
//!
//! `cargo run --release -p motet --example cad_bodies -- [COUNT] [SEED] [FOLDER]`; with a folder, each body
//! is written there as `SEED.off` for other programs.

#[path = "../tests/common/cad.rs"]
mod cad_bodies;

use std::collections::BTreeMap;
use std::path::Path;

use cad_bodies::cad;
use motet::base::Threads;
use motet::delaunay::{EdgePoints, constrain};
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::volume;
use motet::io::{WriteOptions, write};
use motet::mesh::{CellKind, Cells, Mesh};

#[derive(Default)]
struct Count {
    bodies: usize,
    kept: usize,
    positive: usize,
    refused: usize,
    flat: usize,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default| words.get(i).map_or(default, |word| word.parse().expect("a number"));
    let (count, first): (usize, usize) = (number(0, 700), number(1, 0));
    let folder = words.get(2).map(Path::new);
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    for seed in first..first + count {
        let body = cad(seed);
        let of_kind = counts.entry(body.kind).or_default();
        of_kind.bodies += 1;
        if let Some(folder) = folder {
            let ids = body.triangles.as_flattened().to_vec();
            let cells = Cells::uniform(CellKind::TRIANGLE, ids).expect("three corners each");
            let mesh = Mesh::new(body.points.clone(), cells);
            write(folder.join(format!("{seed}.off")), &mesh, &WriteOptions::default())
                .expect("a folder to write to");
        }
        let made = constrain(&body.points, &body.triangles, EdgePoints::MoveInside, &Threads::single());
        let Ok(made) = made else {
            of_kind.refused += 1;
            println!("{seed}: refused");
            continue;
        };
        let is_kept = made.triangle_to_facets.iter().all(|facets| facets.len() == 1);
        let corners = |tet: &[_; 4]| tet.map(|v: motet::base::VertexId| made.points[v.index()]);
        let tets = || made.tets.iter().map(corners);
        let is_positive = tets().all(|[a, b, c, d]| orient3d(a, b, c, d) > 0);
        of_kind.kept += usize::from(is_kept);
        of_kind.positive += usize::from(is_positive);
        of_kind.flat += tets().filter(|&tet| volume(tet) <= 0.0).count();
        if !is_kept || !is_positive {
            println!("{seed}, {}: kept {is_kept}, positive {is_positive}", body.kind);
        }
    }
    println!("kind | bodies | all triangles kept | all tets positive | refused | tets of no volume in f64");
    for (kind, c) in counts {
        println!("{kind} | {} | {} | {} | {} | {}", c.bodies, c.kept, c.positive, c.refused, c.flat);
    }
}
