//! Over long motions a mesh keeps its counts and its mean quality, and where a wall comes back, the mesh
//! itself is restored.

use crate::common::prism::{moved, prism};
use motet::base::{Point, Threads, VertexId};
use motet::geometry::rigid::Rigid;
use motet::geometry::vector::{distance, norm, sub};
use motet::mesh::history::{Rule, Rules};
use motet::mesh::shapes::box_grid;
use motet::mesh::{Boundary, CellKind, Cells, Field, Mesh, Qualities, Surface, mean_edge_lengths};
use motet::meshing::{self, Dividing, Sizes, Surfaces, fill};
use motet::motion::{MethodName, Motion, Strain};
use motet::moving::{MovingMesh, Options, Step, Why};
use motet::preflight::Role;
use motet::refine::{Criterion, Wanted};
use motet::remesh::{Density, Goal, Improve, SurfaceRule, remesh_mesh};

fn threads() -> Threads {
    Threads::single()
}

/// Half the sizes of the paddle.
const PADDLE: Point = [1.0, 1.0 / 3.0, 1.0 / 3.0];

/// A box of 4 by 4 by 2 with a paddle in it, about the origin.
fn paddle_in_box() -> Mesh {
    without(&box_grid([12, 12, 6], [[-2.0, -2.0, -1.0], [2.0, 2.0, 1.0]]), is_paddle)
}

/// A mesh without the tets whose centres are in a body about the origin.
fn without(grid: &Mesh, is_body: impl Fn(Point) -> bool) -> Mesh {
    let mut cells = Cells::new();
    for (_, tet) in grid.cells.tets().filter(|(_, tet)| !is_body(middle(grid, tet))) {
        cells.push(CellKind::TETRA, tet);
    }
    let mut mesh = Mesh::new(grid.points.clone(), cells);
    // Points within the body belong to no tet.
    let is_used: Vec<bool> = {
        let mut is_used = vec![false; mesh.points.len()];
        mesh.cells.tets().flat_map(|(_, tet)| tet).for_each(|v| is_used[v.index()] = true);
        is_used
    };
    mesh.points.iter_mut().zip(is_used).filter(|(_, used)| !used).for_each(|(p, _)| *p = [0.0; 3]);
    mesh
}

fn middle(mesh: &Mesh, vertices: &[VertexId]) -> Point {
    [0, 1, 2].map(|k| vertices.iter().map(|v| mesh.points[v.index()][k]).sum::<f64>() / vertices.len() as f64)
}

fn is_paddle(p: Point) -> bool {
    (0..3).all(|k| p[k].abs() < PADDLE[k] + 1e-9)
}

fn turned([x, y, z]: Point, angle: f64) -> Point {
    let (s, c) = angle.sin_cos();
    [c * x - s * y, s * x + c * y, z]
}

/// Rotates the paddle by an angle; the rest of the boundary stays.
fn turn(moving: &mut MovingMesh, time: f64, angle: f64) -> Step {
    let goes = |&p: &Point| {
        let to = if is_paddle(p) { turned(p, angle) } else { p };
        [to[0] - p[0], to[1] - p[1], to[2] - p[2]]
    };
    let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
    moving.advance(time, &displacement, &threads()).unwrap()
}

fn quality(mesh: &Mesh) -> Qualities {
    let tets: Vec<_> = mesh.cells.tets().map(|(_, tet)| tet).collect();
    Qualities::of(&mesh.points, &tets, &threads())
}

fn options(method: MethodName, strain: Option<Strain>) -> Options {
    Options { motion: Motion { method, strain, ..Motion::default() }, ..Options::default() }
}

/// How far counts may deviate from those of the first mesh, and how far the mean EAS may fall below that of
/// the first.
struct Limits {
    vertices: f64,
    tets: f64,
    mean: f64,
}

/// Rotates the paddle in steps of ten degrees.
fn turn_on(n_steps: i32, options: Options, limits: &Limits) {
    advance_and_check(&paddle_in_box(), n_steps, options, limits, |moving, k| {
        turn(moving, f64::from(k), f64::from(10 * k).to_radians())
    });
}

