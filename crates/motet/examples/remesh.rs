//! Repairs the bad tets of a mesh and prints one line of JSON with the median time, for the comparison with
//! other programs.
//!
//! `remesh IN OUT [--goal best] [--adapt] [--min-eas Q] [--rounds N] [--sizes H] [--threads N]`

use std::process::ExitCode;
use std::time::Instant;

use motet::base::Threads;
use motet::geometry::quality::eas;
use motet::kernel::Complex;
use motet::mesh::{CellKind, Cells, Mesh, TetMesh, TetPart};
use motet::remesh::{Goal, Options, Sizes, SurfaceRule, remesh};

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed().as_secs_f64(), done)
}

/// The time to join the tets and to measure each once, which any such program has to spend.
fn minimal_cost(mesh: &TetMesh) -> [f64; 2] {
    let (join, complex) = timed(|| Complex::new(mesh));
    drop(complex);
    let quality = |t: &[motet::base::VertexId; 4]| eas(t.map(|v| mesh.points[v.index()]));
    let (measure, _) = timed(|| mesh.tets.iter().map(quality).fold(f64::INFINITY, f64::min));
    [join, measure]
}

fn run(arguments: &[String]) -> motet::Result<()> {
    let value = |name: &str| arguments.iter().position(|a| a == name).map(|i| arguments[i + 1].as_str());
    let has = |name: &str| arguments.iter().any(|a| a == name);
    let mut options = Options::default();
    options.min_eas = value("--min-eas").map_or(options.min_eas, |q| q.parse().unwrap_or(0.2));
    if value("--goal") == Some("best") {
        options.goal = Goal::Best;
    }
    if has("--adapt") {
        options.surface = SurfaceRule::Adapt { distance: None };
    }
    options.sizes = value("--sizes").and_then(|h| h.parse().ok()).map(Sizes::Uniform);
    let n_rounds = value("--rounds").map_or(3, |n| n.parse().unwrap_or(3)).max(1);
    let threads = Threads::new(value("--threads").map_or(1, |n| n.parse().unwrap_or(1)))?;
    let mesh = TetPart::of(&motet::io::read(&arguments[0])?)?.mesh;
    let (mut seconds, mut joins, mut measures, mut last) = (vec![], vec![], vec![], None);
    for _ in 0..n_rounds {
        let [join, measure] = minimal_cost(&mesh);
        joins.push(join);
        measures.push(measure);
        let (time, outcome) = timed(|| remesh(&mesh, &options, &threads));
        seconds.push(time);
        last = Some(outcome?);
    }
    let Some(outcome) = last else { return Ok(()) };
    let line = serde_json::json!({
        "seconds": median(seconds),
        "adjacency_seconds": median(joins),
        "quality_seconds": median(measures),
        "report": outcome.report,
    });
    println!("{line}");
    let tets = outcome.extract.mesh.tets.as_flattened().to_vec();
    let mesh = Mesh::new(outcome.extract.mesh.points, Cells::uniform(CellKind::TETRA, tets)?);
    motet::io::write(&arguments[1], &mesh, &motet::io::WriteOptions::default()).map(drop)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.len() < 2 {
        eprintln!(
            "remesh IN OUT [--goal best] [--adapt] [--min-eas Q] [--rounds N] [--sizes H] [--threads N]"
        );
        return ExitCode::from(2);
    }
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
