//! Sizes from second derivatives: recovered, limited, graded, scaled to a number of tets.

use crate::common::random_mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::tet::{EDGES, at};
use motet::geometry::vector::{distance, norm};
use motet::mesh::shapes::{ball, box_grid};
use motet::mesh::{Mesh, TetMesh, TetPart};
use motet::refine::hessian::{curvatures, hessians};
use motet::refine::sizes::{SizeLimits, for_count, for_error, for_mean_square, limit_growth, wishes};
use motet::refine::wish::expected_tets;

fn tets_of(mesh: &Mesh) -> TetMesh {
    TetPart::of(mesh).unwrap().mesh
}

fn values(mesh: &TetMesh, f: impl Fn(Point) -> f64) -> Vec<f64> {
    mesh.points.iter().map(|p| f(*p)).collect()
}

/// A quadratic field and its second derivatives.
fn quadratic([x, y, z]: Point) -> f64 {
    1.0 + x - 2.0 * z + 1.5 * x * x - 0.5 * y * y + 0.25 * z * z + 2.0 * x * y - y * z + 0.5 * x * z
}

const SECOND: [f64; 6] = [3.0, -1.0, 0.5, 2.0, -1.0, 0.5];

fn off(found: [f64; 6], expected: [f64; 6]) -> f64 {
    (0..6).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn second_derivatives_of_a_quadratic_field_are_exact_in_a_lattice() {
    let threads = Threads::single();
    let mesh = tets_of(&box_grid([5, 6, 7], [[-1.0, 0.0, 0.5], [1.0, 1.5, 2.0]]));
    let found = hessians(&mesh, &values(&mesh, quadratic), &threads);
    let worst = found.iter().map(|h| off(*h, SECOND)).fold(0.0, f64::max);
    println!("lattice: off by {worst:.1e}");
    // At the boundary as well.
    assert!(worst < 1e-11, "{worst}");
    let straight = hessians(&mesh, &values(&mesh, |[x, y, z]| 3.0 + x - 2.0 * y + 0.1 * z), &threads);
    assert!(straight.iter().all(|h| off(*h, [0.0; 6]) < 1e-11));
    // All vertices of a single tet are on the boundary.
    let one = TetMesh::new(mesh.points[..4].to_vec(), vec![[0, 1, 2, 3].map(VertexId)]);
    assert_eq!(hessians(&one, &[1.0, 2.0, 0.0, 5.0], &threads).len(), 4);
}

#[test]
fn second_derivatives_come_nearer_in_finer_lattices() {
    let threads = Threads::single();
    let f = |[x, y, z]: Point| (2.0 * x).sin() * (y + 0.5 * z).cos();
    let second = |[x, y, z]: Point| {
        let (s, c) = (2.0 * x).sin_cos();
        let (t, d) = (y + 0.5 * z).sin_cos();
        [-4.0 * s * d, -s * d, -0.25 * s * d, -2.0 * c * t, -0.5 * s * d, -c * t]
    };
    let errors = [6, 12, 24].map(|n| {
        let mesh = tets_of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]]));
        let found = hessians(&mesh, &values(&mesh, f), &threads);
        let is_inner = |p: &Point| p.iter().all(|x| (0.34..0.67).contains(x));
        let pairs = mesh.points.iter().zip(&found);
        pairs.filter(|(p, _)| is_inner(p)).map(|(p, h)| off(*h, second(*p))).fold(0.0, f64::max)
    });
    println!("errors inside, each lattice twice as fine: {errors:?}");
    // Second order, away from the boundary.
    assert!(errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1]);
}

#[test]
fn curvature_is_about_right_in_any_mesh() {
    let threads = Threads::single();
    // Eigenvalues -3, 1 and 2, along axes other than the coordinate axes.
    let f = |[x, y, z]: Point| {
        let [u, v] = [(x + y) / 2f64.sqrt(), (x - y) / 2f64.sqrt()];
        0.5 * (-3.0 * u * u + v * v + 2.0 * z * z)
    };
    for (name, mesh) in [("ball", tets_of(&ball(6, 5))), ("random", random_mesh(3000, 5))] {
        let mut bends = curvatures(&mesh, [values(&mesh, f).as_slice()], &threads);
        bends.sort_by(f64::total_cmp);
        let at = |share: f64| bends[(share * (bends.len() - 1) as f64) as usize];
        println!("{name}: 3 is found as {:.2} to {:.2}, median {:.2}", at(0.05), at(0.95), at(0.5));
        assert!((2.6..3.5).contains(&at(0.5)), "{name}");
        // The gradients of flat tets are unbounded.
        assert!(name == "random" || at(0.05) > 2.4 && at(0.95) < 3.6);
    }
}