/// Moves a body in `n_steps` steps, checks counts and qualities after each, and returns the mesh.
fn advance_and_check(
    mesh: &Mesh,
    n_steps: i32,
    options: Options,
    limits: &Limits,
    advance: impl Fn(&mut MovingMesh, i32) -> Step,
) -> MovingMesh {
    let first = quality(mesh);
    let n_walls = Boundary::of(&mesh.cells).vertices.len();
    let mut moving = MovingMesh::new(mesh, options, &threads()).unwrap();
    let n_first = moving.mesh().cells.tets().count();
    for k in 1..=n_steps {
        let step = advance(&mut moving, k);
        assert!(step.complete && step.inverted == 0 && step.bad == 0, "{k}: {} bad", step.bad);
        let of = |n: usize, first: usize| (n as f64 / first as f64 - 1.0).abs();
        assert!(of(step.points, mesh.points.len()) < limits.vertices, "{k}: {} vertices", step.points);
        assert!(of(step.tets, n_first) < limits.tets, "{k}: {} tets of {n_first}", step.tets);
        assert!(step.quality.mean > first.mean - limits.mean, "{k}: {:?}, {first:?}", step.quality);
        assert_eq!(Some(step.quality.worst), step.worst.map(|worst| worst.eas));
    }
    assert_eq!(quality(moving.mesh()), moving.certify(&threads()).unwrap().quality);
    assert_eq!(Boundary::of(&moving.mesh().cells).vertices.len(), n_walls);
    moving
}

#[test]
fn a_paddle_that_turns_in_a_band_leaves_counts_and_quality_as_they_were() {
    // The mean EAS is 0.588 at first, the same for each tet of the lattice.
    let limits = Limits { vertices: 0.02, tets: 0.08, mean: 0.04 };
    turn_on(72, options(MethodName::Bodies, Some(Strain::Band)), &limits);
}

#[test]
fn a_paddle_that_turns_by_the_graph_leaves_counts_and_quality_as_they_were() {
    let limits = Limits { vertices: 0.03, tets: 0.12, mean: 0.1 };
    turn_on(36, options(MethodName::Delaunay, None), &limits);
}

#[test]
fn a_body_moved_along_a_channel_leaves_counts_and_quality_as_they_were() {
    let is_body = |p: Point| p.iter().all(|x| x.abs() < 0.35);
    let mesh = without(&box_grid([18, 6, 6], [[-1.0, -1.0, -1.0], [5.0, 1.0, 1.0]]), is_body);
    let advance = |moving: &mut MovingMesh, k: i32| {
        let goes = |&p: &Point| if is_body(p) { [0.1 * f64::from(k), 0.0, 0.0] } else { [0.0; 3] };
        let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
        moving.advance(f64::from(k), &displacement, &threads()).unwrap()
    };
    let limits = Limits { vertices: 0.02, tets: 0.06, mean: 0.04 };
    advance_and_check(&mesh, 38, options(MethodName::Bodies, Some(Strain::Band)), &limits, advance);
}

#[test]
fn a_body_that_tumbles_about_none_of_its_axes_leaves_counts_and_quality_as_they_were() {
    let half = [0.8, 1.6 / 3.0, 0.8 / 3.0];
    let is_body = |p: Point| (0..3).all(|k| p[k].abs() < half[k] + 1e-9);
    let mesh = without(&box_grid([12; 3], [[-1.6; 3], [1.6; 3]]), is_body);
    let advance = |moving: &mut MovingMesh, k: i32| {
        let axis = [1.0 / 3.0_f64.sqrt(); 3];
        let tumble = Rigid { centres: [[0.0; 3]; 2], axis, half_angle: f64::from(5 * k).to_radians() };
        let goes = |&p: &Point| if is_body(p) { sub(tumble.apply(p), p) } else { [0.0; 3] };
        let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
        moving.advance(f64::from(k), &displacement, &threads()).unwrap()
    };
    let limits = Limits { vertices: 0.02, tets: 0.06, mean: 0.04 };
    advance_and_check(&mesh, 36, options(MethodName::Bodies, Some(Strain::Band)), &limits, advance);
}

/// The patch of the interface of [`bar_in_box`].
const INTERFACE: i32 = 99;

