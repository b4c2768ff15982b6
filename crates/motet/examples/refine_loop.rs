//! The adaptation loop: solve, compute sizes from the second derivatives of the solution, adapt; compared
//! with uniform refinement.
//!
//! `refine_loop [MESH] [--rounds N] [--tets N] [--factor F] [--error E] [--threads N]` starts from a mesh
//! file, or a tube. In each of the rounds (default 4) a formula stands in for the solver, and the mesh is
//! coarsened and refined to sizes for N tets (default 10000, and `F` times as many from round to round,
//! default 2.5) or, with `--error`, for an error of at most `E`, one generation per round. Errors, root mean
//! square and maximum, are relative to the largest velocity.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;

use common::adaptation::{adapt, error, everywhere, solve, with_as_many};
use motet::base::{Point, Threads};
use motet::geometry::vector::distance;
use motet::mesh::shapes::{TubeOptions, tube};
use motet::mesh::{TetPart, bounds};
use motet::refine::sizes::SizeLimits;
use motet::refine::{Aim, HessianSizes};
use motet::{Mesh, io};

/// A front around the middle of the mesh that stands in for a solution: fast within a tenth of the extent, a
/// hundredth wide.
struct Front {
    middle: Point,
    extent: f64,
}

impl Front {
    fn of(mesh: &Mesh) -> Option<Self> {
        let [low, high] = bounds(&mesh.points)?;
        let extent = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        Some(Self { middle: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])), extent })
    }

    fn speed(&self, p: Point) -> f64 {
        0.5 * (1.0 - ((distance(p, self.middle) / self.extent - 0.1) / 0.01).tanh())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut file, mut rounds, mut n_tets, mut factor, mut at_most, mut threads) =
        (None, 4, 10_000, 2.5, None, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--rounds" => rounds = value()?.parse()?,
            "--tets" => n_tets = value()?.parse()?,
            "--factor" => factor = value()?.parse::<f64>()?,
            "--error" => at_most = Some(value()?.parse()?),
            "--threads" => threads = value()?.parse()?,
            _ => file = Some(word),
        }
    }
    let threads = Threads::new(threads)?;
    let mut mesh = file.map_or_else(|| Ok(tube(&TubeOptions::default())), io::read)?;
    let front = Front::of(&mesh).ok_or("a mesh has points")?;
    let first = TetPart::of(&mesh)?.mesh;
    let mut rows = vec![(first.tets.len(), None, error(&first, |p| front.speed(p)))];
    for round in 0..rounds {
        solve(&mut mesh, |p| front.speed(p), |p| -p[2] / front.extent);
        let tets = (f64::from(n_tets) * factor.powi(round)) as usize;
        let (aim, most) = at_most.map_or((Aim::Tets(tets), usize::MAX), |error| (Aim::Error(error), 1));
        let arrays = vec!["pressure".into(), "velocity".into()];
        let sizes = HessianSizes { arrays, aim, limits: SizeLimits::default() };
        let extremes = adapt(&mut mesh, &sizes, most, &threads)?;
        let tets = TetPart::of(&mesh)?.mesh;
        rows.push((tets.tets.len(), Some(extremes), error(&tets, |p| front.speed(p))));
    }
    let most = rows.iter().map(|row| row.0).max().unwrap_or(0);
    let found = everywhere(&first, most, |p| front.speed(p), &threads)?;
    println!(
        "| tets | smallest size | largest size | mean error | most | mean error, as many tets everywhere |"
    );
    println!("|---|---|---|---|---|---|");
    for (n, extremes, [mean, most]) in rows {
        let [low, high] = extremes.map_or(["-".into(), "-".into()], |all| all.map(|h| format!("{h:.3}")));
        let uniform = with_as_many(&found, n as f64);
        println!("| {n} | {low} | {high} | {mean:.4} | {most:.3} | {uniform:.4} |");
    }
    Ok(())
}
