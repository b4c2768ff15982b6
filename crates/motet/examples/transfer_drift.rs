//! What a long motion makes of fields: a paddle turns in its box, and fields are carried through every change of the mesh; beside it, a new mesh of everything after each turn.
//!
//! `transfer_drift turn MESH [--turns N] [--steps N]` moves the patch `paddle` of MESH about z. `transfer_drift anew MESH [--turns N] [--each N] [--size H]` fills the walls of
//! MESH anew once a turn, or so often, and carries the fields from each mesh to the next one; it finds no other error on the way. Walls are the same; inside, each mesh is
//! of another lattice, since all is turned in space before it is filled. Seven meshes take turns. Both print a JSON object a turn.
//!
//! Fields are functions of the place, set once. Where vertices move, their values change by what the exact function differs between the two places, as a solver
//! without any error would have it; where the mesh changes, values are interpolated. So what is off is what changes have made of the field, and all of them together.
//!
//! - `linear`: how far a linear function is off, at most, as a part of its range.
//! - `smooth`: of `sin(pi x / 2) cos(pi y / 2) + z^2`, the L2 norm of the field less the interpolant of the exact function on the same mesh, over the norm of the function.
//! - `own`: the L2 norm of that interpolant less the function, likewise: what no mesh of this size can avoid.
//! - `conserved`: over single changes, by how much the integral of a density is off, at most; `contents`: the same over all, for one that stays in its cells while they move.

#[path = "common/carried.rs"]
mod carried;

use std::error::Error;
use std::f64::consts::TAU;

use carried::{Carried, integral};
use motet::base::{Point, Threads, VertexId};
use motet::geometry::tet;
use motet::io;
use motet::mesh::{Field, Mesh};
use motet::meshing::{self, Dividing, Sizes, Surfaces, fill};
use motet::motion::{FacetSet, Method, Prescribed, Strain};
use motet::moving::{InTime, Motion, MovingMesh, Options, Script, Step};
use motet::preflight::Role;
use motet::spatial::BoxTree;
use serde_json::json;

struct Call {
    how: String,
    mesh: String,
    turns: usize,
    steps: usize,
    /// New meshes a turn.
    each: usize,
    size: f64,
}

const USAGE: &str = "transfer_drift turn MESH, or anew MESH";

fn call() -> Result<Call, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let [how, mesh] = [words.next(), words.next()].map(|word| word.ok_or(USAGE));
    let mut call = Call { how: how?, mesh: mesh?, turns: 3, steps: 72, each: 1, size: 0.25 };
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        match word.as_str() {
            "--turns" => call.turns = value.parse()?,
            "--steps" => call.steps = value.parse()?,
            "--each" => call.each = value.parse()?,
            "--size" => call.size = value.parse()?,
            _ => return Err(format!("what is {word}? {USAGE}").into()),
        }
    }
    Ok(call)
}

fn main() -> Result<(), Box<dyn Error>> {
    let call = call()?;
    let mesh = io::read(&call.mesh)?;
    match call.how.as_str() {
        "turn" => turn(&mesh, call.turns, call.steps),
        "anew" => anew(&mesh, call.turns, call.each, call.size),
        _ => Err(USAGE.into()),
    }
}

const CONTENTS: &str = "contents";

/// Something that is not the same everywhere, above 0.
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

fn turn(mesh: &Mesh, turns: usize, steps: usize) -> Result<(), Box<dyn Error>> {
    let threads = Threads::single();
    let mut given = mesh.clone();
    given.set_cell_field(density_field(CONTENTS, mesh));
    let motion = Motion {
        method: Method::Bodies(Vec::new()),
        strain: Strain::Band,
        smoothing: 2,
        ..Motion::default()
    };
    let mut script = Script::still(&motion.driven(mesh), &mesh.points);
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
            return Err(format!("step {k} stopped on its way").into());
        }
        for change in &step.changes {
            carried.change(&change.points_before, &change.history)?;
        }
        conserved = conserved.max(conserved_by(&before, &moving, &step, &carried)?);
        changes += step.changes.len();
        carried.go_to(&moving.mesh().points);
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

