//! How good meshes are that different methods move, and what a step takes: a sphere in a box, shifted and turned.
//!
//! `motion_quality [N,LAYERS|FILE] [--threads N] [--only WORD] [--smooth SWEEPS]` prints a table; `22,10` has 32,000 vertices; a file's sphere is of radius 1 about the origin. Each cell: bad tets (EAS below 0.2),
//! inverted ones in brackets, the smallest dihedral angle of the others in degrees; seconds. "In steps": a tenth of a radius or five degrees
//! at a time, the method set up anew on the mesh of the step before.

use std::error::Error;
use std::time::Instant;

use motet::base::{Point, Threads};
use motet::geometry::quality::{dihedral, eas};
use motet::geometry::tet::volume;
use motet::geometry::vector::{norm, sub};
use motet::mesh::{Mesh, shapes};
use motet::motion::{BAD_EAS, Elastic, Laplace, Method, Mover, Options, Prescribed};

/// Parts of a whole motion, and where a part of it takes a point.
struct Row {
    name: &'static str,
    steps: usize,
    shift: f64,
    degrees: f64,
}

/// A flap that stands on the floor, `y = -1`, and bends about `z`: an arc of so many degrees.
const FLAP: [Row; 4] = [
    Row { name: "flap 30 degrees", steps: 6, shift: 0.0, degrees: 30.0 },
    Row { name: "flap 45 degrees", steps: 9, shift: 0.0, degrees: 45.0 },
    Row { name: "flap 60 degrees", steps: 12, shift: 0.0, degrees: 60.0 },
    Row { name: "flap 90 degrees", steps: 18, shift: 0.0, degrees: 90.0 },
];

const ROWS: [Row; 7] = [
    Row { name: "0.5 radii", steps: 5, shift: 0.5, degrees: 0.0 },
    Row { name: "1 radius", steps: 10, shift: 1.0, degrees: 0.0 },
    Row { name: "2 radii", steps: 20, shift: 2.0, degrees: 0.0 },
    Row { name: "3 radii", steps: 30, shift: 3.0, degrees: 0.0 },
    Row { name: "15 degrees", steps: 3, shift: 0.0, degrees: 15.0 },
    Row { name: "45 degrees", steps: 9, shift: 0.0, degrees: 45.0 },
    Row { name: "90 degrees", steps: 18, shift: 0.0, degrees: 90.0 },
];

impl Row {
    fn moves(&self, p: Point) -> bool {
        match self.name.starts_with("flap") {
            true => p[0].abs() < 0.0301 && p[1] < 1e-6 && p[2].abs() < 0.5001,
            false => norm(p) < 1.2,
        }
    }

    fn place(&self, p: Point, part: f64) -> Point {
        if self.name.starts_with("flap") {
            let (curvature, along) = (self.degrees.to_radians() * part, p[1] + 1.0);
            let (sine, cosine) = (curvature * along).sin_cos();
            return [(1.0 - cosine) / curvature + p[0] * cosine, sine / curvature - 1.0 - p[0] * sine, p[2]];
        }
        let angle = self.degrees.to_radians() * part;
        let turn = Prescribed::Turn { axis: [0.0, 0.0, 1.0], angle, centre: [0.0; 3] };
        let [x, y, z] = turn.apply(p, 1.0);
        [x + self.shift * part, y, z]
    }
}

/// Steps of which the median time counts.
const REPEATS: usize = 9;

/// Moves a mesh in so many parts; the last points, and the mean seconds of a part.
fn moved(
    mesh: &Mesh,
    row: &Row,
    (options, steps): (&Options, usize),
    threads: &Threads,
) -> motet::Result<(Vec<Point>, f64)> {
    let (mut now, mut seconds) = (mesh.clone(), 0.0);
    for step in 1..=steps {
        let begin = Instant::now();
        let mover = Mover::new(&now, options, threads)?;
        let set_up = begin.elapsed().as_secs_f64();
        let driven: Vec<Point> = (mover.boundary().iter())
            .map(|v| {
                let first = mesh.points[v.index()];
                let to = if row.moves(first) { row.place(first, step as f64 / steps as f64) } else { first };
                sub(to, now.points[v.index()])
            })
            .collect();
        let mut out = now.points.clone();
        // A system begins with what the last step left: its first step counts.
        let once = !matches!(options.method, Method::Delaunay | Method::Bodies(_) | Method::Guided);
        let mut times = Vec::new();
        for _ in 0..if once { 1 } else { REPEATS } {
            let begin = Instant::now();
            mover.step(&driven, &mut out, threads)?;
            times.push(begin.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        // One step of a method that is set up once costs no more than the step.
        seconds += times[times.len() / 2] + if steps > 1 { set_up } else { 0.0 };
        now.points = out;
    }
    Ok((now.points, seconds / steps as f64))
}

fn told(mesh: &Mesh, points: &[Point]) -> String {
    let (mut bad, mut inverted, mut smallest) = (0, 0, f64::INFINITY);
    for (_, tet) in mesh.cells.tets() {
        let corners = tet.map(|v| points[v.index()]);
        bad += usize::from(eas(corners) < BAD_EAS);
        if volume(corners) <= 0.0 {
            inverted += 1;
        } else {
            smallest = smallest.min(dihedral::min(corners));
        }
    }
    format!("{bad} [{inverted}] {:.1}", smallest.to_degrees())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut size, mut only, mut sweeps, mut n_threads) = ("22,10".to_string(), String::new(), 0, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--only" => only = value()?,
            "--smooth" => sweeps = value()?.parse()?,
            "--threads" => n_threads = value()?.parse()?,
            _ => size = word,
        }
    }
    let mesh = match size.split_once(',') {
        Some((n, layers)) => shapes::sphere_in_box(n.parse()?, layers.parse()?),
        None => motet::io::read(&size)?,
    };
    let threads = Threads::new(n_threads)?;
    println!(
        "{} vertices, {} tets; as it came: {}\n",
        mesh.points.len(),
        mesh.cells.tets().count(),
        told(&mesh, &mesh.points)
    );
    let elastic = Method::Elastic(Elastic::default());
    let laplace = Method::Laplace(Laplace::default());
    let methods = [
        ("graph", Method::Delaunay, false),
        ("guided", Method::Guided, false),
        ("bodies", Method::Bodies(Vec::new()), false),
        ("elastic", elastic.clone(), false),
        ("laplace", laplace, false),
        ("idw", Method::InverseDistance, false),
        ("rbf", Method::Radial, false),
        ("elastic in steps", elastic, true),
    ];
    let rows = if size.contains("flap") { &FLAP[..] } else { &ROWS };
    let titles: Vec<&str> = rows.iter().map(|row| row.name).collect();
    println!("| method | {} |\n|---|{}", titles.join(" | "), "---|".repeat(rows.len()));
    for (name, method, in_steps) in methods {
        // The flap hangs on the wall: it is no body of its own.
        if !name.contains(&only) || (name == "bodies" && rows.len() == FLAP.len()) {
            continue;
        }
        let options = Options { method, smoothing: sweeps, ..Options::default() };
        let mut cells = Vec::new();
        for row in rows {
            let (points, seconds) =
                moved(&mesh, row, (&options, if in_steps { row.steps } else { 1 }), &threads)?;
            cells.push(format!("{}; {seconds:.2e} s", told(&mesh, &points)));
        }
        println!("| {name} | {} |", cells.join(" | "));
    }
    Ok(())
}
