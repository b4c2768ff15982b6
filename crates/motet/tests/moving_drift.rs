//! Over long motions a mesh stays the mesh that it was: its counts, its mean quality, and where a wall comes back the mesh itself.

use motet::base::{Point, Threads};
use motet::mesh::history::Rules;
use motet::mesh::shapes::box_grid;
use motet::mesh::{Boundary, Cells, Mesh, Qualities};
use motet::motion::{Method, Strain};
use motet::moving::{Motion, MovingMesh, Options, Step};
use motet::remesh::{Density, Improve, remesh_mesh};

fn threads() -> Threads {
    Threads::single()
}

/// Half the sizes of the paddle.
const PADDLE: Point = [1.0, 1.0 / 3.0, 1.0 / 3.0];

/// A box of 4 by 4 by 2 with a paddle in it, about the origin.
fn paddle_in_box() -> Mesh {
    let grid = box_grid([12, 12, 6], [[-2.0, -2.0, -1.0], [2.0, 2.0, 1.0]]);
    let is_paddle = |vertices: &[motet::base::VertexId]| {
        let middle = |k: usize| vertices.iter().map(|v| grid.points[v.index()][k]).sum::<f64>() / 4.0;
        (0..3).all(|k| middle(k).abs() < PADDLE[k])
    };
    let mut cells = Cells::new();
    for (_, tet) in grid.cells.tets().filter(|(_, tet)| !is_paddle(tet)) {
        cells.push(motet::mesh::CellKind::TETRA, tet);
    }
    let mut mesh = Mesh::new(grid.points.clone(), cells);
    // Points within the paddle are of no tet.
    let is_used: Vec<bool> = {
        let mut is_used = vec![false; mesh.points.len()];
        mesh.cells.tets().flat_map(|(_, tet)| tet).for_each(|v| is_used[v.index()] = true);
        is_used
    };
    mesh.points.iter_mut().zip(is_used).filter(|(_, used)| !used).for_each(|(p, _)| *p = [0.0; 3]);
    mesh
}

fn is_paddle(p: Point) -> bool {
    (0..3).all(|k| p[k].abs() < PADDLE[k] + 1e-9)
}

fn turned([x, y, z]: Point, angle: f64) -> Point {
    let (s, c) = angle.sin_cos();
    [c * x - s * y, s * x + c * y, z]
}

/// Turns the paddle by an angle; all else of the boundary stays.
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

fn options(method: Method, strain: Strain) -> Options {
    Options { motion: Motion { method, strain, ..Motion::default() }, ..Options::default() }
}

/// How far counts may be off those of the first mesh, and the mean EAS below that of the first.
struct Limits {
    vertices: f64,
    tets: f64,
    mean: f64,
}

/// Turns the paddle in steps of ten degrees.
fn turn_on(n_steps: i32, options: Options, limits: &Limits) {
    let mesh = paddle_in_box();
    let first = quality(&mesh);
    let n_walls = Boundary::of(&mesh.cells).vertices.len();
    let mut moving = MovingMesh::new(&mesh, options, &threads()).unwrap();
    let n_first = moving.mesh().cells.tets().count();
    for k in 1..=n_steps {
        let step = turn(&mut moving, f64::from(k), f64::from(10 * k).to_radians());
        assert!(step.complete && step.inverted == 0 && step.bad == 0, "{k}: {} bad", step.bad);
        let of = |n: usize, first: usize| (n as f64 / first as f64 - 1.0).abs();
        assert!(of(step.points, mesh.points.len()) < limits.vertices, "{k}: {} vertices", step.points);
        assert!(of(step.tets, n_first) < limits.tets, "{k}: {} tets of {n_first}", step.tets);
        assert!(step.quality.mean > first.mean - limits.mean, "{k}: {:?}, {first:?}", step.quality);
        assert_eq!(Some(step.quality.worst), step.worst.map(|worst| worst.eas));
    }
    assert_eq!(quality(moving.mesh()), moving.certify(&threads()).unwrap().quality);
    assert_eq!(Boundary::of(&moving.mesh().cells).vertices.len(), n_walls);
}

#[test]
fn a_paddle_that_turns_in_a_band_leaves_counts_and_quality_as_they_were() {
    // Mean EAS 0.588 at first, the same for each tet of the lattice.
    let limits = Limits { vertices: 0.02, tets: 0.08, mean: 0.04 };
    turn_on(72, options(Method::Bodies(Vec::new()), Strain::Band), &limits);
}

