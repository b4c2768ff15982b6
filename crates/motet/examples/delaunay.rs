//! Triangulates points from a file and prints how long it took.
//!
//! Usage: `delaunay FILE [--threads N] [--simulate-threads N] [--runs N] [--tets OUT]`. FILE holds x y z of
//! each point as little-endian `f64`; OUT gets the four vertex ids of each tet as little-endian `u32`. Prints
//! one line of JSON: `{"seconds": [one for each run], "tets": .., "threads": .., "version": ".."}`. The time
//! includes sorting, building and making the output arrays, but not reading and writing; with
//! `--simulate-threads`, it is what so many threads would take, by the times of their tasks on one.

use std::process::ExitCode;
use std::time::Instant;

use motet::base::{Point, Simulation, Threads};
use motet::delaunay::Triangulation;
use motet::{Error, Result};

const USAGE: &str = "usage: delaunay FILE [--threads N] [--simulate-threads N] [--runs N] [--tets OUT]";

struct Call {
    file: String,
    threads: usize,
    simulate_threads: Option<usize>,
    runs: usize,
    tets: Option<String>,
}

fn main() -> ExitCode {
    let Some(call) = words() else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match run(&call) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(3)
        }
    }
}

fn words() -> Option<Call> {
    let mut words = std::env::args().skip(1);
    let mut call = Call { file: words.next()?, threads: 1, simulate_threads: None, runs: 1, tets: None };
    while let Some(word) = words.next() {
        let value = words.next()?;
        match word.as_str() {
            "--threads" => call.threads = value.parse().ok()?,
            "--simulate-threads" => call.simulate_threads = Some(value.parse().ok()?),
            "--runs" => call.runs = value.parse().ok()?,
            "--tets" => call.tets = Some(value),
            _ => return None,
        }
    }
    (call.runs > 0).then_some(call)
}

fn run(call: &Call) -> Result<()> {
    let points = read(&call.file)?;
    let simulation = call.simulate_threads.map(Simulation::new);
    let threads = match &simulation {
        Some(simulation) => Threads::simulated(simulation),
        None => Threads::new(call.threads)?,
    };
    let saved = || simulation.as_ref().map(Simulation::saved).unwrap_or_default();
    let mut seconds = Vec::new();
    let mut triangulation = None;
    for _ in 0..call.runs {
        drop(triangulation.take());
        let (start, saved_before) = (Instant::now(), saved());
        triangulation = Some(Triangulation::new(&points, &threads)?);
        seconds.push((start.elapsed() - (saved() - saved_before)).as_secs_f64());
    }
    let tets = triangulation.as_ref().map_or(&[][..], |t| t.tets());
    if let Some(out) = &call.tets {
        let bytes: Vec<u8> = tets.iter().flatten().flat_map(|v| (v.index() as u32).to_le_bytes()).collect();
        std::fs::write(out, bytes).map_err(|e| Error::io(out, e))?;
    }
    println!(
        "{}",
        serde_json::json!({
            "seconds": seconds,
            "tets": tets.len(),
            "threads": threads.count(),
            "version": env!("CARGO_PKG_VERSION"),
        })
    );
    Ok(())
}

fn read(file: &str) -> Result<Vec<Point>> {
    let bytes = std::fs::read(file).map_err(|e| Error::io(file, e))?;
    let values: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    Ok(values.as_chunks::<3>().0.to_vec())
}