#[test]
fn a_size_for_an_error_keeps_it() {
    let size = for_error(&[4.0, 0.0, f64::NAN], 0.01);
    assert!((size[0] - (32.0_f64 * 0.01 / (9.0 * 4.0)).sqrt()).abs() < 1e-15);
    assert_eq!(size[1..], [f64::INFINITY, f64::INFINITY]);
    let scale = size[0] / 8f64.sqrt();
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]
        .map(|p: Point| p.map(|x| x * scale));
    let field = |p: Point| 2.0 * norm(p) * norm(p);
    let centre = at(corners, [0.25; 4]);
    let linear = corners.iter().map(|p| field(*p)).sum::<f64>() / 4.0;
    let error = linear - field(centre);
    // Half the curvature times the square of the radius, sqrt(3/8) of an edge; the bound is for the worst
    // shape.
    assert!((error - 3.0 / 16.0 * 4.0 * size[0] * size[0]).abs() < 1e-12);
    assert!(error < 0.01 && error > 0.005);
}

#[test]
fn sizes_grow_no_faster_than_they_may() {
    let mesh = random_mesh(500, 8);
    let n = mesh.points.len();
    let mut sizes: Vec<f64> =
        (0..n).map(|i| if i % 50 == 0 { 0.01 * (i + 1) as f64 } else { f64::INFINITY }).collect();
    let first = sizes.clone();
    limit_growth(&mesh, &mut sizes, 0.3);
    let edges = || mesh.tets.iter().flat_map(|t| EDGES.map(|[i, j]| [t[i].index(), t[j].index()]));
    // By definition, with rounds until nothing changes (Bellman and Ford).
    let mut expected = first;
    loop {
        let mut is_changed = false;
        for [a, b] in edges().flat_map(|[a, b]| [[a, b], [b, a]]) {
            let most = expected[a] + 0.3 * distance(mesh.points[a], mesh.points[b]);
            is_changed |= most < expected[b];
            expected[b] = expected[b].min(most);
        }
        if !is_changed {
            break;
        }
    }
    assert_eq!(sizes, expected);
    assert!(sizes.iter().all(|h| h.is_finite()));
}

#[test]
fn sizes_are_scaled_to_a_number_of_tets() {
    let threads = Threads::single();
    let mesh = tets_of(&ball(5, 4));
    let bends = curvatures(&mesh, [values(&mesh, front).as_slice()], &threads);
    for growth in [0.5, f64::INFINITY] {
        let limits = SizeLimits { growth, ..SizeLimits::default() };
        for target in [5_000, 50_000, 2_000_000] {
            let sizes = for_count(&mesh, &for_error(&bends, 1.0), &limits, target, &threads);
            let n = expected_tets(&wishes(&mesh, &sizes, &threads));
            println!("{n} tets of {target}, growth {growth}");
            assert!(n <= target as f64 && n > 0.8 * target as f64);
        }
        let few = for_count(&mesh, &for_error(&bends, 1.0), &limits, 3, &threads);
        assert_eq!(expected_tets(&wishes(&mesh, &few, &threads)), mesh.tets.len() as f64);
    }
    let limits = SizeLimits { smallest: 0.1, largest: 0.2, ..SizeLimits::default() };
    let mut sizes = for_error(&bends, 1e-3);
    limits.apply(&mesh, &mut sizes);
    assert!(sizes.iter().all(|h| (0.1..=0.2).contains(h)));
}

/// A front a tenth of the radius wide.
fn front(p: Point) -> f64 {
    ((norm(p) - 0.5) / 0.05).tanh()
}

#[test]
fn sizes_for_the_mean_square_leave_the_least_of_it() {
    // Two places of equal volume: second derivatives 1 and 100, sizes h and g, h^-3 and g^-3 tets, errors h^2
    // and 100 g^2.
    let sizes = for_mean_square(&[1.0, 100.0, 0.0, f64::NAN]);
    assert_eq!(sizes[2..], [f64::INFINITY, f64::INFINITY]);
    let ratio = sizes[0] / sizes[1];
    let squares = |ratio: f64| {
        // With a given number of tets, only one of the sizes is free.
        let g = (1.0 + ratio.powi(-3)).cbrt();
        (ratio * g).powi(4) + (100.0 * g * g).powi(2)
    };
    assert!(squares(ratio) < squares(1.01 * ratio) && squares(ratio) < squares(0.99 * ratio));
    // Equal errors everywhere give a larger mean.
    assert!(squares(ratio) < 0.75 * squares(10.0));
}
