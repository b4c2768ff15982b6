//! Ends cut off: rims lie in the plane or on the sphere, arrays are linear along edges, what is not near stays.

use std::f64::consts::TAU;

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle::area_vector;
use motet::geometry::vector::{distance, dot, norm, sub};
use motet::mesh::shapes::{Aneurysm, ball};
use motet::mesh::{CellKind, Cells, Field, Surface};
use motet::meshing::even::{Cut, Options, clip, even_surface};
use motet::preflight::open_rims;

/// Part of a ring of radius 2 around z, a tube of radius 0.5, from angle 0 to `angle`; the whole ring if that
/// is a turn.
fn bent_tube(angle: f64) -> Mesh {
    let is_ring = angle >= TAU;
    let (n, m) = (24, 60);
    let spaces = if is_ring { m } else { m - 1 };
    let points: Vec<Point> = (0..m)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .map(|(i, j)| {
            let (s, t) = (TAU * i as f64 / n as f64, angle * j as f64 / spaces as f64);
            let r = 2.0 + 0.5 * s.cos();
            [r * t.cos(), r * t.sin(), 0.5 * s.sin()]
        })
        .collect();
    let mut cells = Vec::new();
    for (i, j) in (0..spaces).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let id = |i: usize, j: usize| VertexId::new(j % m * n + i % n);
        cells.extend([id(i, j), id(i, j + 1), id(i + 1, j), id(i + 1, j), id(i, j + 1), id(i + 1, j + 1)]);
    }
    let mut mesh = Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, cells).unwrap());
    let linear: Vec<f64> = mesh.points.iter().map(|p| 1.0 + 2.0 * p[0] - p[1] + 3.0 * p[2]).collect();
    mesh.set_point_field(Field::scalars("f", linear));
    mesh
}

fn area(mesh: &Mesh) -> f64 {
    let surface = Surface::of(mesh);
    (0..surface.triangles.len()).map(|t| norm(area_vector(surface.corners(t)))).sum()
}

fn rims(mesh: &Mesh) -> Vec<Vec<VertexId>> {
    let surface = Surface::of(mesh);
    let [closed, torn] = open_rims(&surface.points, &surface.triangles);
    assert!(torn.is_empty());
    closed
}

#[test]
fn a_plane_cuts_one_end_off_although_the_vessel_meets_it_twice() {
    // Three quarters of a ring: the plane x = 0 meets it at angles of 90 and 270 degrees.
    let tube = bent_tube(0.75 * TAU);
    let cut = Cut::Plane { at: [0.0, 2.0, 0.0], normal: [1.0, 0.0, 0.0] };
    let cut_off = clip(&tube, &[cut], &Threads::single()).unwrap();
    let new = &cut_off.mesh;
    assert!((area(new) / area(&tube) - 2.0 / 3.0).abs() < 0.01, "{}", area(new) / area(&tube));
    let rims = rims(new);
    assert_eq!(rims.len(), 2);
    assert!(rims.iter().any(|rim| rim.iter().all(|v| new.points[v.index()][0].abs() < 1e-12)));
    let f = new.point_field("f").unwrap().values.to_f64().unwrap();
    for (f, p) in f.iter().zip(&new.points) {
        assert!((f - (1.0 + 2.0 * p[0] - p[1] + 3.0 * p[2])).abs() < 1e-12);
    }
    let report = cut_off.report[0];
    assert!(report.removed > 700 && report.divided > 20, "{report:?}");
    // Turned round, the other part goes.
    let turned = Cut::Plane { at: [0.0, 2.0, 0.0], normal: [-1.0, 0.0, 0.0] };
    let rest = clip(&tube, &[turned], &Threads::single()).unwrap();
    assert!((area(&rest.mesh) + area(new) - area(&tube)).abs() < 1e-12 * area(&tube));
}

#[test]
fn a_whole_ring_is_not_separated_by_one_cut() {
    let ring = bent_tube(TAU);
    let cut = Cut::Plane { at: [2.0, 0.0, 0.0], normal: [0.0, 1.0, 0.0] };
    let between = Cut::Plane { at: [-2.0, 0.0, 0.0], normal: [0.0, 1.0, 0.0] };
    for cut in [cut, between] {
        let refused =
            clip(&ring, &[cut], &Threads::single()).map(|made| made.report).unwrap_err().to_string();
        assert!(refused.contains("does not separate"), "{refused}");
    }
}

