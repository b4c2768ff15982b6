//! Runs the small cases of `testdata` with the library; prints a name and a number per line.
//!
//! ```text
//! cases repair MESH PATCH DX DY DZ SMOOTH     a patch is shifted, bad tets are repaired, x is carried along
//! cases implant HOST DEVICE NAME
//! cases contact SURFACE SURFACE
//! cases loop MESH PATCH DX DY DZ STEPS        a patch goes away in steps and comes back, repaired on the way; saved and loaded where it turns
//! ```

use motet::base::{Point, Threads, VertexId};
use motet::contact::{self, Body, Contact, Room};
use motet::geometry::quality::eas;
use motet::implant::{self, Device};
use motet::mesh::history::Rules;
use motet::mesh::{CellKind, Field};
use motet::motion::{self, FacetSet, Motion, Mover};
use motet::moving::{self, MovingMesh};
use motet::{Error, Mesh, Result, io, remesh};

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["repair", mesh, patch, dx, dy, dz, smooth] => repair(mesh, patch, [dx, dy, dz], smooth),
        ["implant", host, device, name] => put_in(host, device, name),
        ["contact", first, second] => measure(first, second),
        ["loop", mesh, patch, dx, dy, dz, steps] => there_and_back(mesh, patch, [dx, dy, dz], steps),
        _ => Err(Error::options("see the usage at the top of this file")),
    }
}

fn print_value(name: &str, value: f64) {
    println!("{name} {value:?}");
}

fn number(text: &str) -> Result<f64> {
    text.parse().map_err(|_| Error::options(format!("{text} is not a number")))
}

fn print_mesh(mesh: &Mesh) {
    let [x, y, z] = mesh.points.iter().fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p[k]));
    let tets = mesh.cells.tets().map(|(_, tet)| eas(tet.map(|v| mesh.points[v.index()])));
    print_value("points", mesh.points.len() as f64);
    print_value("tets", tets.clone().count() as f64);
    print_value("sum_x", x);
    print_value("sum_y", y);
    print_value("sum_z", z);
    print_value("worst_eas", tets.fold(1.0, f64::min));
}

fn repair(mesh: &str, patch: &str, by: [&str; 3], smooth: &str) -> Result<()> {
    let threads = Threads::single();
    let mut mesh = io::read(mesh)?;
    let patch = FacetSet::find(&mesh, patch)?;
    let by: Point = [number(by[0])?, number(by[1])?, number(by[2])?];
    let options = motion::Options { smoothing: number(smooth)? as usize, ..motion::Options::default() };
    let mut mover = Mover::new(&mesh, &options, &threads)?;
    let is_shifted = |v: &VertexId| patch.vertices.binary_search(v).is_ok();
    let displacement: Vec<Point> =
        mover.boundary().iter().map(|v| if is_shifted(v) { by } else { [0.0; 3] }).collect();
    let certificate = mover.advance(&displacement, &mut mesh.points, &threads)?;
    print_value("complete", f64::from(certificate.complete));
    print_value("bad_after_motion", certificate.quality.bad as f64);
    print_value("worst_after_motion", certificate.quality.worst_eas.map_or(1.0, |worst| worst.value));
    let options = remesh::Options::default();
    let done = remesh::remesh_mesh(&mesh, &options, &Rules::default(), &threads)?;
    print_value("repaired", f64::from(done.report.is_complete()));
    print_mesh(&done.mesh);
    let x = Field::scalars("x", mesh.points.iter().map(|p| p[0]).collect::<Vec<f64>>());
    let carried = done.history.transfer_points(&x)?.values.to_f64().unwrap_or_default();
    print_value("sum_carried", carried.iter().sum());
    Ok(())
}

fn put_in(host: &str, device: &str, name: &str) -> Result<()> {
    let devices = [Device::new(io::read(device)?, name)];
    let (options, rules) = (implant::Options::default(), Rules::default());
    let done = implant::implant(&io::read(host)?, &devices, &options, &rules, &Threads::single())?;
    print_value("complete", f64::from(done.report.is_complete()));
    let region = done.mesh.regions().and_then(|regions| regions.find(name));
    print_value("region", region.map_or(-1.0, f64::from));
    print_mesh(&done.mesh);
    Ok(())
}

fn measure(first: &str, second: &str) -> Result<()> {
    let mut points = Vec::new();
    let mut bodies = Vec::new();
    for file in [first, second] {
        let mesh = io::read(file)?;
        let cells = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TRIANGLE);
        let shifted = |v: VertexId| VertexId::new(points.len() + v.index());
        let triangles = cells.map(|(_, _, t)| [t[0], t[1], t[2]].map(shifted)).collect();
        bodies.push(Body { name: file.to_owned(), triangles, room: Room::No });
        points.extend(mesh.points);
    }
    let threads = Threads::single();
    let mut contact = Contact::new(points, bodies, contact::Options::default(), &threads)?;
    let gaps = contact.measure(&threads);
    print_value("least", gaps.least());
    let mut sum = 0.0;
    gaps.bodies.iter().flat_map(|body| &body.gap).filter(|gap| gap.is_finite()).for_each(|gap| sum += gap);
    print_value("sum_of_gaps", sum);
    Ok(())
}

fn there_and_back(file: &str, patch: &str, by: [&str; 3], steps: &str) -> Result<()> {
    let threads = Threads::single();
    let mesh = io::read(file)?;
    let patch = FacetSet::find(&mesh, patch)?;
    let by: Point = [number(by[0])?, number(by[1])?, number(by[2])?];
    let n_steps = number(steps)?;
    let motion = Motion { smooth: 2, ..Motion::default() };
    let options = moving::Options { motion, ..moving::Options::default() };
    let driven = options.motion.driven(&mesh)?;
    let shifts: Vec<Point> = (driven.iter())
        .map(|v| if patch.vertices.binary_search(v).is_ok() { by } else { [0.0; 3] })
        .collect();
    let mut moving = MovingMesh::new(&mesh, options.clone(), &threads)?;
    let mut x = Field::scalars("x", mesh.points.iter().map(|p| p[0]).collect::<Vec<f64>>());
    let mut n_changes = 0;
    for k in 1..=2 * n_steps as usize {
        let time = k as f64;
        let part = time.min(2.0 * n_steps - time) / n_steps;
        let displacement: Vec<Point> = shifts.iter().map(|shift| shift.map(|d| part * d)).collect();
        n_changes += moving.advance(time, &displacement, &threads)?.changes.len();
        if let Some(history) = moving.history_since(k - 1)? {
            x = history.transfer_points(&x)?;
        }
        if time == n_steps {
            let state = format!("{file}.state.vtu");
            moving.save(&state)?;
            moving = MovingMesh::load(&state, options.clone(), &threads)?;
        }
    }
    print_value("changes", n_changes as f64);
    print_value("time", moving.time());
    print_value("sum_velocity", moving.velocity().iter().fold(0.0, |sum, v| sum + v[0]));
    print_value("sum_carried", x.values.to_f64().unwrap_or_default().iter().fold(0.0, |sum, x| sum + x));
    print_mesh(moving.mesh());
    Ok(())
}
