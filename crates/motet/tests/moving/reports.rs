//! Reports of a moving mesh: its time, the velocities and displacements of its vertices, timings.

use std::time::Instant;

use motet::base::{Point, Threads};
use motet::geometry::vector::{add, norm, scale, sub};
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{Field, Mesh};
use motet::motion::Motion;
use motet::moving::{MovingMesh, Options, Step};
use motet::refine::{Criterion, Wanted};

fn threads() -> Threads {
    Threads::single()
}

fn mesh() -> Mesh {
    sphere_in_box(3, 3)
}

/// Moves all walls by the same vector.
fn all_go(moving: &mut MovingMesh, time: f64, by: Point) -> Step {
    let displacement = vec![by; moving.driven_places().len()];
    moving.advance(time, &displacement, &threads()).unwrap()
}

fn near(a: Point, b: Point) -> bool {
    norm(sub(a, b)) < 1e-12
}

#[test]
fn a_mesh_that_goes_as_a_whole_has_one_velocity_and_one_displacement() {
    let first = mesh();
    let mut moving = MovingMesh::new(&first, Options::default(), &threads()).unwrap();
    assert_eq!((moving.time(), moving.step()), (0.0, 0));
    assert!(moving.velocity().iter().chain(&moving.displacement()).all(|v| *v == [0.0; 3]));
    let mut at = ([0.0; 3], 0.0);
    for (k, (time, by)) in
        [(0.5, [0.1, 0.0, 0.0]), (2.0, [0.1, 0.3, -0.2]), (2.25, [0.0; 3])].into_iter().enumerate()
    {
        let step = all_go(&mut moving, time, by);
        assert!(step.complete && step.fraction == 1.0 && step.legs == 1 && step.changes.is_empty());
        assert_eq!((step.step, step.time, moving.step(), moving.time()), (k + 1, time, k + 1, time));
        let velocity = scale(sub(by, at.0), 1.0 / (time - at.1));
        assert!(moving.velocity().iter().all(|v| near(*v, velocity)), "{velocity:?}");
        assert!(moving.displacement().iter().all(|d| near(*d, by)));
        assert!(moving.mesh().points.iter().zip(&first.points).all(|(&p, &q)| near(p, add(q, by))));
        assert_eq!((step.points, step.tets), (first.points.len(), first.cells.tets().count()));
        at = (by, time);
    }
    assert!(
        moving.advance(2.25, &vec![[0.0; 3]; moving.driven_places().len()], &threads()).is_err(),
        "time goes on"
    );
    assert_eq!((moving.step(), moving.time()), (3, 2.25));
}

#[test]
fn stages_take_no_longer_than_the_whole() {
    let mut moving = MovingMesh::new(&mesh(), Options::default(), &threads()).unwrap();
    let sphere = |moving: &MovingMesh, by: f64| -> Vec<Point> {
        let goes = |p: &Point| if norm(*p) < 1.01 { [by, 0.0, 0.0] } else { [0.0; 3] };
        moving.driven_places().iter().map(goes).collect()
    };
    let (mut n_changes, mut times) = (0, vec![]);
    for k in 1..=5 {
        let displacement = sphere(&moving, 0.6 * f64::from(k));
        let begin = Instant::now();
        let step = moving.advance(f64::from(k), &displacement, &threads()).unwrap();
        let (all, taken) = (begin.elapsed().as_secs_f64(), step.seconds);
        n_changes += step.changes.len();
        let stages = [taken.motion, taken.quality, taken.repair, taken.setup, taken.contact];
        assert!(stages.iter().all(|s| *s >= 0.0) && taken.motion > 0.0 && taken.quality > 0.0, "{taken:?}");
        assert!(step.changes.is_empty() || taken.repair > 0.0 && taken.setup > 0.0, "{taken:?}");
        assert!(stages.iter().sum::<f64>() <= taken.total && taken.total <= all, "{taken:?} of {all}");
        times.extend(step.changes.iter().map(|change| change.time));
        // Changes on the way have a time on the way.
        assert!(step.changes.iter().all(|c| c.time > f64::from(k - 1) && c.time <= f64::from(k)));
        assert!(step.complete, "{}", step.fraction);
    }
    assert!(n_changes > 0 && times.is_sorted(), "{times:?}");
    let certified = moving.certify(&threads()).unwrap().seconds;
    assert!(
        certified.quality > 0.0
            && certified.contact >= 0.0
            && certified.quality + certified.contact <= certified.total
    );
}

