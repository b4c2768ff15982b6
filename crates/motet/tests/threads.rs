//! Every kind of work has the same result on any number of threads, and in whatever order they take its tasks.

mod common;
mod surfaces;

use std::sync::Arc;

use common::devices::{coil, room};
use common::random::Random;
use motet::Mesh;
use motet::base::{Point, Threads};
use motet::contact::{Contact, Options as Measuring};
use motet::geometry::vector::{norm, sub};
use motet::implant::{Device, Inside, Options as Implanting, implant};
use motet::mesh::history::{History, Rules};
use motet::mesh::shapes::{ball, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field, OrientedTets, Qualities, Surface};
use motet::meshing::layers::{Layers, Stack};
use motet::meshing::{Options as Filling, Sizes, Surfaces, fill};
use motet::motion::{MethodName, Motion, Mover, Strain};
use motet::moving::{Change, MovingMesh, Options as Moving, Step};
use motet::preflight::Role;
use motet::refine::{Criterion, Wanted};

/// Compares what some work returns on one thread with what it returns on many, and on threads that take tasks
/// in other orders.
fn same<T: PartialEq>(what: &str, work: impl Fn(&Threads) -> T) {
    let expected = work(&Threads::single());
    for (n, seed) in [(2, None), (3, None), (7, None), (2, Some(1)), (7, Some(2))] {
        let threads = Threads::exactly(n).expect("threads start");
        let threads = match seed {
            Some(seed) => threads.shuffled(seed),
            None => threads,
        };
        // A failed `assert_eq` would print both meshes.
        assert!(work(&threads) == expected, "{what}: {n} threads, shuffled by {seed:?}");
    }
}

