//! Motion by a linear system: patch tests, least energy, rigid motions, sub-steps, bad input.

use crate::stepped::mover;
use motet::Mesh;
use motet::algebra::Tolerance;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::tet::volume;
use motet::geometry::vector::{add, cross, distance, norm, sub};
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{CellKind, Cells};
use motet::motion::{
    Certificate, Elastic, Extent, FacetSet, Laplace, Method, Mover, Options, Prescribed, RigidLayer,
};

const TIGHT: Tolerance = Tolerance { residual: 1e-12, iterations: 10_000 };

fn elastic(stiffening: f64) -> Options {
    Options {
        method: Method::Elastic(Elastic { stiffening, tolerance: TIGHT, ..Elastic::default() }),
        ..Options::default()
    }
}

fn laplace(exponent: f64) -> Options {
    Options {
        method: Method::Laplace(Laplace { exponent, tolerance: TIGHT, ..Laplace::default() }),
        ..Options::default()
    }
}

/// The options with a factor that is kept.
fn factorised(options: Options) -> Options {
    let factor_bytes = 1 << 28;
    let method = match options.method {
        Method::Elastic(law) => Method::Elastic(Elastic { factor_bytes, ..law }),
        Method::Laplace(law) => Method::Laplace(Laplace { factor_bytes, ..law }),
        other => other,
    };
    Options { method, ..options }
}

fn step(mover: &Mover, displacement: impl Fn(Point) -> Point, threads: &Threads) -> Vec<Point> {
    let driven: Vec<Point> =
        mover.boundary().iter().map(|v| displacement(mover.reference()[v.index()])).collect();
    let mut out = vec![[f64::NAN; 3]; mover.reference().len()];
    mover.step(&driven, &mut out, threads).unwrap();
    out
}

/// The largest distance of the mesh from its image under a map that its boundary follows.
fn error(mesh: &Mesh, options: &Options, map: impl Fn(Point) -> Point) -> f64 {
    let moved = step(&mover(mesh, options), &map, &Threads::single());
    let expected = mesh.points.iter().map(|&p| add(p, map(p)));
    moved.iter().zip(expected).map(|(&p, q)| distance(p, q)).fold(0.0, f64::max)
}

fn is_sphere(p: Point) -> bool {
    norm(p) < 1.01
}

fn room() -> Mesh {
    sphere_in_box(8, 5)
}

#[test]
fn what_strains_nothing_is_exact() {
    let mesh = room();
    let shift = |_: Point| [0.3, -0.2, 0.1];
    // A small turn is a linear function without strain.
    let turn = |p: Point| cross([0.1, -0.2, 0.3], p);
    let affine =
        Prescribed::Affine([[1.13, 0.21, -0.08, 0.7], [-0.11, 0.92, 0.17, -1.3], [0.05, -0.24, 1.07, 0.2]]);
    assert!(error(&mesh, &elastic(1.0), shift) < 1e-9);
    assert!(error(&mesh, &elastic(1.0), turn) < 1e-9);
    assert!(error(&mesh, &laplace(1.0), shift) < 1e-9);
    // Uniform stiffness passes the patch test (Irons 1965).
    assert!(error(&mesh, &elastic(0.0), |p| affine.displacement(p, 1.0)) < 1e-9);
    assert!(error(&mesh, &laplace(0.0), |p| affine.displacement(p, 1.0)) < 1e-9);
    // Non-uniform stiffness does not: it is stiff where it should be.
    assert!(error(&mesh, &elastic(1.0), |p| affine.displacement(p, 1.0)) > 1e-3);
}

/// The elastic energy from the strain of each tet, by another formula than the matrix: deformed edges times
/// the inverse of the reference ones.
fn energy(mesh: &Mesh, moved: &[Point], law: &Elastic) -> f64 {
    let lambda = law.poisson / ((1.0 + law.poisson) * (1.0 - 2.0 * law.poisson));
    let mu = 0.5 / (1.0 + law.poisson);
    let mut sum = 0.0;
    for (_, tet) in mesh.cells.tets() {
        let at = |points: &[Point]| {
            let [a, b, c, d] = tet.map(|v| points[v.index()]);
            [sub(b, a), sub(c, a), sub(d, a)]
        };
        let [u, v, w] = at(&mesh.points);
        let det = norm_of_volume(u, v, w);
        let dual = [cross(v, w), cross(w, u), cross(u, v)].map(|n| n.map(|x| x / det));
        let change = at(moved);
        let gradient = |i: usize, j: usize| {
            let moved: f64 = (0..3).map(|k| change[k][i] * dual[k][j]).sum();
            moved - f64::from(u8::from(i == j))
        };
        let strain = |i: usize, j: usize| 0.5 * (gradient(i, j) + gradient(j, i));
        let trace: f64 = (0..3).map(|i| strain(i, i)).sum();
        let squares: f64 = (0..9).map(|k| strain(k / 3, k % 3).powi(2)).sum();
        let volume = det.abs() / 6.0;
        sum += volume.powf(1.0 - law.stiffening) * (0.5 * lambda * trace * trace + mu * squares);
    }
    sum
}