/// A box whose tets within a bar are a region of their own, with triangles between the two regions.
fn bar_in_box() -> Mesh {
    let mut mesh = box_grid([12, 12, 6], [[-2.0, -2.0, -1.0], [2.0, 2.0, 1.0]]);
    let region = |vertices: &[VertexId]| 1 + i32::from(is_paddle(middle(&mesh, vertices)));
    let mut regions: Vec<i32> = mesh.cells.iter().map(|(_, _, vertices)| region(vertices)).collect();
    let mut patches = vec![0; mesh.cells.len()];
    for facet in Boundary::of(&without(&mesh, |p| !is_paddle(p)).cells).facets.iter() {
        mesh.cells.push(CellKind::TRIANGLE, facet.iter().copied());
        regions.push(0);
        patches.push(INTERFACE);
    }
    mesh.cell_data.clear();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

#[test]
fn a_bar_that_is_meshed_too_turns_and_leaves_counts_and_quality_as_they_were() {
    let motion = Motion { inside: vec![INTERFACE.to_string()], ..Motion::default() };
    let limits = Limits { vertices: 0.03, tets: 0.12, mean: 0.1 };
    advance_and_check(&bar_in_box(), 36, Options { motion, ..Options::default() }, &limits, |moving, k| {
        turn(moving, f64::from(k), f64::from(10 * k).to_radians())
    });
}

#[test]
fn a_bar_that_is_meshed_too_and_turns_as_a_body_keeps_its_tets() {
    let mesh = bar_in_box();
    let tets_of_bar = |mesh: &Mesh| -> Vec<[Point; 4]> {
        let regions = mesh.regions().unwrap().ids.clone();
        let of_bar = mesh.cells.tets().filter(|(cell, _)| regions[cell.index()] == 2);
        of_bar.map(|(_, tet)| tet.map(|v| mesh.points[v.index()])).collect()
    };
    let first = tets_of_bar(&mesh);
    let motion = Motion {
        inside: vec![INTERFACE.to_string()],
        ..options(MethodName::Bodies, Some(Strain::Band)).motion
    };
    let limits = Limits { vertices: 0.02, tets: 0.06, mean: 0.06 };
    let moving =
        advance_and_check(&mesh, 36, Options { motion, ..Options::default() }, &limits, |moving, k| {
            turn(moving, f64::from(k), f64::from(10 * k).to_radians())
        });
    // After a whole turn they are where they were.
    let last = tets_of_bar(moving.mesh());
    assert_eq!(last.len(), first.len());
    let is_same = |(a, b): (&[Point; 4], &[Point; 4])| (0..4).all(|i| distance(a[i], b[i]) < 1e-9);
    assert!(first.iter().zip(&last).all(is_same));
}

#[test]
fn what_is_far_from_a_body_stays_to_the_bit_where_a_band_takes_the_strain() {
    let mesh = paddle_in_box();
    let mut moving =
        MovingMesh::new(&mesh, options(MethodName::Bodies, Some(Strain::Band)), &threads()).unwrap();
    let step = turn(&mut moving, 1.0, 0.05);
    assert!(step.complete && step.changes.is_empty());
    let is_far = |p: &Point| (0..3).any(|k| p[k].abs() > PADDLE[k] + 0.6);
    let far = mesh.points.iter().zip(&moving.mesh().points).filter(|(p, _)| is_far(p));
    assert!(far.clone().count() > 100 && far.into_iter().all(|(was, is)| was == is));
}

#[test]
fn a_paddle_that_swings_keeps_counts_and_quality_cycle_after_cycle() {
    let mesh = paddle_in_box();
    let first = quality(&mesh);
    let mut moving = MovingMesh::new(&mesh, Options::default(), &threads()).unwrap();
    let n_tets = moving.mesh().cells.tets().count();
    let mut ends = Vec::new();
    for k in 1..=9 * 8 {
        let angle = (std::f64::consts::TAU * f64::from(k) / 8.0).sin() * 0.6;
        let step = turn(&mut moving, f64::from(k), angle);
        assert!(step.complete && step.bad == 0 && step.inverted == 0);
        if k % 8 == 0 {
            let off = |n: usize, first: usize| (n as f64 / first as f64 - 1.0).abs();
            assert!(off(step.points, mesh.points.len()) < 0.005, "{k}: {} vertices", step.points);
            assert!(off(step.tets, n_tets) < 0.05, "{k}: {} tets of {n_tets}", step.tets);
            assert!(step.quality.mean > first.mean - 0.02, "{k}: {first:?} {:?}", step.quality);
            ends.push(step.quality.mean);
        }
    }
    // From the second cycle on nothing is lost. The ends of single cycles differ by up to 0.04.
    let mean = |some: &[f64]| some.iter().sum::<f64>() / some.len() as f64;
    assert!((mean(&ends[1..5]) - mean(&ends[5..])).abs() < 0.02, "{ends:?}");
}

/// A box with a hole about the origin: a cylinder as a CAD program writes it, whose rims have edges of a
/// tenth of its radius and whose sides are thirty times as long.
fn cylinder_in_box() -> Mesh {
    let cylinder = moved(&prism(64, 1.0, 3.0), |[x, y, z]| [x, y, z - 1.5]);
    let walls = Surface::boundary_of(&box_grid([9; 3], [[-3.3; 3], [3.3; 3]]));
    let ids = walls.triangles.into_flattened();
    let walls = Mesh::new(walls.points, Cells::uniform(CellKind::TRIANGLE, ids).unwrap());
    let of = |mesh| (mesh, Role::Boundary, "");
    let surfaces = Surfaces::new(&[of(&walls), of(&cylinder)]).unwrap();
    let sizes = meshing::Options::with_sizes(Some(Sizes::Uniform(0.72)), None);
    let options = meshing::Options { holes: vec![[0.01, 0.02, 0.03]], dividing: Dividing::Always, ..sizes };
    fill(&surfaces, &surfaces.preflight(&threads()), &options, &threads()).unwrap().mesh
}

#[test]
fn a_cylinder_with_fine_rims_that_turns_keeps_counts_and_sizes() {
    let mesh = cylinder_in_box();
    let first = quality(&mesh);
    let options = options(MethodName::Bodies, Some(Strain::Band));
    let mut moving = MovingMesh::new(&mesh, options, &threads()).unwrap();
    let is_body: Vec<bool> = moving.driven_places().iter().map(|p| norm(*p) < 2.0).collect();
    for k in 1..=18 {
        let angle = f64::from(5 * k).to_radians();
        let goes = |(&[_, y, z], &is_body): (&Point, &bool)| {
            let [to_y, to_z, _] = turned([y, z, 0.0], if is_body { angle } else { 0.0 });
            [0.0, to_y - y, to_z - z]
        };
        let displacement: Vec<Point> = moving.driven_places().iter().zip(&is_body).map(goes).collect();
        let step = moving.advance(f64::from(k), &displacement, &threads()).unwrap();
        assert!(step.complete && step.inverted == 0);
        let off = step.points as f64 / mesh.points.len() as f64 - 1.0;
        assert!(off.abs() < 0.02, "{k}: {} vertices of {}", step.points, mesh.points.len());
        assert!(step.quality.mean > first.mean - 0.04, "{k}: {:?}, {first:?}", step.quality);
    }
    let [mean, spread] = edges(&mesh);
    let [mean_last, spread_last] = edges(moving.mesh());
    assert!((mean_last / mean - 1.0).abs() < 0.03, "{mean_last}, {mean} at first");
    assert!((spread_last / spread - 1.0).abs() < 0.06, "{spread_last}, {spread} at first");
}

/// The mean of the edge lengths at vertices, and the standard deviation of its logarithm.
fn edges(mesh: &Mesh) -> [f64; 2] {
    let mut lengths = mean_edge_lengths(&mesh.points, mesh.cells.tets().map(|(_, tet)| tet));
    lengths.retain(|length| *length > 0.0);
    let mean = |of: &dyn Fn(f64) -> f64| lengths.iter().map(|l| of(*l)).sum::<f64>() / lengths.len() as f64;
    let log = mean(&f64::ln);
    [mean(&|l| l), mean(&|l| (l.ln() - log).powi(2)).sqrt()]
}

/// Twists a cube of edge length 2 about z, its top against its bottom, to both sides, in eight steps per
/// cycle.
fn twist(moving: &mut MovingMesh, k: i32) -> Step {
    twist_by(moving, k, 0.75, 0.0)
}

/// Twists the cube by up to `most` to each side, and shifts it by `shift`. The same to the bit in each cycle.
fn twist_by(moving: &mut MovingMesh, k: i32, most: f64, shift: f64) -> Step {
    let far = (std::f64::consts::TAU * f64::from(k % 8) / 8.0).sin() * most;
    let goes = |&p: &Point| {
        let to = turned(p, far * p[2]);
        [to[0] - p[0] + shift, to[1] - p[1], to[2] - p[2]]
    };
    let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
    moving.advance(f64::from(k), &displacement, &threads()).unwrap()
}

fn that_returns() -> Options {
    Options { returns: true, ..options(MethodName::Delaunay, None) }
}

fn cube_that_returns() -> MovingMesh {
    let mesh = box_grid([7; 3], [[-1.0; 3], [1.0; 3]]);
    MovingMesh::new(&mesh, that_returns(), &threads()).unwrap()
}

#[test]
fn walls_that_come_back_leave_counts_and_quality_as_they_were() {
    let mut moving = cube_that_returns();
    let (n_first, first) = (moving.mesh().points.len(), quality(moving.mesh()));
    for k in 1..=6 * 8 {
        let step = twist(&mut moving, k);
        assert!(step.complete && step.inverted == 0 && step.bad == 0, "{k}: {} bad", step.bad);
        assert!((step.points as f64 / n_first as f64 - 1.0).abs() < 0.02, "{k}: {} points", step.points);
        if k % 8 == 0 {
            assert!(step.quality.mean > first.mean - 0.01, "{k}: {:?}, {first:?}", step.quality);
        }
    }
}

#[test]
fn walls_that_come_back_go_on_from_a_state_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtu");
    let mut moving = cube_that_returns();
    // Changed after the walls were at rest: the rest positions are not those of the first mesh.
    (1..=13).for_each(|k| _ = twist(&mut moving, k));
    moving.save(&path).unwrap();
    let mut again = MovingMesh::load(&path, that_returns(), &threads()).unwrap();
    let mut n_changes = 0;
    for k in 14..=40 {
        let [step, same] = [&mut moving, &mut again].map(|moving| twist(moving, k));
        n_changes += step.changes.len();
        assert_eq!((step.quality, step.tets), (same.quality, same.tets), "{k}");
    }
    assert!(n_changes > 0);
    assert_eq!(moving.mesh().points, again.mesh().points);
    assert_eq!(moving.mesh().cells, again.mesh().cells);
}

