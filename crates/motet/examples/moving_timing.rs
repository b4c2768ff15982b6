//! Timing of the steps of a moving mesh in which few tets change: the cost of a local change in a large mesh.
//!
//! `moving_timing [N] [--threads N] [--steps N] [--degrees X]` prints one line a step: what changed, the
//! quality after it, and the seconds by stage. The mesh is a filled cube with N edges along each side, around
//! a body of [`BODY`] edges along each side that turns by X degrees in each step; the strain is in a band
//! beside the body.

use std::error::Error;

use motet::base::{Point, Threads};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Mesh, Surface};
use motet::meshing::{Options as Filling, Sizes, Surfaces, fill};
use motet::motion::{MethodName, Motion, Strain};
use motet::moving::{MovingMesh, Options, Step};
use motet::preflight::Role;

/// The length of the body, in edges.
const BODY: usize = 6;

struct Call {
    size: usize,
    threads: usize,
    steps: usize,
    degrees: f64,
}

fn call() -> Result<Call, Box<dyn Error>> {
    let mut call = Call { size: 60, threads: 1, steps: 6, degrees: 5.0 };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match &word[..] {
            "--threads" => call.threads = value()?.parse()?,
            "--steps" => call.steps = value()?.parse()?,
            "--degrees" => call.degrees = value()?.parse()?,
            size => call.size = size.parse()?,
        }
    }
    Ok(call)
}

fn main() -> Result<(), Box<dyn Error>> {
    let Call { size, threads, steps, degrees } = call()?;
    let threads = Threads::new(threads)?;
    let mesh = around_body(size, &threads)?;
    println!("{} tets, {} points", mesh.cells.tets().count(), mesh.points.len());
    let motion =
        Motion { method: MethodName::Bodies, strain: Some(Strain::Band), smooth: 2, ..Motion::default() };
    let mut moving = MovingMesh::new(&mesh, Options { motion, ..Options::default() }, &threads)?;
    let places = moving.driven_places().to_vec();
    for i in 1..=steps {
        let angle = degrees.to_radians() * i as f64;
        let turned: Vec<Point> = places.iter().map(|p| turn(*p, angle)).collect();
        print(&moving.advance(i as f64, &turned, &threads)?);
    }
    Ok(())
}

/// A cube whose sides have `n` edges of length 1 each way, around a body in the middle, filled with tets of
/// edges as long.
fn around_body(n: usize, threads: &Threads) -> Result<Mesh, Box<dyn Error>> {
    let [cube, body] = [n, BODY].map(skin);
    let surfaces = Surfaces::new(&[(&cube, Role::Boundary, "cube"), (&body, Role::Boundary, "body")])?;
    let sizes = Filling::with_sizes(Some(Sizes::Uniform(1.0)), None);
    let options = Filling { holes: vec![[0.0; 3]], ..sizes };
    Ok(fill(&surfaces, &surfaces.preflight(threads), &options, threads)?.mesh)
}

/// The surface of a cube around the origin with `n` edges along each side.
fn skin(n: usize) -> Mesh {
    let half = 0.5 * n as f64;
    let surface = Surface::boundary_of(&box_grid([n; 3], [[-half; 3], [half; 3]]));
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

/// The displacement of a place on the walls if the body has turned about z.
fn turn([x, y, z]: Point, angle: f64) -> Point {
    let reach = 0.5 * BODY as f64 + 1e-9;
    let (sin, cos) = if [x, y, z].iter().all(|c| c.abs() <= reach) { angle.sin_cos() } else { (0.0, 1.0) };
    [cos * x - sin * y - x, sin * x + cos * y - y, 0.0]
}

fn print(step: &Step) {
    let changes: Vec<_> = step.changes.iter().map(|c| (1.0 - c.kept_share) * c.tets_before as f64).collect();
    let (quality, seconds) = (&step.quality, &step.seconds);
    println!(
        "step {:2}  {} tets  worst {:.4}, 1 % {:.4}, median {:.4}, mean {:.4}  {} bad  \
         changed {changes:.0?}  seconds: motion {:.3} quality {:.3} repair {:.3} setup {:.3} total {:.3}",
        step.step,
        step.tets,
        quality.worst,
        quality.p1,
        quality.median,
        quality.mean,
        step.bad,
        seconds.motion,
        seconds.quality,
        seconds.repair,
        seconds.setup,
        seconds.total,
    );
}