#[test]
fn a_paddle_that_turns_by_the_graph_leaves_counts_and_quality_as_they_were() {
    let limits = Limits { vertices: 0.03, tets: 0.12, mean: 0.1 };
    turn_on(36, options(Method::Delaunay, Strain::Even), &limits);
}

#[test]
fn what_is_far_from_a_body_stays_to_the_bit_where_a_band_takes_the_strain() {
    let mesh = paddle_in_box();
    let mut moving =
        MovingMesh::new(&mesh, options(Method::Bodies(Vec::new()), Strain::Band), &threads()).unwrap();
    let step = turn(&mut moving, 1.0, 0.05);
    assert!(step.complete && step.changes.is_empty());
    let is_far = |p: &Point| (0..3).any(|k| p[k].abs() > PADDLE[k] + 0.6);
    let far = mesh.points.iter().zip(&moving.mesh().points).filter(|(p, _)| is_far(p));
    assert!(far.clone().count() > 100 && far.into_iter().all(|(was, is)| was == is));
}

#[test]
fn a_paddle_that_swings_comes_back_to_the_same_mesh() {
    let mesh = paddle_in_box();
    let first = quality(&mesh);
    let mut moving = MovingMesh::new(&mesh, Options::default(), &threads()).unwrap();
    let mut ends = Vec::new();
    for k in 1..=6 * 8 {
        let angle = (std::f64::consts::TAU * f64::from(k) / 8.0).sin() * 0.6;
        let step = turn(&mut moving, f64::from(k), angle);
        assert!(step.complete && step.bad == 0 && step.inverted == 0);
        if k % 8 == 0 {
            ends.push((step.points, step.tets, step.quality));
        }
    }
    // A cycle after the first ones changes hardly anything.
    let [before, last] = [ends[4], ends[5]];
    assert!((before.0 as f64 / last.0 as f64 - 1.0).abs() < 0.01, "{ends:?}");
    assert!((before.1 as f64 / last.1 as f64 - 1.0).abs() < 0.01, "{ends:?}");
    assert!((before.2.mean - last.2.mean).abs() < 0.02, "{ends:?}");
    assert!(last.2.mean > first.mean - 0.02, "{first:?} {ends:?}");
}

/// Twists a cube of two by two by two about z, its top against its bottom, to both sides, eight steps a cycle.
fn twist(moving: &mut MovingMesh, k: i32) -> Step {
    let far = (std::f64::consts::TAU * f64::from(k) / 8.0).sin() * 0.75;
    let goes = |&p: &Point| {
        let to = turned(p, far * p[2]);
        [to[0] - p[0], to[1] - p[1], to[2] - p[2]]
    };
    let displacement: Vec<Point> = moving.driven_places().iter().map(goes).collect();
    moving.advance(f64::from(k), &displacement, &threads()).unwrap()
}

fn that_returns() -> Options {
    Options { returns: true, ..options(Method::Delaunay, Strain::Even) }
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
    // Changed after the walls were at rest: the place of rest is not that of the first mesh.
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

#[test]
fn what_is_improved_has_an_entry_for_each_point() {
    let mesh = box_grid([2; 3], [[-1.0; 3], [1.0; 3]]);
    let refusal = |density: Option<Density>, rest: Option<Vec<Point>>| {
        let improve = Improve { below: 0.75, cells: Vec::new(), density, rest, cost: 0.0 };
        let options = motet::remesh::Options { improve: Some(improve), ..Default::default() };
        remesh_mesh(&mesh, &options, &Rules::default(), &threads()).unwrap_err().to_string()
    };
    let sizes = Density { sizes: vec![1.0; 26], free_vertices: None };
    assert!(refusal(Some(sizes), None).contains("26 sizes for 27 points"));
    assert!(refusal(None, Some(vec![[0.0; 3]; 28])).contains("28 places at rest for 27 points"));
}

#[test]
fn tets_that_a_narrow_place_made_bad_are_good_again_when_it_widens() {
    // A bar, pinched about its middle to a thirtieth of its height, eight steps a cycle.
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
    // Of 99 vertices 9 are inside: what the narrow place needs may wait for the next change, and does not grow.
    assert!(counts.iter().all(|n| n.abs_diff(mesh.points.len()) <= 10), "{counts:?}");
}

#[test]
fn without_improving_bad_tets_are_repaired_and_nothing_else() {
    let mesh = paddle_in_box();
    let run = |improve_below: f64| {
        let options = Options { improve_below, ..options(Method::Bodies(Vec::new()), Strain::Band) };
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
