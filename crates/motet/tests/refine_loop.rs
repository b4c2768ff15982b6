//! The loop of solving, sizes from the second derivatives of the solution, and adapting, against refinement everywhere. Files are what goes on from one
//! round to the next: each mesh remembers what was divided. The solver is a formula, so that the error is known.

use motet::Mesh;
use motet::base::{Point, TetId, Threads};
use motet::geometry::tet::{at, volume};
use motet::mesh::history::Rules;
use motet::mesh::shapes::{TubeOptions, tube};
use motet::mesh::{Field, TetMesh, TetPart};
use motet::refine::sizes::SizeLimits;
use motet::refine::wish::{coarser, marked};
use motet::refine::{Aim, HessianSizes, MeshRefinement, Options, Refinement};

/// A jet in a tube, with a thin rim, that ends halfway: the mean velocity along the tube.
fn jet([x, y, z]: Point) -> f64 {
    let down = |x: f64| 0.5 * (1.0 - x.tanh());
    down((x.hypot(y) - 0.35) / 0.05) * down((z - 2.5) / 0.3)
}

/// What a solver would say on this mesh.
fn solve(mesh: &mut Mesh) {
    let velocity: Vec<Point> = mesh.points.iter().map(|p| [0.0, 0.0, jet(*p)]).collect();
    let pressure: Vec<f64> = mesh.points.iter().map(|[_, _, z]| 0.5 * (5.0 - z)).collect();
    mesh.set_point_field(Field::vectors("velocity", &velocity));
    mesh.set_point_field(Field::scalars("pressure", pressure));
}

/// How far the velocity is from its linear interpolant: the root of the mean square and the most, at five places a tet.
fn error(mesh: &TetMesh) -> [f64; 2] {
    let (mut squares, mut weights, mut most) = (0.0f64, 0.0f64, 0.0f64);
    let (a, b) = (1.0 / 6.0, 0.5);
    let places = [[0.25; 4], [b, a, a, a], [a, b, a, a], [a, a, b, a], [a, a, a, b]];
    for tet in &mesh.tets {
        let corners = tet.map(|v| mesh.points[v.index()]);
        let weight = volume(corners).abs();
        for place in places {
            let linear: f64 = corners.iter().zip(place).map(|(p, w)| w * jet(*p)).sum();
            let off = (linear - jet(at(corners, place))).abs();
            squares += weight * off * off;
            weights += weight;
            most = most.max(off);
        }
    }
    [(squares / weights).sqrt(), most]
}

/// Of refinement everywhere, one generation after the other: tets, and errors.
fn everywhere(first: &TetMesh, generations: usize, threads: &Threads) -> Vec<(usize, [f64; 2])> {
    let mut refinement = Refinement::new(first, Options::default(), threads).unwrap();
    let mut found = vec![(first.tets.len(), error(first))];
    for _ in 0..generations {
        let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
        refinement.refine(&all, threads).unwrap();
        found.push((refinement.mesh().tets.len(), error(refinement.mesh())));
    }
    found
}

/// The mean error of refinement everywhere with so many tets: between two generations it goes with a power of their number.
fn with_as_many(found: &[(usize, [f64; 2])], n: usize) -> f64 {
    let k = (1..found.len() - 1).find(|&k| n <= found[k].0).unwrap_or(found.len() - 1);
    let [(n0, [e0, _]), (n1, [e1, _])] = [found[k - 1], found[k]];
    let power = (e1 / e0).ln() / (n1 as f64 / n0 as f64).ln();
    e0 * (n as f64 / n0 as f64).powf(power)
}

/// The mesh for the next solution. Sizes are found once, on the mesh of this one, and carried.
fn adapt(mesh: &Mesh, sizes: &HessianSizes, threads: &Threads) -> Mesh {
    let mut mesh = mesh.clone();
    let part = TetPart::of(&mesh).unwrap();
    let criterion = sizes.put(&mut mesh, &part, "size", threads).unwrap();
    let mut refinement = MeshRefinement::new(&mesh, Options::default(), threads).unwrap();
    let wishes = |of: &MeshRefinement| criterion.wishes(of.mesh(), &of.part(), threads).unwrap();
    loop {
        let before = refinement.refinement().mesh().tets.len();
        let back = coarser(&wishes(&refinement));
        let (summary, _) = refinement.coarsen(&back, &Rules::default(), threads).unwrap();
        if summary.n_tets == before {
            break;
        }
    }
    loop {
        let marks = marked(&wishes(&refinement));
        if marks.is_empty() {
            return refinement.with_memory(threads);
        }
        refinement.refine(&marks, &Rules::default(), threads).unwrap();
    }
}

#[test]
fn three_rounds_resolve_a_jet_twice_as_well_as_as_many_tets_everywhere() {
    let threads = Threads::single();
    let mut mesh = tube(&TubeOptions::default());
    let uniform = everywhere(&TetPart::of(&mesh).unwrap().mesh, 2, &threads);
    uniform.iter().for_each(|(n, [mean, most])| println!("all: {n} tets, error {mean:.2e}, most {most:.2e}"));
    let [mut last, mut part_of_uniform] = [uniform[0].1[0], 1.0];
    // Two and a half times as many tets from round to round: a coarse mesh says of the rim only about where it is.
    for n_tets in [10_000, 25_000, 60_000] {
        solve(&mut mesh);
        let arrays = vec!["pressure".into(), "velocity".into()];
        let sizes = HessianSizes { arrays, aim: Aim::Tets(n_tets), limits: SizeLimits::default() };
        mesh = adapt(&mesh, &sizes, &threads);
        let tets = TetPart::of(&mesh).unwrap().mesh;
        let [mean, most] = error(&tets);
        let expected = with_as_many(&uniform, tets.tets.len());
        println!("{} tets, error {mean:.2e}, most {most:.2e}; everywhere {expected:.2e}", tets.tets.len());
        assert!(mean < last);
        // What the closing adds comes on top.
        assert!(tets.tets.len() < n_tets + n_tets / 2);
        [last, part_of_uniform] = [mean, mean / expected];
    }
    assert!(part_of_uniform < 0.5, "{part_of_uniform}");
}

#[test]
fn sizes_that_are_put_are_finite_and_those_of_the_solution() {
    let threads = Threads::single();
    let mut mesh = tube(&TubeOptions::default());
    solve(&mut mesh);
    let part = TetPart::of(&mesh).unwrap();
    let limits = SizeLimits { growth: f64::INFINITY, ..SizeLimits::default() };
    let sizes = |array: &str| HessianSizes { arrays: vec![array.into()], aim: Aim::Error(0.05), limits };
    let expected = sizes("velocity").sizes(&mesh, &part, &threads).unwrap();
    sizes("velocity").put(&mut mesh, &part, "size", &threads).unwrap();
    let found = mesh.point_field("size").unwrap().values.to_f64().unwrap();
    // The tube is as long as 5 and as wide as 2.
    assert!(found.iter().zip(&expected).all(|(h, of)| *h == of.min(33f64.sqrt())));
    // The pressure does not bend.
    let criterion = sizes("pressure").put(&mut mesh, &part, "size", &threads).unwrap();
    assert!(mesh.point_field("size").unwrap().values.to_f64().unwrap().iter().all(|h| h.is_finite()));
    assert!(criterion.marks(&mesh, &part, &threads).unwrap().is_empty());
}
