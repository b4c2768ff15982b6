//! The effect of a long motion on fields: a paddle turns in its box, and fields are carried through every
//! change of the mesh; for comparison, the whole box is filled anew after each turn.
//!
//! `transfer_drift turn MESH [--turns N] [--steps N] [--rule mean|linear]` moves the patch `paddle` of MESH
//! about z; fields on points are carried by the rule. `transfer_drift anew MESH [--turns N] [--each N]
//! [--size H] [--rule mean|linear]` fills the walls of MESH anew N times per turn (default 1), and carries
//! the fields from each mesh to the next; there is no other source of error. The walls are the same; the
//! interior points of each mesh come from another lattice, since everything is rotated before filling. Seven
//! meshes are used in rotation. Both print a JSON object per turn.
//!
//! Fields are functions of position, set once. Where vertices move, their values change by the difference of
//! the exact function between the two positions, as with an error-free solver; where the mesh changes, values
//! are interpolated. The errors are therefore those of all changes together.
//!
//! - `linear`: the maximum error of a linear function, relative to its range.
//! - `smooth`: for `sin(pi x / 2) cos(pi y / 2) + z^2`, the L2 norm of the difference between the field and
//!   the interpolant of the exact function on the same mesh, relative to the norm of the function.
//! - `own`: the L2 norm of the difference between that interpolant and the function, also relative:
//!   unavoidable on a mesh of this size.
//! - `conserved`: the maximum relative change of the integral of a density in a single change of the mesh;
//!   `contents`: the accumulated change, for a density that stays in its cells while they move.

#[path = "common/carried.rs"]
mod carried;

use std::error::Error;
use std::f64::consts::TAU;

use carried::{Carried, integral};
use motet::base::{MaybeId, Point, Threads};
use motet::geometry::tet;
use motet::io;
use motet::mesh::history::Rule;
use motet::mesh::{Field, Mesh};
use motet::meshing::{self, Dividing, Sizes, Surfaces, fill};
use motet::motion::{FacetSet, MethodName, Motion, Prescribed, Strain};
use motet::moving::{InTime, MovingMesh, Options, Script, Step};
use motet::preflight::Role;
use motet::spatial::trace;
use serde_json::json;

struct Call {
    how: String,
    mesh: String,
    turns: usize,
    steps: usize,
    /// Number of new meshes per turn.
    each: usize,
    size: f64,
    rule: Rule,
}

const USAGE: &str = "transfer_drift turn MESH, or anew MESH";

fn call() -> Result<Call, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let [how, mesh] = [words.next(), words.next()].map(|word| word.ok_or(USAGE));
    let mut call =
        Call { how: how?, mesh: mesh?, turns: 3, steps: 72, each: 1, size: 0.25, rule: Rule::Interpolate };
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        match word.as_str() {
            "--turns" => call.turns = value.parse()?,
            "--steps" => call.steps = value.parse()?,
            "--each" => call.each = value.parse()?,
            "--size" => call.size = value.parse()?,
            "--rule" if value == "mean" => call.rule = Rule::Interpolate,
            "--rule" if value == "linear" => call.rule = Rule::Linear,
            _ => return Err(format!("what is {word}? {USAGE}").into()),
        }
    }
    Ok(call)
}

fn main() -> Result<(), Box<dyn Error>> {
    let call = call()?;
    let mesh = io::read(&call.mesh)?;
    match call.how.as_str() {
        "turn" => turn(&mesh, &call),
        "anew" => refill(&mesh, &call),
        _ => Err(USAGE.into()),
    }
}

const CONTENTS: &str = "contents";

/// A density that varies in space, above 0.
fn density(p: Point) -> f64 {
    2.0 + p[0].sin() * p[1].cos()
}

fn density_field(name: &str, mesh: &Mesh) -> Field {
    let mut values = vec![0.0; mesh.cells.len()];
    for (cell, corners) in mesh.cells.tets() {
        values[cell.index()] = density(tet::centroid(corners.map(|v| mesh.points[v.index()])));
    }
    Field::scalars(name, values)
}

