//! Triangulates points from a file and prints how long it took.
//!
//! Usage: `delaunay FILE [RUNS [THREADS]]`, where FILE holds x y z of each point as little-endian `f64`. Prints one line of
//! JSON: `{"seconds": median of RUNS (default 1), "least": .., "tets": .., "threads": .., "version": ".."}`. Reading is not timed; sorting, building and
//! making the output arrays are.

use motet::base::{Point, Threads};
use motet::delaunay::Triangulation;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let file = arguments.get(1).ok_or("usage: delaunay FILE [RUNS [THREADS]]")?;
    let number = |i: usize| arguments.get(i).map_or(Ok(1), |a| a.parse::<usize>());
    let (runs, threads) = (number(2)?.max(1), Threads::new(number(3)?)?);
    let points = read(file)?;
    let mut seconds = Vec::new();
    let mut n_tets = 0;
    for _ in 0..runs {
        let start = Instant::now();
        let triangulation = Triangulation::new(&points, &threads)?;
        seconds.push(start.elapsed().as_secs_f64());
        n_tets = triangulation.tets().len();
    }
    seconds.sort_by(f64::total_cmp);
    println!(
        r#"{{"seconds": {:.6}, "least": {:.6}, "tets": {n_tets}, "threads": {}, "version": "{}"}}"#,
        seconds[runs / 2],
        seconds[0],
        threads.count(),
        env!("CARGO_PKG_VERSION"),
    );
    Ok(())
}

fn read(file: &str) -> Result<Vec<Point>, Box<dyn std::error::Error>> {
    let bytes = std::fs::read(file)?;
    let value = |chunk: &[u8]| f64::from_le_bytes(std::array::from_fn(|i| chunk[i]));
    Ok(bytes.chunks_exact(24).map(|c| [value(&c[..8]), value(&c[8..16]), value(&c[16..])]).collect())
}