/// A cube with a twist of eight steps per cycle, whose mesh changes and gets worse in each cycle.
fn restless() -> MovingMesh {
    restless_with(that_returns())
}

fn restless_with(options: Options) -> MovingMesh {
    MovingMesh::new(&well_filled(RESTLESS.0), options, &threads()).unwrap()
}

/// A cube whose tets are as good as repair can make them: a lattice improves by each change.
fn well_filled(n: usize) -> Mesh {
    let mut mesh = box_grid([n; 3], [[-1.0; 3], [1.0; 3]]);
    for (i, p) in mesh.points.iter_mut().enumerate() {
        if p.iter().all(|x| x.abs() < 0.99) {
            (0..3).for_each(|k| p[k] += 0.3 / n as f64 * ((7 * i + 3 * k) as f64).sin());
        }
    }
    let best = motet::remesh::Options { goal: Goal::Best, ..Default::default() };
    remesh_mesh(&mesh, &best, &Rules::default(), &threads()).unwrap().mesh
}

/// The number of edges along a side, and the angle.
const RESTLESS: (usize, f64) = (5, 0.75);

fn twist_restless(moving: &mut MovingMesh, k: i32) -> Step {
    let step = twist_by(moving, k, RESTLESS.1, 0.0);
    assert!(step.complete && step.inverted == 0 && step.bad == 0, "{k}: {} bad", step.bad);
    step
}

