//! The adaptation loop (solve, compute sizes from second derivatives, adapt), compared with uniform
//! refinement. Files carry the mesh from round to round, with the memory of divisions.

use crate::common::adaptation::{adapt, error, everywhere, solve, with_as_many};
use motet::Mesh;
use motet::base::{Point, Threads};
use motet::mesh::TetPart;
use motet::mesh::shapes::{TubeOptions, tube};
use motet::refine::sizes::SizeLimits;
use motet::refine::{Aim, HessianSizes};

/// A jet in a tube, with a thin rim, that ends halfway: the mean velocity along the tube.
fn jet([x, y, z]: Point) -> f64 {
    let down = |x: f64| 0.5 * (1.0 - x.tanh());
    down((x.hypot(y) - 0.35) / 0.05) * down((z - 2.5) / 0.3)
}

fn solved(mesh: &mut Mesh) {
    solve(mesh, jet, |[_, _, z]| 0.5 * (5.0 - z));
}

#[test]
fn three_rounds_resolve_a_jet_twice_as_well_as_as_many_tets_everywhere() {
    let threads = Threads::single();
    let mut mesh = tube(&TubeOptions::default());
    let uniform = everywhere(&TetPart::of(&mesh).unwrap().mesh, 90_000, jet, &threads).unwrap();
    uniform.iter().for_each(|[n, mean]| println!("all: {n} tets, error {mean:.2e}"));
    let [mut last, mut part_of_uniform] = [uniform[0][1], 1.0];
    // Two and a half times as many tets from round to round: a coarse mesh shows only roughly where the rim
    // is.
    for n_tets in [10_000, 25_000, 60_000] {
        solved(&mut mesh);
        let arrays = vec!["pressure".into(), "velocity".into()];
        let sizes = HessianSizes { arrays, aim: Aim::Tets(n_tets), limits: SizeLimits::default() };
        adapt(&mut mesh, &sizes, usize::MAX, &threads).unwrap();
        let tets = TetPart::of(&mesh).unwrap().mesh;
        let [mean, most] = error(&tets, jet);
        let expected = with_as_many(&uniform, tets.tets.len() as f64);
        println!("{} tets, error {mean:.2e}, most {most:.2e}; everywhere {expected:.2e}", tets.tets.len());
        assert!(mean < last);
        // Tets of the closure are additional.
        assert!(tets.tets.len() < n_tets + n_tets / 2);
        [last, part_of_uniform] = [mean, mean / expected];
    }
    assert!(part_of_uniform < 0.5, "{part_of_uniform}");
}

#[test]
fn sizes_that_are_put_are_finite_and_those_of_the_solution() {
    let threads = Threads::single();
    let mut mesh = tube(&TubeOptions::default());
    solved(&mut mesh);
    let part = TetPart::of(&mesh).unwrap();
    let limits = SizeLimits { growth: f64::INFINITY, ..SizeLimits::default() };
    let sizes = |array: &str| HessianSizes { arrays: vec![array.into()], aim: Aim::Error(0.05), limits };
    let expected = sizes("velocity").sizes(&mesh, &part, &threads).unwrap();
    sizes("velocity").put(&mut mesh, &part, "size", &threads).unwrap();
    let found = mesh.point_field("size").unwrap().values.to_f64().unwrap();
    // The tube has length 5 and width 2.
    assert!(found.iter().zip(&expected).all(|(h, of)| *h == of.min(33f64.sqrt())));
    // The pressure has no second derivatives.
    let criterion = sizes("pressure").put(&mut mesh, &part, "size", &threads).unwrap();
    assert!(mesh.point_field("size").unwrap().values.to_f64().unwrap().iter().all(|h| h.is_finite()));
    assert!(criterion.marks(&mesh, &part, &threads).unwrap().is_empty());
}
