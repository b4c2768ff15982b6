//! Timing of mesh motion: set-up by stage, the update alone, a rebuild, and for comparison a memory copy.
//!
//! `motion_timing MESH|N,LAYERS [--threads N] [--seconds S] [--rigid-layer] [--turn DEGREES] [--travel X]
//! [--method NAME] [--residual R] [--factor GIB]` prints one JSON object. MESH is any mesh file; `15,7`,
//! `22,10`, `30,13` and `38,17` are the four sizes of the built-in sphere in a box. In each step the sphere
//! moves by half its radius, or turns by DEGREES. `--rigid-layer` adds a rigid layer of one cell at the whole
//! boundary. `--travel X` moves the sphere by X along x with `advance` and adds its certificate. NAME is
//! `delaunay` (default), `bodies`, `guided`, `elastic` or `laplace`; the systems of the last two are solved
//! to the residual R (1e-8), with a factorisation of at most GIB if given. Each step is along another axis
//! than the one before, so that no iteration starts from its solution.

use std::error::Error;
use std::time::Instant;

use motet::algebra::Tolerance;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::norm;
use motet::mesh::{Mesh, shapes};
use motet::motion::{Elastic, Extent, Laplace, Method, Mover, Options, Prescribed, RigidLayer};

struct Call {
    mesh: String,
    threads: usize,
    seconds: f64,
    rigid: bool,
    turn: Option<f64>,
    travel: Option<f64>,
    method: String,
    residual: f64,
    factor: f64,
}

impl Call {
    fn method(&self) -> Result<Method, Box<dyn Error>> {
        let tolerance = Tolerance { residual: self.residual, iterations: 10_000 };
        let factor_bytes = (self.factor * (1u64 << 30) as f64) as u64;
        Ok(match &self.method[..] {
            "delaunay" => Method::Delaunay,
            "bodies" => Method::Bodies(Vec::new()),
            "guided" => Method::Guided,
            "elastic" => Method::Elastic(Elastic { tolerance, factor_bytes, ..Elastic::default() }),
            "laplace" => Method::Laplace(Laplace { tolerance, factor_bytes, ..Laplace::default() }),
            other => return Err(format!("unknown method {other}").into()),
        })
    }
}

fn call() -> Result<Call, Box<dyn Error>> {
    let mut call = Call {
        mesh: "22,10".into(),
        threads: 1,
        seconds: 0.5,
        rigid: false,
        turn: None,
        travel: None,
        method: "delaunay".into(),
        residual: 1e-8,
        factor: 0.0,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--threads" => call.threads = value()?.parse()?,
            "--seconds" => call.seconds = value()?.parse()?,
            "--turn" => call.turn = Some(value()?.parse()?),
            "--travel" => call.travel = Some(value()?.parse()?),
            "--method" => call.method = value()?,
            "--residual" => call.residual = value()?.parse()?,
            "--factor" => call.factor = value()?.parse()?,
            "--rigid-layer" => call.rigid = true,
            _ => call.mesh = word,
        }
    }
    Ok(call)
}

fn load(name: &str) -> Result<Mesh, Box<dyn Error>> {
    match name.split_once(',') {
        Some((n, layers)) if !std::path::Path::new(name).exists() => {
            Ok(shapes::sphere_in_box(n.parse()?, layers.parse()?))
        }
        _ => Ok(motet::io::read(name)?),
    }
}

/// The shortest and the median time of many runs.
fn repeat(budget: f64, mut work: impl FnMut()) -> (f64, f64) {
    work();
    let begin = Instant::now();
    let mut all = Vec::new();
    while all.len() < 5 || begin.elapsed().as_secs_f64() < budget {
        let start = Instant::now();
        work();
        all.push(start.elapsed().as_secs_f64());
    }
    all.sort_by(f64::total_cmp);
    (all[0], all[all.len() / 2])
}