fn is_put_back(step: &Step) -> bool {
    step.changes.iter().any(|change| change.why == Why::Return)
}

#[test]
fn where_a_mesh_does_not_settle_the_first_one_is_put_back_and_cycles_repeat_to_the_bit() {
    let mut moving = restless();
    let first = moving.mesh().clone();
    let (mut put_back, mut cycles) = (Vec::new(), [Vec::new(), Vec::new()]);
    for k in 1..=8 * 8 {
        let step = twist_restless(&mut moving, k);
        if is_put_back(&step) {
            put_back.push(k);
            assert!(k % 4 == 0 && moving.mesh().cells == first.cells, "{k}");
        }
        if k % 8 == 0 && !put_back.is_empty() {
            // Its walls are exactly where they were, and its path is the one from the first mesh.
            assert_eq!(moving.mesh().points, first.points, "{k}");
            assert!(step.changes.len() <= 1);
        }
        if k > 6 * 8 {
            cycles[usize::from(k > 7 * 8)].push((moving.mesh().clone(), step.quality));
        }
    }
    assert!(put_back.first().is_some_and(|k| (12..=40).contains(k)), "{put_back:?}");
    let [one, other] = cycles;
    assert!(one == other && one.iter().any(|(mesh, _)| mesh.cells != first.cells));
}

