//! Quality of meshes moved by different methods, and the time of a step: a sphere in a box that shifts and
//! turns, a flap and a vessel that bend, a measured wall.
//!
//! `motion_quality [N,LAYERS|FILE] [--motion sphere|flap|vessel|frames] [--threads N] [--only WORD] [--row
//! WORD] [--smooth SWEEPS]` prints a table; `22,10` has 32,000 vertices. The sphere has radius 1 and its
//! centre at the origin; the flap stands on the floor `y = -1`; the vessel extends along `z` from 0; a
//! measured mesh has point arrays `frame_1`, `frame_2`, ... with the positions of its boundary in each frame.
//! Each cell lists bad tets (EAS below 0.2), with inverted ones in brackets; the smallest dihedral angle of
//! the others in degrees; the worst EAS, and its 5 % quantile; seconds. "In steps": a tenth of a radius, five
//! degrees or a frame at a time, the method set up anew on the mesh of the step before. "In legs": likewise,
//! but by a radius, 45 degrees or four frames.

use std::error::Error;
use std::time::Instant;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::{dihedral, eas};
use motet::geometry::tet::volume;
use motet::geometry::vector::{norm, sub};
use motet::mesh::{BAD_EAS, Mesh, shapes};
use motet::motion::{Elastic, Laplace, Method, Mover, Options, Prescribed};

/// A whole motion.
struct Row {
    name: String,
    steps: usize,
    legs: usize,
    motion: Motion,
}

enum Motion {
    /// The sphere moves along x and turns about z.
    Sphere { shift: f64, degrees: f64 },
    /// The flap becomes an arc of this many degrees.
    Flap { degrees: f64 },
    /// The vessel's axis becomes an arc, and its cross-sections turn about it, the more the farther along.
    Vessel { bend: f64, twist: f64 },
    /// The boundary in frames 0 to the last one.
    Frames(Vec<Vec<Point>>),
}

fn rows(motion: &str, mesh: &Mesh) -> Result<Vec<Row>, Box<dyn Error>> {
    let sphere = |name: &str, steps, legs, shift, degrees| Row {
        name: name.into(),
        steps,
        legs,
        motion: Motion::Sphere { shift, degrees },
    };
    Ok(match motion {
        "sphere" => vec![
            sphere("0.5 radii", 5, 1, 0.5, 0.0),
            sphere("1 radius", 10, 1, 1.0, 0.0),
            sphere("2 radii", 20, 2, 2.0, 0.0),
            sphere("3 radii", 30, 3, 3.0, 0.0),
            sphere("15 degrees", 3, 1, 0.0, 15.0),
            sphere("45 degrees", 9, 1, 0.0, 45.0),
            sphere("90 degrees", 18, 2, 0.0, 90.0),
            sphere("180 degrees", 36, 4, 0.0, 180.0),
        ],
        "flap" => [30, 45, 60, 90]
            .map(|degrees| Row {
                name: format!("flap {degrees} degrees"),
                steps: degrees / 5,
                legs: degrees.div_ceil(45),
                motion: Motion::Flap { degrees: degrees as f64 },
            })
            .into(),
        "vessel" => [(30, 0), (60, 0), (90, 0), (0, 45), (0, 90), (60, 60)]
            .map(|(bend, twist): (usize, usize)| Row {
                name: format!("bent {bend}, twisted {twist}"),
                steps: bend.max(twist) / 5,
                legs: bend.max(twist).div_ceil(45),
                motion: Motion::Vessel { bend: bend as f64, twist: twist as f64 },
            })
            .into(),
        "frames" => {
            let frames = frames(mesh);
            let parts = [frames.len() / 3, 2 * frames.len() / 3, frames.len() - 1];
            parts
                .map(|last| Row {
                    name: format!("frame {last}"),
                    steps: last,
                    legs: last.div_ceil(4),
                    motion: Motion::Frames(frames[..=last].to_vec()),
                })
                .into()
        }
        other => return Err(format!("unknown motion {other}").into()),
    })
}

/// The positions of the points at rest, and in each frame of the mesh.
fn frames(mesh: &Mesh) -> Vec<Vec<Point>> {
    let mut frames = vec![mesh.points.clone()];
    while let Some(field) = mesh.point_field(&format!("frame_{}", frames.len())) {
        let numbers = field.values.to_f64().expect("places are numbers");
        frames.push(numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect());
    }
    frames
}

impl Motion {
    /// The position of a boundary vertex after a part of the motion; `p` is its reference position.
    fn place(&self, v: VertexId, p: Point, part: f64) -> Point {
        match self {
            Self::Sphere { shift, degrees } if norm(p) < 1.2 => {
                let turn = Prescribed::Turn {
                    axis: [0.0, 0.0, 1.0],
                    angle: degrees.to_radians() * part,
                    centre: [0.0; 3],
                };
                let [x, y, z] = turn.apply(p, 1.0);
                [x + shift * part, y, z]
            }
            Self::Flap { degrees } if p[0].abs() < 0.0301 && p[1] < 1e-6 && p[2].abs() < 0.5001 => {
                let (across, along) = arc(degrees.to_radians() * part, p[0], p[1] + 1.0);
                [across, along - 1.0, p[2]]
            }
            Self::Sphere { .. } | Self::Flap { .. } => p,
            Self::Vessel { bend, twist } => {
                let (sine, cosine) = (twist.to_radians() * part * p[2] / VESSEL).sin_cos();
                let [x, y] = [cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]];
                let (across, along) = arc(bend.to_radians() * part / VESSEL, x, p[2]);
                [across, y, along]
            }
            Self::Frames(frames) => frames[((frames.len() - 1) as f64 * part).round() as usize][v.index()],
        }
    }
}