fn norm_of_volume(u: Point, v: Point, w: Point) -> f64 {
    let n = cross(v, w);
    u[0] * n[0] + u[1] * n[1] + u[2] * n[2]
}

#[test]
fn an_elastic_step_has_the_least_energy() {
    let mesh = room();
    let law = Elastic { tolerance: TIGHT, ..Elastic::default() };
    let mover = mover(&mesh, &elastic(law.stiffening));
    let moved = step(&mover, |p| if is_sphere(p) { [0.4, 0.3, 0.0] } else { [0.0; 3] }, &Threads::single());
    let least = energy(&mesh, &moved, &law);
    let inside: Vec<usize> = (0..mesh.points.len())
        .filter(|&v| mover.boundary().binary_search(&VertexId::new(v)).is_err())
        .collect();
    assert!(least > 0.0 && inside.len() > 100);
    for k in 0..20 {
        // At the minimum, the energy rises equally on both sides, and only quadratically.
        let shifted = |by: f64| {
            let mut points = moved.clone();
            for (i, &v) in inside.iter().enumerate().filter(|(i, _)| (i * 7 + k) % 20 < 5) {
                points[v][(i + k) % 3] += by;
            }
            energy(&mesh, &points, &law) - least
        };
        let (up, down) = (shifted(1e-3), shifted(-1e-3));
        assert!(up > 0.0 && down > 0.0, "{up} {down}");
        assert!((up - down).abs() < 1e-6 * (up + down), "{up} {down}");
    }
}

#[test]
fn the_number_of_threads_changes_no_bit_and_a_step_back_leads_back() {
    let mesh = sphere_in_box(15, 7);
    let away = |p: Point| if is_sphere(p) { [0.5, 0.2, 0.0] } else { [0.0; 3] };
    for options in [elastic(1.0), laplace(1.0)] {
        let one = step(&mover(&mesh, &options), away, &Threads::single());
        let mover = mover(&mesh, &options);
        let three = Threads::new(3).unwrap();
        assert!(one == step(&mover, away, &three));
        // The second time it starts from the solution.
        let again = step(&mover, away, &three);
        assert!(one.iter().zip(&again).all(|(p, q)| distance(*p, *q) < 1e-9));
        assert_eq!(step(&mover, |_| [0.0; 3], &three), mesh.points);
    }
}

fn advance(mesh: &Mesh, options: &Options, map: impl Fn(Point) -> Point) -> (Certificate, Vec<Point>) {
    let mut mover = mover(mesh, options);
    let driven: Vec<Point> = mover.boundary().iter().map(|v| map(mesh.points[v.index()])).collect();
    let mut out = mesh.points.clone();
    let certificate = mover.advance(&driven, &mut out, &Threads::single()).unwrap();
    for (v, d) in mover.boundary().iter().zip(&driven).filter(|_| certificate.complete) {
        assert_eq!(out[v.index()], add(mesh.points[v.index()], *d));
    }
    (certificate, out)
}

#[test]
fn a_sphere_goes_three_radii_and_turns_by_ninety_degrees_in_parts_that_invert_nothing() {
    let mesh = sphere_in_box(11, 6);
    let turn = Prescribed::Turn { axis: [0.0, 0.0, 1.0], angle: 90f64.to_radians(), centre: [0.0; 3] };
    let shift = |p: Point| if is_sphere(p) { [2.0, 0.0, 0.0] } else { [0.0; 3] };
    let turned = |p: Point| if is_sphere(p) { turn.displacement(p, 0.5) } else { [0.0; 3] };
    let [(shifted, _), (half, _)] =
        [advance(&mesh, &elastic(1.0), shift), advance(&mesh, &elastic(1.0), turned)];
    for certificate in [shifted, half] {
        assert!(certificate.complete && certificate.inverted == 0, "{certificate:?}");
        assert!(certificate.iterations > 0 && certificate.quality.worst_eas.unwrap().value > 0.0);
        assert_eq!(certificate.graph_tets_inverted, 0);
    }
    let (far, out) = advance(&mesh, &laplace(1.0), |p| if is_sphere(p) { [3.0, 0.0, 0.0] } else { [0.0; 3] });
    assert!(far.inverted == 0 && far.fraction > 0.2, "{far:?}");
    let all: f64 = mesh.cells.tets().map(|(_, tet)| volume(tet.map(|v| out[v.index()]))).sum();
    assert!(all > 0.0);
}

#[test]
fn a_rigid_layer_is_given_and_not_solved_for() {
    let mesh = sphere_in_box(8, 6);
    let sphere = FacetSet::of_patch(&mesh, mesh.patches().unwrap().find("sphere").unwrap());
    let rigid_layer = Some(RigidLayer { extent: Extent::Cells(1), wall: Some(sphere) });
    let mover = mover(&mesh, &Options { rigid_layer, ..elastic(1.0) });
    let setup = mover.setup();
    assert!(setup.layer > 0 && setup.solved + setup.layer + setup.driven == mesh.points.len());
    assert_eq!((setup.graph_nodes, setup.hanging), (0, 0));
    let turn = Prescribed::Turn { axis: [1.0, 1.0, 0.0], angle: 0.4, centre: [0.0; 3] };
    let moved =
        step(&mover, |p| if is_sphere(p) { turn.displacement(p, 1.0) } else { [0.0; 3] }, &Threads::single());
    let rigid = moved.iter().zip(&mesh.points).filter(|(m, p)| distance(**m, turn.apply(**p, 1.0)) < 1e-14);
    assert!(rigid.count() >= 2 * setup.layer);
    assert!(mover.weights(mover.boundary()[0]).is_none());
}