#[test]
fn walls_that_come_back_only_nearly_count() {
    let mut moving = restless();
    let first = quality(moving.mesh());
    // A hundredth of the width is not a tenth of an edge.
    let mut n_put_back = 0;
    for k in 1..=6 * 8 {
        let step = twist_by(&mut moving, k, RESTLESS.1, if k % 8 == 0 { 0.02 } else { 0.0 });
        assert!(step.complete && step.inverted == 0 && step.bad == 0, "{k}: {} bad", step.bad);
        n_put_back += usize::from(is_put_back(&step) && k % 8 == 0);
        let shifted = quality(moving.mesh());
        assert!(!is_put_back(&step) || shifted.mean > 0.995 * first.mean, "{k}: {shifted:?} {first:?}");
    }
    assert!(n_put_back > 0);
}

/// The integral of a cell array, with the vertices at `points`.
fn integral(mesh: &Mesh, points: &[Point], name: &str) -> f64 {
    let values = mesh.cell_field(name).unwrap().values.to_f64().unwrap();
    let of = |(cell, tet): (motet::base::CellId, [motet::base::VertexId; 4])| {
        values[cell.index()] * motet::geometry::tet::volume(tet.map(|v| points[v.index()])).abs()
    };
    mesh.cells.tets().map(of).sum()
}

#[test]
fn arrays_are_carried_to_the_first_mesh() {
    let mut moving = restless_with(Options { contents: vec!["dye".into()], ..that_returns() });
    let n_cells = moving.mesh().cells.len();
    let dye: Vec<f64> = (0..n_cells).map(|i| 1.5 + (7.0 * i as f64).sin()).collect();
    moving.set_cell_field(Field::scalars("dye", dye)).unwrap();
    let all = integral(moving.mesh(), &moving.mesh().points, "dye");
    let mut n_put_back = 0;
    for k in 1..=6 * 8 {
        let heat = (0..moving.mesh().cells.len()).map(|i| 2.0 + (3.0 * i as f64).cos()).collect::<Vec<_>>();
        moving.set_cell_field(Field::scalars("heat", heat)).unwrap();
        let before = moving.mesh().clone();
        let step = twist_restless(&mut moving, k);
        let mesh = moving.mesh();
        let dye = integral(mesh, &mesh.points, "dye");
        assert!((dye / all - 1.0).abs() < 1e-9, "{k}: {dye} of {all}");
        let [change] = step.changes.as_slice() else { continue };
        if change.why == Why::Return {
            n_put_back += 1;
            let [was, is] = [(&before, &change.points_before), (mesh, &mesh.points)]
                .map(|(mesh, points)| integral(mesh, points, "heat"));
            assert!((is / was - 1.0).abs() < 1e-9, "{k}: {is} of {was}");
            let linear = |&[x, y, z]: &Point| 1.0 + 2.0 * x - y + 0.5 * z;
            let field = Field::scalars("linear", change.points_before.iter().map(linear).collect::<Vec<_>>());
            let carried = change.history.transfer_points(&field).unwrap().values.to_f64().unwrap();
            let off = carried.iter().zip(&mesh.points).map(|(value, p)| (value - linear(p)).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12);
            assert_eq!((change.tets_before, change.tets_after), (before.cells.tets().count(), step.tets));
        }
    }
    assert!(n_put_back > 0);
}