/// Bytes per second, read and written, of a copy of `bytes` bytes by all threads.
fn copy_speed(bytes: usize, threads: &Threads, budget: f64) -> f64 {
    let n = (bytes / 16).max(1);
    let from = vec![1.0f64; n];
    let mut to = vec![0.0f64; n];
    let part = n.div_ceil(threads.count());
    let (best, _) = repeat(budget, || {
        let parts = to.chunks_mut(part).zip(from.chunks(part)).collect();
        threads.each(parts, |(to, from)| to.copy_from_slice(from));
    });
    std::hint::black_box(&to);
    16.0 * n as f64 / best
}

fn main() -> Result<(), Box<dyn Error>> {
    let call = call()?;
    let mesh = load(&call.mesh)?;
    let threads = Threads::new(call.threads)?;
    let rigid_layer = call.rigid.then_some(RigidLayer { extent: Extent::Cells(1), wall: None });
    let options = Options { rigid_layer, method: call.method()?, ..Options::default() };

    let mut mover = Mover::new(&mesh, &options, &threads)?;
    let mut setups = vec![*mover.setup()];
    for _ in 0..if setups[0].seconds.total < 1.0 { 5 } else { 1 } {
        mover = Mover::new(&mesh, &options, &threads)?;
        setups.push(*mover.setup());
    }
    setups.sort_by(|a, b| a.seconds.total.total_cmp(&b.seconds.total));
    let setup = setups[0];

    let sphere = |v: &VertexId| norm(mesh.points[v.index()]) < 1.2;
    let by = |axis: usize, x: f64| -> Vec<Point> {
        let one = |v: &VertexId| std::array::from_fn(|k| if k == axis && sphere(v) { x } else { 0.0 });
        mover.boundary().iter().map(one).collect()
    };
    let about = |axis: usize, degrees: f64| -> Vec<Point> {
        let axis = std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 });
        let turn = Prescribed::Turn { axis, angle: degrees.to_radians(), centre: [0.0; 3] };
        let one = |v: &VertexId| match sphere(v) {
            true => turn.displacement(mesh.points[v.index()], 1.0),
            false => [0.0; 3],
        };
        mover.boundary().iter().map(one).collect()
    };
    let driven = [0, 1, 2].map(|axis| call.turn.map_or_else(|| by(axis, 0.5), |turn| about(axis, turn)));
    let mut out = mesh.points.clone();
    let mut axis = 0;
    let (best, median) = repeat(call.seconds, || {
        axis = (axis + 1) % 3;
        mover.step(&driven[axis], &mut out, &threads).expect("it fits");
    });
    let driven = by(0, 0.5);

    // What a step reads and writes once: positions before and after, nodes and weights of each vertex, and
    // each node's displacement as given and as used.
    let nodes = setup.driven + setup.layer;
    let bytes = mesh.points.len() * (24 + 24 + 16 + 24) + setup.driven * 24 + nodes * 32;
    let rebuild = (0..3).map(|_| {
        let start = Instant::now();
        mover.rebuild_and_step(&driven, &mut out, &threads).map(|()| start.elapsed().as_secs_f64())
    });
    let rebuild = rebuild.collect::<Result<Vec<_>, _>>()?.into_iter().fold(f64::INFINITY, f64::min);
    let mut json = serde_json::json!({
        "mesh": call.mesh,
        "threads": threads.count(),
        "vertices": mesh.points.len(),
        "cells": mesh.cells.len(),
        "boundary": setup.driven,
        "graph_nodes": setup.graph_nodes,
        "graph_tets": setup.graph_tets,
        "setup": setup,
        "setup_seconds": setup.seconds.total,
        "seconds": median,
        "best_seconds": best,
        "ns_per_vertex": median / mesh.points.len() as f64 * 1e9,
        "bytes": bytes,
        "gigabytes_per_second": bytes as f64 / median / 1e9,
        "copy_same_size_gigabytes_per_second": copy_speed(bytes, &threads, 0.2) / 1e9,
        "copy_memory_gigabytes_per_second": copy_speed(1 << 30, &threads, 0.5) / 1e9,
        "rebuild_seconds": rebuild,
    });
    if let Some(x) = call.travel {
        let driven = by(0, x);
        json["travel"] = x.into();
        let mut mover = mover;
        json["certificate"] = serde_json::to_value(mover.advance(&driven, &mut out, &threads)?)?;
    }
    println!("{json}");
    Ok(())
}