/// The surface of a ball.
fn sphere(n: usize) -> Mesh {
    let surface = Surface::boundary_of(&ball(n, 1));
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

#[test]
fn meshes_of_surfaces() {
    let surface = sphere(6);
    let surfaces = Surfaces::new(&[(&surface, Role::Boundary, "sphere")]).unwrap();
    let stack = Stack { count: 2, first: 0.03, growth: 1.3 };
    let layers = Layers { everywhere: Some(stack), ..Layers::default() };
    let sized = |layers| Filling { layers, ..Filling::with_sizes(Some(Sizes::Uniform(0.1)), None) };
    for (what, options) in [("sizes", sized(None)), ("layers", sized(Some(layers)))] {
        same(what, |threads| fill(&surfaces, &surfaces.preflight(threads), &options, threads).unwrap().mesh);
    }
}

#[test]
fn implants() {
    let mut host = room(9);
    host.set_point_field(Field::vectors("place", &host.points.clone()));
    let device = Device { mesh: coil([0.0; 3]), name: "coil".into(), inside: Inside::Filled };
    same("implant", |threads| {
        let devices = std::slice::from_ref(&device);
        let made = implant(&host, devices, &Implanting::default(), &Rules::default(), threads).unwrap();
        (made.mesh, made.history)
    });
}

#[test]
fn gaps() {
    let shapes = [surfaces::torus(24, 48, [2.0, 0.6]), surfaces::coil(12, 96, [1.8, 0.15], 0.7, 3.0)];
    let (points, bodies) = surfaces::bodies(&shapes);
    let options = Measuring { own: true, ..Measuring::default() };
    same("contact", |threads| {
        let mut contact = Contact::new(points.clone(), bodies.clone(), options, threads).unwrap();
        let gaps = contact.measure(threads);
        let velocity: Vec<Point> = points.iter().map(|p| [p[1], -p[0], 0.3]).collect();
        (gaps, contact.look_ahead(&velocity, 1.0, threads).unwrap())
    });
}

/// The displacements of vertices on a sphere that turns and shifts in its box.
fn turned(places: impl Iterator<Item = Point>, angle: f64) -> Vec<Point> {
    let (sin, cos) = angle.sin_cos();
    let to = |[x, y, z]: Point| [cos * x - sin * y + 0.1 * angle, sin * x + cos * y, z];
    places.map(|p| if norm(p) < 1.001 { sub(to(p), p) } else { [0.0; 3] }).collect()
}

#[test]
fn motions() {
    let mesh = sphere_in_box(10, 6);
    let methods = [
        Motion { smooth: 2, ..Motion::default() },
        Motion { method: MethodName::Guided, ..Motion::default() },
        Motion { method: MethodName::Bodies, ..Motion::default() },
        Motion { method: MethodName::Bodies, strain: Some(Strain::Band), smooth: 2, ..Motion::default() },
        Motion { method: MethodName::Idw, ..Motion::default() },
    ];
    for motion in methods {
        same(&format!("{motion:?}"), |threads| {
            let mut mover = Mover::new(&mesh, &motion.options(&mesh).unwrap(), threads).unwrap();
            let places = mover.boundary().iter().map(|v| mesh.points[v.index()]);
            let displacement = turned(places, 0.6);
            let mut points = mesh.points.clone();
            let certificate = mover.advance(&displacement, &mut points, threads).unwrap();
            (points, certificate.quality, OrientedTets::of(&mesh, threads))
        });
    }
}

#[test]
fn moving_meshes() {
    let mesh = sphere_in_box(8, 6);
    let motion =
        Motion { method: MethodName::Bodies, strain: Some(Strain::Band), smooth: 2, ..Motion::default() };
    let options = Moving { motion, ..Moving::default() };
    same("moving mesh", |threads| {
        let mut moving = MovingMesh::new(&mesh, options.clone(), threads).unwrap();
        let places = moving.driven_places().to_vec();
        let mut n_changes = 0;
        for step in 1..=4 {
            let displacement = turned(places.iter().copied(), 0.25 * f64::from(step));
            n_changes += moving.advance(f64::from(step), &displacement, threads).unwrap().changes.len();
        }
        assert!(n_changes > 0);
        (moving.mesh().clone(), n_changes)
    });
}

/// A part of a script for a moving mesh.
#[derive(Clone, Debug)]
enum Act {
    /// The sphere turns by an angle, is stretched along z, and shifts.
    Move(f64, f64, Point),
    /// Tets near a place are divided.
    Divide(Point),
    /// Divisions are undone.
    Undo,
    /// Short edges are collapsed.
    Coarsen,
    Repair,
    /// The state is saved, and the script goes on with what is loaded.
    Resume,
}

fn acts(random: &mut Random) -> Vec<Act> {
    let act = |random: &mut Random| {
        let place = random.point().map(|x| 3.0 * x - 1.5);
        match (random.next() * 9.0) as usize {
            0 => Act::Divide(place),
            1 => Act::Undo,
            2 => Act::Coarsen,
            3 => Act::Repair,
            4 => Act::Resume,
            _ => Act::Move(random.between(-1.5, 1.5), random.between(0.7, 1.3), place.map(|x| 0.2 * x)),
        }
    };
    (0..6).map(|_| act(random)).collect()
}

/// What a script leaves: the mesh, and what its steps and changes say.
#[derive(Default, PartialEq)]
struct Left {
    mesh: Mesh,
    fractions: Vec<f64>,
    qualities: Vec<Qualities>,
    histories: Vec<Arc<History>>,
}

impl Left {
    fn step(&mut self, step: Step) {
        self.fractions.push(step.fraction);
        self.qualities.push(step.quality);
        self.changes(step.changes);
    }

    fn changes(&mut self, changes: impl IntoIterator<Item = Change>) {
        self.histories.extend(changes.into_iter().map(|change| change.history));
    }
}

fn played(mesh: &Mesh, options: &Moving, acts: &[Act], threads: &Threads) -> Left {
    let mut moving = MovingMesh::new(mesh, options.clone(), threads).unwrap();
    let mut left = Left::default();
    for (k, act) in acts.iter().enumerate() {
        match *act {
            Act::Move(angle, stretch, by) => {
                let (sin, cos) = angle.sin_cos();
                let to = |[x, y, z]: Point| {
                    [cos * x - sin * y + by[0], sin * x + cos * y + by[1], stretch * z + by[2]]
                };
                let of = |p: &Point| if norm(*p) < 1.001 { sub(to(*p), *p) } else { [0.0; 3] };
                let displacement: Vec<Point> = moving.driven_places().iter().map(of).collect();
                left.step(moving.advance(1.0 + k as f64, &displacement, threads).unwrap());
            }
            Act::Divide(centre) => {
                let criteria = vec![Criterion::Ball { centre, radius: 0.7 }];
                let wanted = Wanted { criteria, generations: Some(1), ..Wanted::default() };
                left.changes(moving.refine(&wanted, threads).unwrap());
            }
            Act::Undo => {
                let wanted = Wanted { coarsen: true, ..Wanted::default() };
                left.changes(moving.refine(&wanted, threads).unwrap());
            }
            Act::Coarsen => left.changes(moving.coarsen(0.0, threads).unwrap()),
            Act::Repair => left.changes(moving.repair(threads).unwrap()),
            Act::Resume => {
                let folder = tempfile::tempdir().unwrap();
                let file = folder.path().join("state.vtu");
                moving.save(&file).unwrap();
                moving = MovingMesh::load(&file, options.clone(), threads).unwrap();
            }
        }
    }
    left.step(moving.certify(threads).unwrap());
    left.mesh = moving.mesh().clone();
    left
}

/// Scripts of a moving mesh: motions of any size, divisions and what undoes them, repairs, states saved and
/// loaded, in any order.
#[test]
fn random_scripts() {
    let mut mesh = sphere_in_box(5, 4);
    mesh.set_point_field(Field::vectors("place", &mesh.points.clone()));
    let mut random = Random(41);
    let mut n_changes = 0;
    for number in 0..5 {
        let method = [MethodName::Delaunay, MethodName::Bodies, MethodName::Guided][number % 3];
        let motion = Motion { method, smooth: number / 3, ..Motion::default() };
        let options = Moving { motion, ..Moving::default() };
        let acts = acts(&mut random);
        let changes = std::cell::Cell::new(0);
        same(&format!("{method:?}, {acts:?}"), |threads| {
            let left = played(&mesh, &options, &acts, threads);
            changes.set(left.histories.len());
            left
        });
        n_changes += changes.get();
    }
    assert!(n_changes > 12, "{n_changes} changes test little");
}
