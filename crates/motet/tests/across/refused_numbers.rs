//! Invalid numbers in options are refused before any work, whatever their effect would be.

use motet::Error;
use motet::base::Threads;
use motet::contact;
use motet::mesh::history::Rules;
use motet::mesh::shapes::{Coil, TubeOptions, sphere_in_box};
use motet::motion::{self, Extent, Motion, Mover, RigidLayer};
use motet::moving::{self, MovingMesh, Watching};
use motet::refine::{Criterion, Limits, MeshRefinement, Wanted};

const WRONG: [f64; 3] = [f64::NAN, -1.0, f64::NEG_INFINITY];

fn refused<T>(outcome: motet::Result<T>, word: &str) {
    let error = outcome.err().unwrap_or_else(|| Error::input("was taken"));
    assert_eq!(error.kind(), motet::ErrorKind::Options, "{error}");
    assert!(error.to_string().contains(word), "{error}");
}

#[test]
fn rigid_layers_and_factors() {
    let (mesh, threads) = (sphere_in_box(2, 2), Threads::single());
    for wrong in WRONG.into_iter().chain([f64::INFINITY, 1e120]) {
        let layer = RigidLayer { extent: Extent::Distance(wrong), wall: None };
        let options = motion::Options { rigid_layer: Some(layer), ..Default::default() };
        refused(Mover::new(&mesh, &options, &threads), "rigid layer");
    }
    for factor_gib in WRONG {
        let words = Motion { factor_gib, ..Motion::default() };
        refused(words.options(&mesh), "factor");
    }
}

#[test]
fn watched_patches() {
    let (mesh, threads) = (sphere_in_box(2, 2), Threads::single());
    let watching = || Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options::default(),
        horizon: None,
        hold: None,
    };
    let with = |watch: Watching| {
        MovingMesh::new(&mesh, moving::Options { watch: Some(watch), ..Default::default() }, &threads)
    };
    assert!(with(watching()).is_ok());
    for wrong in WRONG {
        refused(with(Watching { hold: Some(wrong), ..watching() }), "kept apart");
        refused(with(Watching { horizon: Some(wrong), ..watching() }), "horizon");
        let options = contact::Options { warn: Some(wrong), ..Default::default() };
        refused(with(Watching { options, ..watching() }), "warning");
    }
    refused(with(Watching { hold: Some(1e120), ..watching() }), "kept apart");
}

#[test]
fn limits_of_refinement() {
    let (mesh, threads) = (sphere_in_box(2, 2), Threads::single());
    for wrong in WRONG {
        let mut refinement = MeshRefinement::new(&mesh, Default::default(), &threads).unwrap();
        let limits = Limits { smallest: Some(wrong), ..Limits::default() };
        let wanted = Wanted { criteria: vec![Criterion::All], limits, ..Wanted::default() };
        refused(refinement.reach(&wanted, &Rules::default(), &threads, |_| ()), "smallest");
        let mut moving = MovingMesh::new(&mesh, moving::Options::default(), &threads).unwrap();
        refused(moving.coarsen(wrong, &threads), "smallest");
    }
}

#[test]
fn shapes_of_too_many_points_and_of_no_size() {
    let coil = |turns| Coil { centre: [0.0; 3], radius: 1.0, pitch: 0.3, turns, wire_radius: 0.1 };
    // With no sides there are no surface points, but the centre line has points.
    for (turns, steps, around) in [(1e9, 16, 8), (1e9, 16, 0), (1.0, usize::MAX, 0), (1.0, 16, usize::MAX)] {
        refused(coil(turns).mesh(steps, around), "points");
    }
    let tube = TubeOptions::default();
    assert!(tube.check().is_ok());
    refused(TubeOptions { wall_layers: 10, ..tube.clone() }.check(), "no space");
    refused(TubeOptions { wall_layers: usize::MAX, ..tube.clone() }.check(), "points");
    refused(TubeOptions { n: 0, ..tube.clone() }.check(), "1 or more");
    refused(TubeOptions { n: usize::MAX, ..tube.clone() }.check(), "points");
    for wrong in WRONG {
        refused(TubeOptions { radius: wrong, ..tube.clone() }.check(), "radius");
        refused(TubeOptions { growth: wrong, wall_layers: 2, ..tube.clone() }.check(), "growth");
    }
}
