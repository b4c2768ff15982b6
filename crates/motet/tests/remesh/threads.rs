//! Remeshing on any number of threads gives the same bytes: searches made ahead find what those of one thread
//! find. With debug assertions each of them is made again and compared.

use crate::common::random::Random;
use motet::Mesh;
use motet::base::{Point, Threads};
use motet::mesh::history::Rules;
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{Field, Values};
use motet::moving::{self, MovingMesh};
use motet::remesh::{Density, Goal, Improve, Options, Sizes, SurfaceRule, remesh_mesh};
use proptest::prelude::*;

/// A box with two regions, whose vertices are moved at random by up to `shake` cells, those on sides within
/// them.
fn shaken(n: usize, shake: f64, seed: u64) -> Mesh {
    let mut mesh = box_grid([n; 3], [[0.0; 3], [1.0; 3]]);
    let mut random = Random(seed);
    for point in &mut mesh.points {
        for x in point.iter_mut().filter(|x| **x > 0.0 && **x < 1.0 && **x != 0.5) {
            *x += shake / n as f64 * random.between(-1.0, 1.0);
        }
    }
    let mut regions = vec![0i32; mesh.cells.len()];
    for (cell, tet) in mesh.cells.tets() {
        let middle = tet.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() / 4.0;
        regions[cell.index()] = if middle < 0.5 { 1 } else { 2 };
    }
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_point_field(Field::vectors("place", &mesh.points.clone()));
    mesh
}

/// Sizes from `low` to twice as much.
fn graded(mesh: &Mesh, low: f64) -> Vec<f64> {
    mesh.points.iter().map(|p| low * (1.0 + p[0])).collect()
}

/// Different tasks for a box of `n` cells along an edge.
fn tasks(mesh: &Mesh, n: usize) -> Vec<Options> {
    let cell = 1.0 / n as f64;
    let best = Options { goal: Goal::Best, ..Options::default() };
    let adapt = SurfaceRule::Adapt { distance: Some(0.05) };
    let sized = |sizes: Sizes| Options { sizes: Some(sizes), ..Options::default() };
    let ahead: Vec<Point> = mesh.points.iter().map(|p| [p[0] + 0.2 * cell * p[1], p[1], p[2]]).collect();
    let density = Density { sizes: graded(mesh, cell), lack: 0 };
    let improve = Improve {
        below: 0.75,
        raises_worst: true,
        density: Some(density),
        pose: Some(ahead),
        ..Improve::filled()
    };
    vec![
        Options::default(),
        best.clone(),
        Options { surface: adapt, ..best.clone() },
        Options { surface: SurfaceRule::Loose { distance: Some(0.05) }, min_eas: 0.3, ..best },
        sized(Sizes::Uniform(0.8 * cell)),
        Options { surface: adapt, ..sized(Sizes::Vertices(graded(mesh, 0.6 * cell))) },
        Options { goal: Goal::Coarsen, surface: adapt, ..sized(Sizes::Uniform(2.0 * cell)) },
        Options { improve: Some(improve), ..Options::default() },
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2))]

    #[test]
    fn threads_change_nothing(n in 3usize..5, shake in 0.2..0.75f64, seed in 1u64..1_000_000) {
        let n = 2 * n;
        let mesh = shaken(n, shake, seed);
        let pools = [2, 7, 3].map(|n| Threads::exactly(n).unwrap());
        for (i, options) in tasks(&mesh, n).iter().enumerate() {
            let on = |threads: &Threads| {
                let outcome = remesh_mesh(&mesh, options, &Rules::default(), threads);
                outcome.map(|outcome| (outcome.mesh, outcome.report.operations)).map_err(|e| e.to_string())
            };
            let threads = &pools[i % pools.len()];
            prop_assert!(on(threads) == on(&Threads::single()), "task {i} on {} threads", threads.count());
        }
    }
}

/// The sphere goes towards a wall and turns, and comes back.
#[test]
fn a_moving_mesh_changes_alike_on_any_number_of_threads() {
    let mesh = sphere_in_box(8, 6);
    let run = |threads: &Threads| {
        let mut moving = MovingMesh::new(&mesh, moving::Options::default(), threads).unwrap();
        let places = moving.driven_places().to_vec();
        let (mut states, mut n_changes) = (Vec::new(), 0);
        for step in 1..=6 {
            let phase = (std::f64::consts::PI * f64::from(step) / 6.0).sin();
            let (sin, cos) = (1.2 * phase).sin_cos();
            let displacement: Vec<Point> = (places.iter())
                .map(|&[x, y, z]| match x.abs().max(y.abs()).max(z.abs()) < 1.01 {
                    true => [cos * x - sin * y - x + 0.9 * phase, sin * x + cos * y - y, 0.4 * phase],
                    false => [0.0; 3],
                })
                .collect();
            let step = moving.advance(f64::from(step), &displacement, threads).unwrap();
            n_changes += step.changes.len();
            states.push((moving.mesh().clone(), step.quality));
        }
        assert!(n_changes > 1, "{n_changes} changes");
        states
    };
    let expected = run(&Threads::single());
    for n in [2, 7] {
        assert!(run(&Threads::exactly(n).unwrap()) == expected, "{n} threads");
    }
}

/// Arrays are carried alike, too.
#[test]
fn arrays_do_not_depend_on_the_threads() {
    let mesh = shaken(8, 0.7, 5);
    let on = |n: usize| {
        let threads = Threads::exactly(n).unwrap();
        let outcome = remesh_mesh(&mesh, &tasks(&mesh, 8)[1], &Rules::default(), &threads).unwrap();
        outcome.mesh.point_data.iter().map(|field| field.values.clone()).collect::<Vec<Values>>()
    };
    assert_eq!(on(1), on(3));
}
