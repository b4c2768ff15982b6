//! Refinement of a mesh towards a point, generation by generation: shapes, counts, seconds.
//!
//! `refine_timing MESH [--generations N] [--uniform] [--point X,Y,Z] [--radius R] [--factor F] [--keep K]
//! [--share S] [--threads N]` divides, in generation k, the tets whose centre is nearer to the point than `R
//! F^k` (default 1.2 and 0.6), or all of them. Prints one JSON object per generation; worst and median are
//! relative to the first mesh where their name says so.

use std::error::Error;
use std::time::Instant;

use motet::base::{Point, TetId, Threads};
use motet::geometry::quality::{eas, mean_ratio};
use motet::geometry::tet::centroid;
use motet::geometry::vector::distance;
use motet::io;
use motet::mesh::{TetMesh, TetPart};
use motet::refine::{Options, Refinement};

fn qualities(mesh: &TetMesh, of: impl Fn([Point; 4]) -> f64 + Sync, threads: &Threads) -> (f64, f64) {
    let mut all = threads.map(mesh.tets.len(), |i| of(mesh.tets[i].map(|v| mesh.points[v.index()])).abs());
    let worst = all.iter().copied().fold(f64::INFINITY, f64::min);
    let middle = all.len() / 2;
    (worst, *all.select_nth_unstable_by(middle, f64::total_cmp).1)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut file, mut generations, mut point, mut radius, mut factor) = (None, 5, [1.0, 0.0, 0.0], 1.2, 0.6);
    let (mut is_uniform, mut threads, mut options) = (false, 1, Options::default());
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--generations" => generations = value()?.parse()?,
            "--uniform" => is_uniform = true,
            "--radius" => radius = value()?.parse()?,
            "--factor" => factor = value()?.parse()?,
            "--keep" => options.keep = value()?.parse()?,
            "--share" => options.share = value()?.parse()?,
            "--threads" => threads = value()?.parse()?,
            "--point" => {
                let all = value()?.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
                point = all.try_into().map_err(|_| "a point has three numbers")?;
            }
            _ => file = Some(word),
        }
    }
    let threads = Threads::new(threads)?;
    let first = TetPart::of(&io::read(file.ok_or("which mesh?")?)?)?.mesh;
    let begin = Instant::now();
    let mut refinement = Refinement::new(&first, options, &threads)?;
    let setup = begin.elapsed().as_secs_f64();
    let (worst, median) = qualities(&first, eas, &threads);
    let (worst_ratio, _) = qualities(&first, mean_ratio, &threads);
    println!(
        "{}",
        serde_json::json!({"tets": first.tets.len(), "worst": worst, "median": median, "worst_mean_ratio": worst_ratio, "setup_seconds": setup})
    );
    let mut reach = radius;
    for generation in 1..=generations {
        let mesh = refinement.mesh();
        let n = mesh.tets.len();
        let is_near = |i: usize| {
            is_uniform || distance(centroid(mesh.tets[i].map(|v| mesh.points[v.index()])), point) < reach
        };
        let marked: Vec<TetId> = (0..n).filter(|&i| is_near(i)).map(TetId::new).collect();
        let begin = Instant::now();
        let summary = refinement.refine(&marked, &threads)?;
        let seconds = begin.elapsed().as_secs_f64();
        let mesh = refinement.mesh();
        let (now, median) = qualities(mesh, eas, &threads);
        let (ratio, _) = qualities(mesh, mean_ratio, &threads);
        println!(
            "{}",
            serde_json::json!({
                "generation": generation, "marked": marked.len(), "tets": summary.n_tets, "promoted": summary.n_promoted, "cut": summary.n_cut,
                "sweeps": summary.n_sweeps, "worst_to_first": now / worst, "mean_ratio_to_first": ratio / worst_ratio, "median": median,
                "seconds": seconds, "new_per_second": (summary.n_tets - n) as f64 / seconds,
                "memory_per_tet": refinement.memory() as f64 / summary.n_tets as f64,
            })
        );
        reach *= factor;
    }
    Ok(())
}