/// Length of the vessel.
const VESSEL: f64 = 10.0;

/// Bends a line to an arc: the new position of the point `along` it and `across` it.
fn arc(curvature: f64, across: f64, along: f64) -> (f64, f64) {
    if curvature == 0.0 {
        return (across, along);
    }
    let (sine, cosine) = (curvature * along).sin_cos();
    ((1.0 - cosine) / curvature + across * cosine, sine / curvature - across * sine)
}

/// Number of steps of which the median time is taken.
const REPEATS: usize = 9;

/// Moves a mesh in `steps` parts; returns the last points, and the mean seconds per part.
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
                let to = row.motion.place(*v, mesh.points[v.index()], step as f64 / steps as f64);
                sub(to, now.points[v.index()])
            })
            .collect();
        let mut out = now.points.clone();
        // Solving a system starts from the last step's solution, so only the first step counts.
        let once = !matches!(options.method, Method::Delaunay | Method::Bodies(_) | Method::Guided);
        let mut times = Vec::new();
        for _ in 0..if once { 1 } else { REPEATS } {
            let begin = Instant::now();
            mover.step(&driven, &mut out, threads)?;
            times.push(begin.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        // A single step of a method that is set up once costs no more than the step.
        seconds += times[times.len() / 2] + if steps > 1 { set_up } else { 0.0 };
        now.points = out;
    }
    Ok((now.points, seconds / steps as f64))
}

fn summary(mesh: &Mesh, points: &[Point]) -> String {
    let (mut inverted, mut smallest, mut all) = (0, f64::INFINITY, Vec::new());
    for (_, tet) in mesh.cells.tets() {
        let corners = tet.map(|v| points[v.index()]);
        all.push(eas(corners));
        if volume(corners) <= 0.0 {
            inverted += 1;
        } else {
            smallest = smallest.min(dihedral::min(corners));
        }
    }
    all.sort_by(f64::total_cmp);
    let bad = all.partition_point(|&eas| eas < BAD_EAS);
    let (worst, twentieth) = (all[0], all[all.len() / 20]);
    format!("{bad} [{inverted}] {:.1}; {worst:.3}, {twentieth:.3}", smallest.to_degrees())
}

/// A time in three digits, in a suitable unit.
fn time(seconds: f64) -> String {
    let (number, unit) = match seconds {
        s if s >= 1.0 => (s, "s"),
        s if s >= 1e-3 => (s * 1e3, "ms"),
        s => (s * 1e6, "us"),
    };
    let digits = (2 - number.log10().floor() as i32).max(0) as usize;
    format!("{number:.digits$} {unit}")
}

/// How a motion is divided.
#[derive(Clone, Copy, PartialEq)]
enum Parts {
    One,
    Legs,
    Steps,
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut size, mut motion) = ("22,10".to_string(), "sphere".to_string());
    let (mut only, mut row_word, mut sweeps, mut n_threads) = (String::new(), String::new(), 0, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--motion" => motion = value()?,
            "--only" => only = value()?,
            "--row" => row_word = value()?,
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
        "{} vertices, {} tets; input: {}\n",
        mesh.points.len(),
        mesh.cells.tets().count(),
        summary(&mesh, &mesh.points)
    );
    let elastic = Method::Elastic(Elastic::default());
    let methods = [
        ("graph", Method::Delaunay, Parts::One),
        ("guided", Method::Guided, Parts::One),
        ("bodies", Method::Bodies(Vec::new()), Parts::One),
        ("elastic", elastic.clone(), Parts::One),
        ("laplace", Method::Laplace(Laplace::default()), Parts::One),
        ("idw", Method::InverseDistance, Parts::One),
        ("rbf", Method::Radial, Parts::One),
        ("graph in legs", Method::Delaunay, Parts::Legs),
        ("guided in legs", Method::Guided, Parts::Legs),
        ("bodies in legs", Method::Bodies(Vec::new()), Parts::Legs),
        ("elastic in steps", elastic, Parts::Steps),
    ];
    let mut rows = rows(&motion, &mesh)?;
    rows.retain(|row| row.name.contains(&row_word));
    let titles: Vec<&str> = rows.iter().map(|row| row.name.as_str()).collect();
    println!("| method | {} |\n|---|{}", titles.join(" | "), "---|".repeat(rows.len()));
    for (name, method, parts) in methods {
        // Only the sphere is a rigid body.
        if !name.contains(&only) || (name.starts_with("bodies") && motion != "sphere") {
            continue;
        }
        let options = Options { method, smoothing: sweeps, ..Options::default() };
        let mut cells = Vec::new();
        for row in &rows {
            let parts = match parts {
                Parts::One => 1,
                Parts::Legs if row.legs == 1 => {
                    cells.push(String::new());
                    continue;
                }
                Parts::Legs => row.legs,
                Parts::Steps => row.steps,
            };
            let (points, seconds) = moved(&mesh, row, (&options, parts), &threads)?;
            cells.push(format!("{}; {}", summary(&mesh, &points), time(seconds)));
        }
        println!("| {name} | {} |", cells.join(" | "));
    }
    Ok(())
}