#[test]
fn lengths_to_go_back_to_are_numbers_from_zero_on() {
    let mut moving = MovingMesh::new(&mesh(), Options::default(), &threads()).unwrap();
    for smallest in [-1e-9, f64::NAN] {
        assert!(moving.coarsen(smallest, &threads()).is_err(), "{smallest}");
    }
    assert!(moving.coarsen(0.0, &threads()).unwrap().is_none(), "nothing is short");
    // Divided edges keep their new lengths from now on.
    let near = Criterion::Ball { centre: [2.0, 0.0, 0.0], radius: 1.5 };
    let fine = Wanted { criteria: vec![near], generations: Some(1), ..Wanted::default() };
    assert_eq!(moving.refine(&fine, &threads()).unwrap().len(), 1);
    let n_tets = moving.mesh().cells.tets().count();
    let change = moving.coarsen(0.0, &threads()).unwrap().expect("edges are shorter than at first");
    assert_eq!((change.tets_before, change.tets_after), (n_tets, moving.mesh().cells.tets().count()));
    assert!(change.tets_after < n_tets);
}

#[test]
fn arrays_of_another_length_are_refused() {
    let mut moving = MovingMesh::new(&mesh(), Options::default(), &threads()).unwrap();
    let (n_points, n_cells) = (moving.mesh().points.len(), moving.mesh().cells.len());
    for (n, is_right) in [(n_points - 1, false), (n_points, true), (n_points + 1, false)] {
        assert_eq!(moving.set_point_field(Field::scalars("p", vec![1.0; n])).is_ok(), is_right);
        assert_eq!(
            moving.mesh().point_field("p").is_some(),
            n >= n_points,
            "what is refused is not taken over"
        );
    }
    for (n, is_right) in [(n_cells - 1, false), (n_cells, true), (n_cells + 1, false)] {
        assert_eq!(moving.set_cell_field(Field::scalars("c", vec![1.0; n])).is_ok(), is_right);
        assert_eq!(moving.mesh().cell_field("c").is_some(), n >= n_cells);
    }
    for (n, is_right) in [(2 * n_points - 1, false), (2 * n_points, true), (2 * n_points + 1, false)] {
        let pairs = Field { components: 2, ..Field::scalars("pairs", vec![1.0; n]) };
        assert_eq!(moving.set_point_field(pairs).is_ok(), is_right, "{n}");
    }
}

#[test]
fn shares_of_a_step_are_numbers_between_zero_and_one() {
    for value in [-0.1, 1.1, f64::NAN] {
        let all = [
            Options { margin: value, ..Options::default() },
            Options { floor: value, ..Options::default() },
            Options { improve_below: value, ..Options::default() },
        ];
        assert!(
            all.into_iter().all(|options| MovingMesh::new(&mesh(), options, &threads()).is_err()),
            "{value}"
        );
    }
}

#[test]
fn a_rim_that_leaves_its_plane_is_found_before_the_step() {
    let mesh = box_grid([4, 3, 3], [[0.0; 3], [2.0, 1.5, 1.0]]);
    let motion = Motion { slide: vec!["xmin".into()], ..Motion::default() };
    let moving = MovingMesh::new(&mesh, Options { motion, ..Options::default() }, &threads()).unwrap();
    let leaving = |by: &dyn Fn(Point) -> Point| {
        let displacement: Vec<Point> = moving.driven_places().iter().map(|p| by(*p)).collect();
        moving.leaves_plane(&displacement)
    };
    assert_eq!(leaving(&|_| [0.0; 3]), None);
    assert_eq!(leaving(&|p| [0.0, 0.1 * p[1], 0.2 * p[2]]), None, "within the plane");
    let farthest = leaving(&|p| [0.1 * p[2] * (1.0 + p[1]), 0.0, 0.0]).unwrap();
    assert_eq!((farthest.patch.as_str(), farthest.place), ("xmin", [0.0, 1.5, 1.0]));
    assert!((farthest.distance - 0.25).abs() < 1e-15 && farthest.is_significant, "{farthest:?}");
}
