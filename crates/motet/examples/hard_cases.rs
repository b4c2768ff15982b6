//! Fills hard random surfaces with tets and checks the meshes: `hard_cases FROM TO [KIND]`. Prints each case
//! that fails, leaves points on the surface or takes long, and counts by kind.

use std::collections::BTreeMap;
use std::time::Instant;

use common::filling::faults;
use common::hard::random_case;
use motet::base::Threads;
use motet::delaunay::{EdgePoints, constrain};

#[path = "../tests/common/mod.rs"]
mod common;

/// Cases that take more seconds than this are printed.
const LONG: f64 = 2.0;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| words.get(i).and_then(|w| w.parse::<u64>().ok());
    let (from, to) = (number(0).unwrap_or(0), number(1).unwrap_or(1000));
    // Counts by kind: all, surfaces unchanged, with points left on the surface, failed.
    let mut counts: BTreeMap<String, [usize; 4]> = BTreeMap::new();
    for case in (from..to).map(random_case) {
        let kind = case.name.split([' ', ',']).nth(1).unwrap_or_default().to_owned();
        if words.get(2).is_some_and(|only| *only != kind) {
            continue;
        }
        let start = Instant::now();
        let result = constrain(&case.points, &case.triangles, EdgePoints::MoveInside, &Threads::single());
        let seconds = start.elapsed().as_secs_f64();
        let (column, what) = match &result {
            Err(error) => (3, error.to_string()),
            Ok(filled) => {
                let n_left = [filled.on_edges.len(), filled.in_triangles.len()];
                let left = format!("{} points on edges, {} in triangles", n_left[0], n_left[1]);
                match faults(&case.points, &case.triangles, filled, EdgePoints::MoveInside).into_iter().next()
                {
                    Some(fault) => (3, fault),
                    None => (if n_left == [0, 0] { 1 } else { 2 }, left),
                }
            }
        };
        let of = counts.entry(kind).or_default();
        of[0] += 1;
        of[column] += 1;
        if column > 1 || seconds > LONG {
            println!("{} ({} triangles): {what} ({seconds:.2} s)", case.name, case.triangles.len());
        }
    }
    println!("kind: all, kept, with points on the surface, failed");
    let mut sum = [0; 4];
    for (kind, of) in &counts {
        println!("{kind}: {of:?}");
        (0..4).for_each(|i| sum[i] += of[i]);
    }
    println!("all: {sum:?}");
}