fn turn(mesh: &Mesh, &Call { turns, steps, rule, .. }: &Call) -> Result<(), Box<dyn Error>> {
    let threads = Threads::single();
    let mut given = mesh.clone();
    given.set_cell_field(density_field(CONTENTS, mesh));
    let motion =
        Motion { method: MethodName::Bodies, strain: Some(Strain::Band), smooth: 2, ..Motion::default() };
    let mut script = Script::still(&motion.driven(mesh)?, &mesh.points);
    let paddle = FacetSet::find(mesh, "paddle")?.vertices;
    let angle = TAU * turns as f64;
    let whole = Prescribed::Turn { axis: [0.0, 0.0, 1.0], angle, centre: [0.0; 3] };
    script.follow(&paddle, whole, InTime::Ramp)?;
    let options = Options { motion, contents: vec![CONTENTS.to_owned()], ..Options::default() };
    let mut moving = MovingMesh::new(&given, options, &threads)?;
    let mut carried = Carried::new(moving.mesh());
    let first = contents(moving.mesh())?;
    let (mut conserved, mut contents_off, mut changes) = (0.0_f64, 0.0_f64, 0);
    for k in 1..=turns * steps {
        let before = moving.mesh().clone();
        let phase = k as f64 / (turns * steps) as f64;
        let step = moving.advance(phase, &script.at(phase), &threads)?;
        if !step.complete {
            return Err(format!("step {k} ended early").into());
        }
        for change in &step.changes {
            carried.change(&change.points_before, &change.history, rule)?;
        }
        conserved = conserved.max(conserved_by(&before, &moving, &step, &carried)?);
        changes += step.changes.len();
        carried.move_to(&moving.mesh().points);
        contents_off = contents_off.max((contents(moving.mesh())? / first - 1.0).abs());
        if k % steps == 0 {
            let mut line = carried.measured(moving.mesh());
            line["turn"] = json!(k / steps);
            line["changes"] = json!(changes);
            line["conserved"] = json!(conserved);
            line["contents"] = json!(contents_off);
            println!("{line}");
        }
    }
    Ok(())
}

/// The integral of the contents, a density that stays in its cells.
fn contents(mesh: &Mesh) -> Result<f64, Box<dyn Error>> {
    let values = mesh.cell_field(CONTENTS).and_then(|field| field.values.to_f64());
    Ok(integral(mesh, &mesh.points, &values.ok_or("no contents")?))
}

/// The relative change of the integral of a density across the change in a step; 0 where there is no change,
/// or more than one, since the meshes between them are not available.
fn conserved_by(before: &Mesh, moving: &MovingMesh, step: &Step, now: &Carried) -> motet::Result<f64> {
    let [change] = step.changes.as_slice() else { return Ok(0.0) };
    let old = density_field("density", &Mesh { points: change.points_before.clone(), ..before.clone() });
    let new = change.history.transfer_cells(&old)?;
    let values = |field: &Field| field.values.to_f64().unwrap_or_default();
    let was = integral(before, &change.points_before, &values(&old));
    Ok((integral(moving.mesh(), now.places(), &values(&new)) / was - 1.0).abs())
}

/// Number of meshes used in rotation.
const MESHES: usize = 7;

/// Replaces the mesh by the next one `each` times per turn.
fn refill(mesh: &Mesh, &Call { turns, each, size, rule, .. }: &Call) -> Result<(), Box<dyn Error>> {
    let filled = |k: usize| filled(mesh, 0.5 + k as f64, size);
    let meshes = (0..MESHES).map(filled).collect::<motet::Result<Vec<_>>>()?;
    let way = |k: usize| {
        let (old, new) = (&meshes[k], &meshes[(k + 1) % MESHES]);
        let (vertices, cells) = (vec![MaybeId::NONE; new.points.len()], vec![MaybeId::NONE; new.cells.len()]);
        trace::between(old, new, &vertices, &cells, &Threads::single())
    };
    let ways = (0..MESHES).map(way).collect::<motet::Result<Vec<_>>>()?;
    let mut carried = Carried::new(&meshes[0]);
    for k in 1..=turns * each {
        let new = &meshes[k % MESHES];
        let before = carried.places().to_vec();
        carried.change(&before, &ways[(k - 1) % MESHES], rule)?;
        if k % each == 0 {
            let mut line = carried.measured(new);
            line["turn"] = json!(k / each);
            line["changes"] = json!(k);
            println!("{line}");
        }
    }
    Ok(())
}

/// The walls of a mesh about the origin, rotated by an angle, filled, and rotated back.
fn filled(mesh: &Mesh, angle: f64, size: f64) -> motet::Result<Mesh> {
    let threads = Threads::single();
    let turned = |angle: f64| {
        let turn = Prescribed::Turn { axis: [1.0, 2.0, 3.0], angle, centre: [0.0; 3] };
        move |p: &mut Point| *p = turn.apply(*p, 1.0)
    };
    let mut walls = mesh.clone();
    walls.points.iter_mut().for_each(turned(angle));
    let surfaces = Surfaces::new(&[(&walls, Role::Boundary, "walls")])?;
    let options = meshing::Options {
        dividing: Dividing::Never,
        holes: vec![[0.0; 3]],
        ..meshing::Options::with_sizes(Some(Sizes::Uniform(size)), None)
    };
    let mut filled = fill(&surfaces, &surfaces.preflight(&threads), &options, &threads)?.mesh;
    filled.points.iter_mut().for_each(turned(-angle));
    Ok(filled)
}
