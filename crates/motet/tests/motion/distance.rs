//! Motion by distances from the boundary: compared with its definition, rigid motions, threads.

use crate::stepped::step;
use motet::Mesh;
use motet::base::{Point, Threads};
use motet::geometry::tet::volume;
use motet::geometry::vector::{add, cross, distance, norm, scale, sub};
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{Boundary, bounds};
use motet::motion::{FacetSet, Method, Mover, Options, Prescribed};

fn mover(mesh: &Mesh, method: Method) -> Mover {
    Mover::new(mesh, &Options { method, ..Options::default() }, &Threads::single()).unwrap()
}

fn shifted(p: Point) -> Point {
    if norm(p) < 1.01 { [p[0] + 1.0, p[1], p[2]] } else { p }
}

/// A third of the area of the facets at each boundary vertex.
fn areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.points.len()];
    for t in FacetSet::of_boundary(&Boundary::of(&mesh.cells), "", |_| true).rings.iter() {
        let [a, b, c] = [t[0], t[1], t[2]].map(|v| mesh.points[v.index()]);
        t.iter().for_each(|v| areas[v.index()] += norm(cross(sub(b, a), sub(c, a))) / 6.0);
    }
    areas
}

#[test]
fn inverse_distance_is_the_weighted_mean_that_it_is_defined_as() {
    let mesh = sphere_in_box(5, 3);
    let inverse = mover(&mesh, Method::InverseDistance);
    let (moved, areas) = (step(&inverse, shifted, &Threads::single()), areas(&mesh));
    let [low, high] = bounds(&mesh.points).unwrap();
    let extent = distance(low, high);
    let is_node = |v: usize| areas[v] > 0.0;
    for v in (0..mesh.points.len()).filter(|v| !is_node(*v)) {
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for n in (0..mesh.points.len()).filter(|n| is_node(*n)) {
            let r = distance(mesh.points[v], mesh.points[n]);
            let weight = areas[n] * ((extent / r).powi(3) + (0.25 * extent / r).powi(5));
            // A pure shift has no rotation.
            sum = add(sum, scale(sub(shifted(mesh.points[n]), mesh.points[n]), weight));
            weights += weight;
        }
        let expected = add(mesh.points[v], scale(sum, 1.0 / weights));
        assert!(distance(moved[v], expected) < 1e-12, "{v}: {:?} {expected:?}", moved[v]);
    }
}

#[test]
fn inverse_distance_carries_a_rigid_motion() {
    let mesh = sphere_in_box(6, 4);
    let turn = Prescribed::Turn { axis: [1.0, 0.5, -0.3], angle: 1.0, centre: [0.3, 0.0, 2.0] };
    let moved = step(&mover(&mesh, Method::InverseDistance), |p| turn.apply(p, 1.0), &Threads::single());
    let off =
        mesh.points.iter().zip(&moved).map(|(&p, &q)| distance(turn.apply(p, 1.0), q)).fold(0.0, f64::max);
    assert!(off < 1e-11, "{off:.1e}");
}

#[test]
fn radial_functions_meet_the_boundary_and_leave_cells_upright() {
    let mesh = sphere_in_box(11, 6);
    let radial = mover(&mesh, Method::Radial);
    let moved = step(&radial, shifted, &Threads::single());
    let inverted = mesh.cells.tets().filter(|(_, t)| volume(t.map(|v| moved[v.index()])) <= 0.0).count();
    assert_eq!(inverted, 0);
    // Vertices near the sphere move with it, those near the box hardly move.
    for (p, q) in mesh.points.iter().zip(&moved).filter(|(p, _)| norm(**p) > 1.01) {
        let way = q[0] - p[0];
        let gap = norm(*p) - 1.0;
        assert!(gap > 0.05 || way > 0.9, "{p:?} {way}");
        let to_wall = 5.0 - p.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(to_wall > 0.05 || way.abs() < 0.1, "{p:?} {way}");
    }
}

#[test]
fn nothing_moves_to_the_bit_and_threads_do_not_matter() {
    let mesh = sphere_in_box(6, 4);
    for method in [Method::InverseDistance, Method::Radial] {
        let mover = mover(&mesh, method);
        assert!(step(&mover, |p| p, &Threads::single()) == mesh.points);
        let one = step(&mover, shifted, &Threads::single());
        assert!(one == step(&mover, shifted, &Threads::new(3).unwrap()) && one != mesh.points);
    }
}
