//! Every kind of work has the same result on any number of threads, and in whatever order they take its tasks.

mod common;
mod surfaces;

use common::devices::{coil, room};
use motet::Mesh;
use motet::base::{Point, Threads};
use motet::contact::{Contact, Options as Measuring};
use motet::geometry::vector::{norm, sub};
use motet::implant::{Device, Inside, Options as Implanting, implant};
use motet::mesh::history::Rules;
use motet::mesh::shapes::{ball, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field, OrientedTets, Surface};
use motet::meshing::layers::{Layers, Stack};
use motet::meshing::{Options as Filling, Sizes, Surfaces, fill};
use motet::motion::{MethodName, Motion, Mover, Strain};
use motet::moving::{MovingMesh, Options as Moving};
use motet::preflight::Role;

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
