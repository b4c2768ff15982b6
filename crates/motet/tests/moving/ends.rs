//! Steps that end early, and resuming from a state: on a small mesh, to the bit.

use motet::base::{Point, Threads};
use motet::contact;
use motet::geometry::vector::{add, norm, scale, sub};
use motet::mesh::Mesh;
use motet::mesh::shapes::sphere_in_box;
use motet::moving::{MovingMesh, Options, Watching};

fn threads() -> Threads {
    Threads::single()
}

fn is_sphere(p: &Point) -> bool {
    norm(*p) < 1.01
}

fn sphere_goes(moving: &MovingMesh, by: Point) -> Vec<Point> {
    moving.driven_places().iter().map(|p| if is_sphere(p) { by } else { [0.0; 3] }).collect()
}

fn go(moving: &mut MovingMesh, time: f64, by: Point) -> motet::moving::Step {
    let displacement = sphere_goes(moving, by);
    moving.advance(time, &displacement, &threads()).unwrap()
}

#[test]
fn without_repair_a_step_ends_on_its_way_and_says_how_far_it_went() {
    let mesh: Mesh = sphere_in_box(3, 3);
    let mut moving =
        MovingMesh::new(&mesh, Options { repair: None, ..Options::default() }, &threads()).unwrap();
    let first = [0.5, 0.0, 0.0];
    assert!(go(&mut moving, 1.0, first).complete);
    let second = [0.5, 0.0, 6.0];
    let step = go(&mut moving, 3.0, second);
    assert!(!step.complete && step.fraction > 0.0 && step.fraction < 1.0, "{}", step.fraction);
    assert!(step.inverted == 0 && step.changes.is_empty());
    assert_eq!((step.time, moving.time()), (1.0 + 2.0 * step.fraction, 1.0 + 2.0 * step.fraction));
    let by = add(first, scale(sub(second, first), step.fraction));
    let velocity = scale(sub(second, first), 0.5);
    for (v, p) in mesh.points.iter().enumerate().filter(|(_, p)| is_sphere(p)) {
        assert!(norm(sub(moving.mesh().points[v], add(*p, by))) < 1e-12);
        assert!(norm(sub(moving.velocity()[v], velocity)) < 1e-9, "{:?}", moving.velocity()[v]);
    }
    // From there the walls may go back at once.
    assert!(go(&mut moving, 4.0, [0.0; 3]).complete);
}

/// The sphere and the box, kept apart by half a radius.
fn kept_apart() -> Options {
    let watch = Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options { warn: Some(1.0), ..contact::Options::default() },
        horizon: None,
        hold: Some(0.5),
    };
    Options { watch: Some(watch), ..Options::default() }
}

#[test]
fn a_state_goes_on_to_the_same_bits_where_walls_are_kept_apart() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("state.vtu");
    let mut moving = MovingMesh::new(&sphere_in_box(3, 3), kept_apart(), &threads()).unwrap();
    let way = [[2.0, 0.0, 0.0], [3.7, 0.5, 0.0], [1.0, 1.0, 0.0]];
    let (mut n_held, mut n_changes) = (0, 0);
    for (k, by) in way.into_iter().enumerate() {
        moving.save(&file).unwrap();
        let mut loaded = MovingMesh::load(&file, kept_apart(), &threads()).unwrap();
        assert_eq!(
            (loaded.time(), loaded.step(), loaded.mesh()),
            (moving.time(), moving.step(), moving.mesh())
        );
        assert_eq!((loaded.velocity(), loaded.displacement()), (moving.velocity(), moving.displacement()));
        let time = 1.0 + k as f64;
        let [a, b] = [&mut moving, &mut loaded].map(|mesh| go(mesh, time, by));
        assert!(a.complete && a.inverted == 0, "{by:?}: {}", a.fraction);
        assert_eq!(
            (a.gaps.as_ref(), a.worst, a.bad, a.forced, a.legs),
            (b.gaps.as_ref(), b.worst, b.bad, b.forced, b.legs)
        );
        assert_eq!(loaded.mesh(), moving.mesh());
        let gaps = a.gaps.unwrap();
        assert!(gaps.least.unwrap() >= 0.5 - 1e-9, "{by:?}: {gaps:?}");
        assert_eq!((gaps.held > 0, gaps.cramped), (by[0] > 3.5, None));
        n_held += gaps.held;
        n_changes += a.changes.len();
    }
    assert!(n_held > 0 && n_changes > 0, "{n_held} {n_changes}");
    // A state saved with a distance cannot be resumed without one.
    moving.save(&file).unwrap();
    assert!(MovingMesh::load(&file, Options::default(), &threads()).is_err());
}