#[test]
fn cells_of_other_kinds_are_as_stiff_as_their_corners() {
    // Hexahedra, two by two by two, with a vertex inside.
    let n = 3;
    let points: Vec<Point> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(|x| f64::from(x as u8))).collect();
    let mut cells = Cells::default();
    for i in 0..8usize {
        let low = i % 2 + n * (i / 2 % 2) + n * n * (i / 4);
        let ring = [low, low + 1, low + 1 + n, low + n];
        let corners = ring.into_iter().chain(ring.map(|v| v + n * n));
        cells.push(CellKind::HEXAHEDRON, corners.map(VertexId::new).collect::<Vec<_>>());
    }
    let mesh = Mesh::new(points, cells);
    let map = Prescribed::Affine([[1.1, 0.2, 0.0, 0.3], [0.0, 0.9, 0.1, 0.0], [0.2, 0.0, 1.0, -0.1]]);
    assert!(error(&mesh, &elastic(1.0), |p| map.displacement(p, 1.0)) < 1e-9);
}

#[test]
fn what_cannot_be_solved_is_refused_with_a_remedy() {
    let mesh = room();
    let few = Tolerance { residual: 1e-12, iterations: 2 };
    let options = Options {
        method: Method::Elastic(Elastic { tolerance: few, ..Elastic::default() }),
        ..Options::default()
    };
    let mover = mover(&mesh, &options);
    let driven: Vec<Point> = (mover.boundary().iter())
        .map(|v| if is_sphere(mesh.points[v.index()]) { [0.5, 0.0, 0.0] } else { [0.0; 3] })
        .collect();
    let mut out = mesh.points.clone();
    let error = mover.step(&driven, &mut out, &Threads::single()).unwrap_err();
    assert!(error.what().contains("2 iterations") && error.remedy_text().is_some(), "{error}");
    for (poisson, stiffening, residual) in
        [(0.5, 1.0, 1e-6), (-0.1, 1.0, 1e-6), (0.3, f64::NAN, 1e-6), (0.3, 1.0, 0.0)]
    {
        let tolerance = Tolerance { residual, iterations: 10 };
        let method = Method::Elastic(Elastic { poisson, stiffening, tolerance, ..Elastic::default() });
        let options = Options { method, ..Options::default() };
        let error = Mover::new(&mesh, &options, &Threads::single()).unwrap_err();
        assert!(error.remedy_text().is_some(), "{error}");
    }
    // All cells flat: nothing resists.
    let mut flat = box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]);
    let middle = flat.points.iter().position(|p| p.iter().all(|x| (x - 0.5).abs() < 0.2)).unwrap();
    let at = VertexId::new(middle);
    let around: Vec<usize> =
        flat.cells.tets().filter(|(_, t)| t.contains(&at)).flat_map(|(_, t)| t.map(|v| v.index())).collect();
    around.into_iter().for_each(|v| flat.points[v][2] = 0.5);
    let error = Mover::new(&flat, &elastic(1.0), &Threads::single()).unwrap_err();
    assert!(error.what().contains("no cell with a volume") && error.remedy_text().is_some(), "{error}");
}

#[test]
fn a_factor_gives_what_iterations_give() {
    let mesh = room();
    let push = |p: Point| if is_sphere(p) { [0.4, 0.1, -0.2] } else { [0.0; 3] };
    for options in [elastic(1.0), laplace(1.0)] {
        let iterated = mover(&mesh, &options);
        let exact = mover(&mesh, &factorised(options));
        assert!(iterated.setup().factor_bytes == 0 && exact.setup().factor_bytes > 100_000);
        assert_eq!(iterated.setup().solved, exact.setup().solved);
        let first = step(&exact, push, &Threads::single());
        let other = step(&iterated, push, &Threads::single());
        assert!(first.iter().zip(&other).all(|(&p, &q)| distance(p, q) < 1e-9));
        // Independent of the steps between, and of the number of threads.
        step(&exact, |p| cross([0.0, 0.1, 0.2], p), &Threads::single());
        assert_eq!(step(&exact, push, &Threads::new(2).unwrap()), first);
    }
}

#[test]
fn a_factor_that_takes_too_much_is_not_made() {
    let mesh = room();
    let few = Elastic { factor_bytes: 100_000, tolerance: TIGHT, ..Elastic::default() };
    let options = Options { method: Method::Elastic(few), ..Options::default() };
    let mover = mover(&mesh, &options);
    assert_eq!(mover.setup().factor_bytes, 0);
    assert!(error(&mesh, &options, |_| [0.3, -0.2, 0.1]) < 1e-9);
}
