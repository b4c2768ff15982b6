//! A watched call reports its progress, and can be stopped.

use motet::base::{Threads, Watch};
use motet::implant::{self, Device, Inside};
use motet::mesh::history::Rules;
use motet::mesh::{Mesh, shapes};
use motet::meshing::{self, Sizes, Surfaces};
use motet::motion::{self, Method, Mover, choose};
use motet::preflight::Role;
use motet::refine::{self, Criterion, MeshRefinement, Wanted};
use motet::remesh::{self, remesh_mesh};
use motet::{ErrorKind, Result};

type Verb = fn(&Threads) -> Result<()>;

/// Each verb that takes long, with its first stage.
const VERBS: &[(&str, Verb)] = &[
    ("joining tets", repair),
    ("joining tets", bring_to_sizes),
    ("choosing points inside", fill),
    ("building a new surface", conform),
    ("refining", refine),
    ("setting up a motion", set_up),
    ("trying methods", try_methods),
];

fn with(method: Method) -> motion::Options {
    motion::Options { method, ..motion::Options::default() }
}

/// A box with bad tets inside.
fn shaken() -> Mesh {
    let mut mesh = shapes::box_grid([6; 3], [[0.0; 3], [1.0; 3]]);
    for (i, p) in mesh.points.iter_mut().enumerate() {
        if p.iter().all(|x| (0.1..0.9).contains(x)) {
            let by = |k: usize| 0.05 * ((7 * i + 3 * k) as f64).sin();
            *p = std::array::from_fn(|k| p[k] + by(k));
        }
    }
    mesh
}

fn repair(threads: &Threads) -> Result<()> {
    remesh_mesh(&shaken(), &remesh::Options::default(), &Rules::default(), threads).map(drop)
}

fn bring_to_sizes(threads: &Threads) -> Result<()> {
    let options = remesh::Options { sizes: Some(remesh::Sizes::Uniform(0.05)), ..remesh::Options::default() };
    remesh_mesh(&shaken(), &options, &Rules::default(), threads).map(drop)
}

fn fill(threads: &Threads) -> Result<()> {
    let ball = shapes::ball(4, 4);
    let surfaces = Surfaces::new(&[(&ball, Role::Boundary, "wall")])?;
    let options = meshing::Options { sizes: Some(Sizes::Uniform(0.2)), ..meshing::Options::default() };
    meshing::fill(&surfaces, &surfaces.preflight(threads), &options, threads).map(drop)
}

fn conform(threads: &Threads) -> Result<()> {
    let device = shapes::box_grid([2; 3], [[0.3; 3], [0.7; 3]]);
    let devices = [Device { mesh: device, name: "cube".into(), inside: Inside::Filled }];
    let options = implant::Options {
        interface: implant::Interface::Conform { tolerance: Some(0.02) },
        ..implant::Options::default()
    };
    let host = shapes::box_grid([8; 3], [[0.0; 3], [1.0; 3]]);
    implant::implant(&host, &devices, &options, &Rules::default(), threads).map(drop)
}

fn refine(threads: &Threads) -> Result<()> {
    let wanted = Wanted { criteria: vec![Criterion::All], ..Wanted::default() };
    let mut refinement = MeshRefinement::new(&shaken(), refine::Options::default(), &Threads::single())?;
    refinement.reach(&wanted, &Rules::default(), threads, |_| ()).map(drop)
}

fn set_up(threads: &Threads) -> Result<()> {
    Mover::new(&shaken(), &with(Method::Guided), threads).map(drop)
}

fn try_methods(threads: &Threads) -> Result<()> {
    let frames = || Ok(std::iter::empty());
    choose(&shaken(), &with(Method::Delaunay), None, frames, threads).map(drop)
}

#[test]
fn what_is_reported_to_stop_stops_and_says_where() {
    for &(stage, verb) in VERBS {
        let watch = Watch::new();
        watch.stop();
        let error = verb(&Threads::single().watched(&watch)).expect_err("it was stopped");
        assert_eq!(error.kind(), ErrorKind::Stopped, "{stage}: {error}");
        assert_eq!(watch.progress().stage, stage);
        assert!(error.what().contains(stage), "{error}");
    }
}