#[test]
fn walls_that_come_back_and_may_change_leave_the_same_mesh_at_the_ends_of_cycles() {
    let surface = SurfaceRule::Adapt { distance: Some(0.02) };
    let repair = motet::remesh::Options { surface, ..Default::default() };
    let mut moving = restless_with(Options { repair: Some(repair), ..that_returns() });
    let first = quality(moving.mesh());
    let mut ends = Vec::new();
    for k in 1..=10 * 8 {
        let step = twist_restless(&mut moving, k);
        if k % 8 == 0 {
            ends.push((step.points as f64, step.quality.mean));
        }
    }
    for (points, mean) in &ends[2..] {
        assert!((points / ends[2].0 - 1.0).abs() < 0.01 && (mean / ends[2].1 - 1.0).abs() < 0.01, "{ends:?}");
        assert!((mean / first.mean - 1.0).abs() < 0.03, "{first:?} {ends:?}");
    }
}

/// The effect of the changes of a cube on a field, each change by itself: the sum of squared deviations from
/// the exact function at new and moved vertices.
fn errors_of_changes(of: impl Fn(Point) -> f64, rules: [Rule; 2]) -> [f64; 2] {
    let mut moving = restless();
    let (mut errors, mut n_changed) = ([0.0; 2], 0);
    for k in 1..=3 * 8 {
        let step = twist_restless(&mut moving, k);
        let Some(change) = step.changes.last() else { continue };
        let before = Field::vectors("", &change.points_before);
        let places = change.history.transfer_points(&before).unwrap().to_vectors().unwrap();
        let field = Field::scalars("", change.points_before.iter().map(|&p| of(p)).collect::<Vec<_>>());
        for (error, rule) in errors.iter_mut().zip(rules) {
            let carried = change.history.transfer_points_by(&field, rule).unwrap().unwrap();
            let carried = carried.values.to_f64().unwrap();
            *error += carried.iter().zip(&places).map(|(u, &p)| (u - of(p)).powi(2)).sum::<f64>();
        }
        n_changed += change.history.vertices.changed().len();
    }
    assert!(n_changed > 50);
    errors
}

#[test]
fn changes_leave_a_smooth_field_with_less_error_than_linear_interpolation() {
    let smooth = |p: Point| (1.5 * p[0]).sin() * p[1].cos() + p[2] * p[2];
    let [quadratic, linear] = errors_of_changes(smooth, [Rule::Interpolate, Rule::Linear]);
    assert!(linear > 1e-4 && quadratic < 0.125 * linear, "{quadratic}, linear {linear}");
}

#[test]
fn a_state_goes_on_to_the_same_bits_before_and_after_the_first_mesh_was_put_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut moving = restless();
    let (mut states, mut put_back) = (Vec::new(), Vec::new());
    for k in 1..=5 * 8 {
        let step = twist_restless(&mut moving, k);
        put_back.extend(is_put_back(&step).then_some(k));
        if [6, 10, 33].contains(&k) {
            let path = folder.path().join(format!("{k}.vtu"));
            moving.save(&path).unwrap();
            states.push((k, path));
        }
    }
    assert!(put_back.first().is_some_and(|&k| 10 < k && k < 33), "{put_back:?}");
    for (saved, path) in states {
        let mut again = MovingMesh::load(&path, that_returns(), &Threads::new(2).unwrap()).unwrap();
        for k in saved + 1..=5 * 8 {
            let step = twist_restless(&mut again, k);
            assert_eq!(is_put_back(&step), put_back.contains(&k), "{k} from {saved}");
        }
        assert_eq!(again.mesh(), moving.mesh(), "from {saved}");
        assert_eq!(again.velocity(), moving.velocity(), "from {saved}");
    }
}