#[test]
fn a_sphere_leaves_a_rim_on_it() {
    let mut surface = ball(6, 3);
    let lift = |p: &Point| p[2];
    surface.set_point_field(Field::scalars("z", surface.points.iter().map(lift).collect::<Vec<_>>()));
    let (centre, radius) = ([0.0, 0.0, 1.0], 0.7);
    let cut = clip(&surface, &[Cut::Sphere { centre, radius }], &Threads::single()).unwrap();
    let rims = rims(&cut.mesh);
    assert_eq!(rims.len(), 1);
    for v in &rims[0] {
        assert!((distance(cut.mesh.points[v.index()], centre) - radius).abs() < 1e-12);
    }
    let used = Surface::of(&cut.mesh);
    assert!(used.vertices().iter().all(|v| distance(cut.mesh.points[v.index()], centre) > radius - 1e-12));
}

#[test]
fn several_cuts_leave_a_clean_vessel_with_even_triangles() {
    let vessel = Aneurysm::default().mesh().unwrap();
    let surface = Surface::of(&vessel);
    let (inlet, outlet) = (vessel.find_patch("inlet").unwrap(), vessel.find_patch("outlet").unwrap());
    let middle_and_normal = |patch: i32| {
        let of: Vec<usize> = (0..surface.triangles.len()).filter(|&t| surface.patches[t] == patch).collect();
        let normal = of.iter().fold([0.0; 3], |sum, &t| {
            let a = area_vector(surface.corners(t));
            [sum[0] + a[0], sum[1] + a[1], sum[2] + a[2]]
        });
        (surface.corners(of[0])[0], normal)
    };
    let cuts: Vec<Cut> = [inlet, outlet]
        .map(|patch| {
            let (p, n) = middle_and_normal(patch);
            let length = norm(n);
            Cut::Plane { at: [0, 1, 2].map(|k| p[k] - 0.37 * n[k] / length), normal: n }
        })
        .to_vec();
    let options = Options { cuts: cuts.clone(), ..Options::default() };
    let made = even_surface(&vessel, &options, &Threads::single()).unwrap();
    let rims = rims(&made.mesh);
    assert_eq!((rims.len(), made.report.cuts.len()), (2, 2));
    for rim in &rims {
        let is_on = |cut: &&Cut| match **cut {
            Cut::Plane { at, normal } => rim
                .iter()
                .all(|v| dot(sub(made.mesh.points[v.index()], at), normal).abs() < 1e-9 * norm(normal)),
            Cut::Sphere { .. } => false,
        };
        assert!(cuts.iter().any(|cut| is_on(&cut)));
    }
    assert!(made.report.after.angles.worst > 20.0, "{:?}", made.report.after.angles);
    assert_eq!(made.report.not_reached(), None);
    assert_eq!(made.history.vertices.len(), made.mesh.points.len());
}

#[test]
fn cuts_that_make_no_sense_are_refused() {
    let tube = bent_tube(2.0);
    for numbers in
        [&[0.0; 6][..], &[0.0; 5], &[], &[0.0, 0.0, 0.0, -1.0], &[f64::NAN; 4], &[f64::INFINITY; 6]]
    {
        assert!(Cut::of_numbers(numbers).is_err(), "{numbers:?}");
    }
    let refused =
        |cut: Cut| clip(&tube, &[cut], &Threads::single()).map(|made| made.report).unwrap_err().to_string();
    let far = Cut::Plane { at: [0.0, 0.0, 9.0], normal: [0.0, 0.0, 1.0] };
    assert!(refused(far).contains("does not meet"));
    assert!(refused(Cut::Sphere { centre: [9.0; 3], radius: 1.0 }).contains("does not meet"));
    // Along the tube there are two lines, of which only one is cut.
    let along = Cut::Plane { at: [2.0, 0.1, 0.0], normal: [0.0, 0.0, 1.0] };
    assert!(refused(along).contains("does not separate"));
}