/// The integral of what stays in its cells.
fn contents(mesh: &Mesh) -> Result<f64, Box<dyn Error>> {
    let values = mesh.cell_field(CONTENTS).and_then(|field| field.values.to_f64());
    Ok(integral(mesh, &mesh.points, &values.ok_or("no contents")?))
}

/// By how much the integral of a density changes across the change of a step; 0 where there is none, or more than one, between which there is no mesh to look at.
fn conserved_by(before: &Mesh, moving: &MovingMesh, step: &Step, now: &Carried) -> motet::Result<f64> {
    let [change] = step.changes.as_slice() else { return Ok(0.0) };
    let old = density_field("density", &Mesh { points: change.points_before.clone(), ..before.clone() });
    let new = change.history.transfer_cells(&old)?;
    let values = |field: &Field| field.values.to_f64().unwrap_or_default();
    let was = integral(before, &change.points_before, &values(&old));
    Ok((integral(moving.mesh(), now.places(), &values(&new)) / was - 1.0).abs())
}

/// Meshes that take turns.
const MESHES: usize = 7;

/// Each turn ends with the next mesh, or goes through so many.
fn anew(mesh: &Mesh, turns: usize, each: usize, size: f64) -> Result<(), Box<dyn Error>> {
    let filled = |k: usize| filled(mesh, 0.5 + k as f64, size);
    let meshes = (0..MESHES).map(filled).collect::<motet::Result<Vec<_>>>()?;
    let ways: Vec<_> = (0..MESHES).map(|k| parts(&meshes[k], &meshes[(k + 1) % MESHES])).collect();
    let mut carried = Carried::new(&meshes[0]);
    for k in 1..=turns * each {
        let new = &meshes[k % MESHES];
        carried.interpolate(&ways[(k - 1) % MESHES], &new.points);
        if k % each == 0 {
            let mut line = carried.measured(new);
            line["turn"] = json!(k / each);
            line["changes"] = json!(k);
            println!("{line}");
        }
    }
    Ok(())
}

/// The walls of a mesh about the origin, turned by an angle, filled, and turned back.
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

/// For each point of `new` the vertices of `old` that its value is a mean of, with their parts: those of the tet that holds it, or comes nearest to it.
fn parts(old: &Mesh, new: &Mesh) -> Vec<[(VertexId, f64); 4]> {
    let tets: Vec<[VertexId; 4]> = old.cells.tets().map(|(_, tet)| tet).collect();
    let corners = |t: usize| tets[t].map(|v| old.points[v.index()]);
    let reach = 1e-6;
    let bounds = |points: &[Point]| {
        let low = points.iter().fold([f64::INFINITY; 3], |a, p| [0, 1, 2].map(|k| a[k].min(p[k] - reach)));
        let high =
            points.iter().fold([f64::NEG_INFINITY; 3], |a, p| [0, 1, 2].map(|k| a[k].max(p[k] + reach)));
        [low, high]
    };
    let tree = BoxTree::new(&(0..tets.len()).map(|t| bounds(&corners(t))).collect::<Vec<_>>());
    let mut found = Vec::new();
    let of_point = |p: &Point| {
        found.clear();
        tree.touching(bounds(&[*p]), &mut found);
        let all = found.iter().map(|&t| (t as usize, barycentric(corners(t as usize), *p)));
        let least = |shares: &[f64; 4]| shares.iter().copied().fold(f64::INFINITY, f64::min);
        let best = all.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
        let (t, shares) = best.unwrap_or((0, [1.0, 0.0, 0.0, 0.0]));
        [0, 1, 2, 3].map(|i| (tets[t][i], shares[i]))
    };
    new.points.iter().map(of_point).collect()
}

/// The shares of the corners in a point.
fn barycentric(corners: [Point; 4], p: Point) -> [f64; 4] {
    let part = |i: usize| {
        let mut with = corners;
        with[i] = p;
        tet::volume(with)
    };
    let parts = [0, 1, 2, 3].map(part);
    let all: f64 = parts.iter().sum();
    parts.map(|part| part / all)
}