#[test]
fn nothing_is_put_back_after_a_refinement() {
    let mut moving = restless();
    twist_restless(&mut moving, 1);
    let criteria = vec![Criterion::Ball { centre: [0.0; 3], radius: 0.1 }];
    let wanted = Wanted { criteria, generations: Some(1), ..Wanted::default() };
    let changes = moving.refine(&wanted, &threads()).unwrap();
    assert!(!changes.is_empty());
    let steps = (2..=6 * 8).map(|k| twist_by(&mut moving, k, RESTLESS.1, 0.0));
    assert!(!steps.into_iter().any(|step| is_put_back(&step)));
}

#[test]
fn a_mesh_that_need_not_change_comes_back_to_the_bit_and_is_left_alone() {
    let mut moving = restless();
    let first = moving.mesh().clone();
    for k in 1..=6 * 8 {
        let step = twist_by(&mut moving, k, 0.1, 0.0);
        assert!(step.complete && step.changes.is_empty(), "{k}");
    }
    assert_eq!(moving.mesh(), &first);
}

#[test]
fn what_is_improved_has_an_entry_for_each_point() {
    let mesh = box_grid([2; 3], [[-1.0; 3], [1.0; 3]]);
    let refusal = |density: Option<Density>, pose: Option<Vec<Point>>| {
        let improve = Improve { below: 0.75, cells: Some(Vec::new()), density, pose, ..Improve::filled() };
        let options = motet::remesh::Options { improve: Some(improve), ..Default::default() };
        remesh_mesh(&mesh, &options, &Rules::default(), &threads()).unwrap_err().to_string()
    };
    let sizes = Density { sizes: vec![1.0; 26], lack: 0 };
    assert!(refusal(Some(sizes), None).contains("26 sizes for 27 points"));
    assert!(refusal(None, Some(vec![[0.0; 3]; 28])).contains("28 positions in the other pose for 27 points"));
}

#[test]
fn tets_that_a_narrow_place_made_bad_are_good_again_when_it_widens() {
    // A bar, pinched about its middle to a thirtieth of its height, eight steps per cycle.
    let mesh = box_grid([10, 2, 2], [[0.0, -0.5, -0.5], [3.0, 0.5, 0.5]]);
    let mut moving = MovingMesh::new(&mesh, that_returns(), &threads()).unwrap();
    let (mut most_bad, mut counts) = (0, Vec::new());
    for k in 1..=10 * 8 {
        let depth = 0.97 * (0.5 - 0.5 * (std::f64::consts::TAU * f64::from(k) / 8.0).cos());
        let goes = |&[x, _, z]: &Point| [0.0, 0.0, -z * depth * (-(x - 1.5) * (x - 1.5) * 8.0).exp()];
        let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
        let step = moving.advance(f64::from(k), &displacement, &threads()).unwrap();
        assert!(step.complete && step.inverted == 0);
        most_bad = most_bad.max(step.bad);
        if k % 8 == 0 {
            assert_eq!(step.bad, 0, "{k}");
            counts.push(step.points);
        }
    }
    assert!(most_bad > 0, "nothing became bad");
    // Of 99 vertices 9 are inside. Vertices that the narrow place needs may stay until the next change, but
    // their number does not grow.
    let (earlier, later) = counts.split_at(counts.len() / 2);
    assert!(later.iter().max() <= earlier.iter().max(), "{counts:?}");
    assert!(counts.last().is_some_and(|n| n.abs_diff(mesh.points.len()) <= 2), "{counts:?}");
}

#[test]
fn without_improving_bad_tets_are_repaired_and_nothing_else() {
    let mesh = paddle_in_box();
    let run = |improve_below: f64| {
        let options = Options { improve_below, ..options(MethodName::Bodies, Some(Strain::Band)) };
        let mut moving = MovingMesh::new(&mesh, options, &threads()).unwrap();
        let steps = (1..=6).map(|k| turn(&mut moving, f64::from(k), f64::from(10 * k).to_radians()));
        let steps: Vec<Step> = steps.collect();
        assert!(steps.iter().all(|step| step.bad == 0));
        let kept: f64 = steps.iter().flat_map(|step| &step.changes).map(|change| change.kept_share).product();
        (kept, quality(moving.mesh()).mean)
    };
    let ((kept, mean), (kept_better, mean_better)) = (run(0.0), run(0.75));
    assert!(kept > kept_better && mean < mean_better, "{kept} {kept_better} {mean} {mean_better}");
}
