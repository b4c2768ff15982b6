//! Refinement: conforming meshes that keep their shapes over generations, and coarsening that restores them
//! bit for bit.

use crate::common::invariants::{corners, fits};
use crate::common::refined::{ball_in_box, median_eas, nearest, worst};
use crate::common::{Numbers, random_mesh};
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::quality::{eas, mean_ratio};
use motet::geometry::tet::{self, centroid, volume};
use motet::geometry::vector::{add, distance};
use motet::mesh::TetMesh;
use motet::refine::{Options, Refinement, Rule, estimate, mark};
use motet::spatial::NearestTriangle;

#[test]
fn eight_generations_about_a_point_keep_the_shape() {
    let threads = Threads::single();
    for (name, first) in [("ball in a box", ball_in_box()), ("random", random_mesh(300, 5))] {
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        let w = worst(&first, eas);
        let place = add(first.points[27], [0.01, 0.02, 0.03]);
        let mut n = first.tets.len();
        for generation in 1..=8 {
            let marked = nearest(refinement.mesh(), place, 300);
            let summary = refinement.refine(&marked, &threads).unwrap();
            let mesh = refinement.mesh();
            println!(
                "{name} {generation}: {summary:?} worst {:.3} mean ratio {:.3} median {:.3}",
                worst(mesh, eas) / w,
                worst(mesh, mean_ratio) / worst(&first, mean_ratio),
                median_eas(mesh)
            );
            assert!(summary.n_tets > n + 300);
            n = summary.n_tets;
        }
        assert!(refinement.generations().max() >= Some(4));
        fits(&first, refinement.mesh());
        assert!(worst(refinement.mesh(), eas) >= 0.9 * w);
    }
}

#[test]
fn coarsening_brings_the_first_mesh_back_bit_for_bit() {
    let threads = Threads::single();
    for first in [ball_in_box(), random_mesh(300, 8)] {
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        assert_eq!(refinement.mesh(), &first);
        for _ in 0..5 {
            let marked = nearest(refinement.mesh(), first.points[27], 200);
            refinement.refine(&marked, &threads).unwrap();
        }
        let deepest = refinement.generations().max().unwrap();
        assert!(deepest >= 3);
        for step in 0..=deepest {
            assert!(refinement.mesh() != &first, "not before step {step}");
            let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
            refinement.coarsen(&all, &threads).unwrap();
            fits(&first, refinement.mesh());
            if refinement.mesh() == &first {
                break;
            }
        }
        assert_eq!(refinement.mesh(), &first);
    }
}

#[test]
fn the_mesh_follows_from_what_is_divided_whatever_came_before() {
    let threads = Threads::single();
    let first = random_mesh(300, 11);
    let new = || Refinement::new(&first, Options::default(), &threads).unwrap();
    let (mut straight, mut astray) = (new(), new());
    let there = nearest(&first, [0.2; 3], 60);
    straight.refine(&there, &threads).unwrap();
    // First elsewhere, then there, then the divisions elsewhere are taken back.
    astray.refine(&nearest(&first, [0.9; 3], 60), &threads).unwrap();
    let centres: Vec<Point> =
        there.iter().map(|t| centroid(corners(&first, first.tets[t.index()]))).collect();
    let roots: Vec<TetId> = astray.roots().collect();
    let marked: Vec<TetId> =
        (0..roots.len()).filter(|&i| there.contains(&roots[i])).map(TetId::new).collect();
    assert_eq!(centres.len(), there.len());
    astray.refine(&marked, &threads).unwrap();
    let roots: Vec<TetId> = astray.roots().collect();
    let back: Vec<TetId> = (0..roots.len()).filter(|&i| !there.contains(&roots[i])).map(TetId::new).collect();
    astray.coarsen(&back, &threads).unwrap();
    assert_eq!(astray.mesh(), straight.mesh());
}

#[test]
fn points_that_moved_stay_where_they_are() {
    let threads = Threads::single();
    let first = ball_in_box();
    let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
    let place = first.points[27];
    refinement.refine(&nearest(&first, place, 200), &threads).unwrap();
    let sheared = |p: &Point| [p[0] + 0.2 * p[1], p[1] - 0.1 * p[2], 1.1 * p[2]];
    let moved: Vec<Point> = refinement.mesh().points.iter().map(sheared).collect();
    refinement.set_points(&moved).unwrap();
    refinement.refine(&nearest(refinement.mesh(), sheared(&place), 200), &threads).unwrap();
    // A shear maps midpoints to midpoints.
    let mut straight = Refinement::new(&first, Options::default(), &threads).unwrap();
    straight.refine(&nearest(&first, place, 200), &threads).unwrap();
    let mut again = first.clone();
    again.points = first.points.iter().map(sheared).collect();
    fits(&again, refinement.mesh());
    let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
    refinement.coarsen(&all, &threads).unwrap();
    let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
    refinement.coarsen(&all, &threads).unwrap();
    assert_eq!(refinement.mesh(), &again);
    assert!(refinement.set_points(&moved).is_err());
    assert!(refinement.refine(&[TetId(1 << 30)], &threads).is_err());
}

#[test]
fn the_order_of_marks_and_threads_change_nothing() {
    let (one, three) = (Threads::single(), Threads::new(3).unwrap());
    let first = random_mesh(400, 9);
    let mut numbers = Numbers(3);
    let mut a = Refinement::new(&first, Options::default(), &one).unwrap();
    let mut b = Refinement::new(&first, Options::default(), &three).unwrap();
    for _ in 0..3 {
        let mut marked: Vec<TetId> =
            (0..a.mesh().tets.len() as u32).map(TetId).filter(|_| numbers.unit() < 0.03).collect();
        a.refine(&marked, &one).unwrap();
        marked.reverse();
        b.refine(&marked, &three).unwrap();
        assert_eq!(a.mesh(), b.mesh());
        fits(&first, a.mesh());
    }
}

#[test]
fn a_linear_field_has_no_error_and_its_gradient_everywhere() {
    let threads = Threads::single();
    let mesh = random_mesh(200, 3);
    let values: Vec<f64> = mesh.points.iter().map(|p| 3.0 + 2.0 * p[0] - p[1] + 0.5 * p[2]).collect();
    for gradient in estimate::gradients(&mesh, &values, &threads) {
        assert!(distance(gradient, [2.0, -1.0, 0.5]) < 1e-6, "{gradient:?}");
    }
    assert!(estimate::gradient_jump(&mesh, &values, &threads).iter().all(|e| *e < 1e-6));
    assert!(estimate::recovery(&mesh, &values, &threads).iter().all(|e| *e < 1e-6));
}

#[test]
fn estimates_are_the_integrals_that_they_are_said_to_be() {
    let threads = Threads::single();
    // Two tets that share a facet in the plane z = 0, one above and one below.
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -2.0]];
    let mesh = TetMesh::new(points, vec![[0, 1, 2, 3].map(VertexId), [0, 1, 2, 4].map(VertexId)]);
    // The field z above and -3 z below: its derivative jumps by 4 across a triangle of area 1/2.
    let values = [0.0, 0.0, 0.0, 1.0, 6.0];
    let jump = estimate::gradient_jump(&mesh, &values, &threads);
    let expected = [2f64.sqrt(), 5f64.sqrt()].map(|h| (h / 24.0 * 16.0 * 0.5).sqrt());
    assert!(jump.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-14), "{jump:?} {expected:?}");
    // Recovered at the three shared vertices: (1/6 - 3 * 2/6) / (3/6); at the others the gradient of their
    // own tet.
    let recovered = (1.0 / 6.0 - 1.0) / 0.5;
    let by_quadrature = |own: f64, volume: f64| {
        // Four points integrate squares of linear functions exactly.
        let (a, b) = (0.138_196_601_125_010_5, 0.585_410_196_624_968_5);
        let at = |weight_of_tip: f64| (1.0 - weight_of_tip) * (recovered - own);
        (volume / 4.0 * (3.0 * at(a).powi(2) + at(b).powi(2))).sqrt()
    };
    let found = estimate::recovery(&mesh, &values, &threads);
    let expected = [by_quadrature(1.0, 1.0 / 6.0), by_quadrature(-3.0, 2.0 / 6.0)];
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-14), "{found:?} {expected:?}");
}

#[test]
fn a_turning_flow_has_vorticity_and_a_straining_one_none() {
    let threads = Threads::single();
    let mesh = ball_in_box();
    let turning: Vec<Point> = mesh.points.iter().map(|p| [-2.0 * p[1], 2.0 * p[0], 0.0]).collect();
    assert!(
        estimate::vorticity(&mesh, &turning, &threads).iter().all(|w| distance(*w, [0.0, 0.0, 4.0]) < 1e-9)
    );
    assert!(estimate::q_criterion(&mesh, &turning, &threads).iter().all(|q| (q - 4.0).abs() < 1e-9));
    let straining: Vec<Point> = mesh.points.iter().map(|p| [p[0], -p[1], 0.0]).collect();
    assert!(estimate::vorticity(&mesh, &straining, &threads).iter().all(|w| distance(*w, [0.0; 3]) < 1e-9));
    assert!(estimate::q_criterion(&mesh, &straining, &threads).iter().all(|q| (q + 1.0).abs() < 1e-9));
}

#[test]
fn marks_are_those_that_are_asked_for() {
    let threads = Threads::single();
    let mesh = random_mesh(300, 4);
    let centre = [0.4, 0.5, 0.6];
    let by_samples = |t: &[VertexId; 4], radius: f64| {
        let c = corners(&mesh, *t);
        let steps = 12;
        let near = |[i, j, k]: [usize; 3]| {
            let l = steps - i - j - k;
            let p = [0, 1, 2].map(|a| {
                [i, j, k, l].iter().zip(c).map(|(w, c)| *w as f64 * c[a]).sum::<f64>() / steps as f64
            });
            distance(p, centre) <= radius
        };
        let all = (0..=steps)
            .flat_map(|i| (0..=steps - i).flat_map(move |j| (0..=steps - i - j).map(move |k| [i, j, k])));
        all.into_iter().any(near)
    };
    let marked = mark::in_ball(&mesh, centre, 0.2, &threads);
    let (mut surely, mut n) = (0, 0);
    for (i, t) in (0..).zip(&mesh.tets) {
        // Tets found by a sample are marked, and marked tets are found within a slightly larger distance.
        let is_marked = marked.binary_search(&TetId(i)).is_ok();
        assert!(is_marked || !by_samples(t, 0.2));
        assert!(!is_marked || by_samples(t, 0.2 + 0.2));
        surely += usize::from(by_samples(t, 0.2));
        n += usize::from(is_marked);
    }
    assert!(surely > 50 && n >= surely && n < mesh.tets.len() / 2, "{surely} {n}");
    let estimates = [3.0, 0.0, 1.0, 3.0, f64::NAN, 2.0];
    // 9, 9, 4 and 1 of a total of 23.
    assert_eq!(mark::largest_share(&estimates, 0.35), [TetId(0)]);
    assert_eq!(mark::largest_share(&estimates, 0.5), [TetId(0), TetId(3)]);
    assert_eq!(mark::largest_share(&estimates, 1.0), [0, 2, 3, 5].map(TetId));
    assert_eq!(mark::largest_share(&estimates, 0.0), []);
    assert_eq!(mark::to_count(&estimates, 6 + 14), [TetId(0), TetId(3)]);
    assert_eq!(mark::to_count(&estimates, 2), []);
}

#[test]
fn edges_get_as_short_as_is_wanted_near_a_surface() {
    let threads = Threads::single();
    let first = ball_in_box();
    let plate = [[-0.3, -0.3, 0.02], [0.4, -0.3, 0.02], [0.0, 0.5, 0.02]].map(|p| add(p, [1.5, 0.0, 0.0]));
    let surface = NearestTriangle::new(&plate, &[[0, 1, 2].map(VertexId)], &threads);
    let (size, growth) = (0.12, 0.6);
    let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
    let mut n = 0;
    loop {
        let marked = mark::near_surface(refinement.mesh(), &surface, size, growth, &threads);
        println!("{} marked of {}", marked.len(), refinement.mesh().tets.len());
        if marked.is_empty() {
            break;
        }
        refinement.refine(&marked, &threads).unwrap();
        n += 1;
        assert!(n < 12);
    }
    assert!(n > 2);
    fits(&first, refinement.mesh());
    // By definition: no edge of a tet is longer than the size at its place nearest to the surface.
    let mesh = refinement.mesh();
    for t in &mesh.tets {
        let c = corners(mesh, *t);
        let longest = (0..4)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| distance(c[i], c[j]))
            .fold(0.0, f64::max);
        // The place of the tet nearest to the point of the surface that is nearest to its centre.
        let near = |p: Point| surface.closest(p).unwrap();
        let foot = near(centroid(c)).point;
        let weights = tet::closest(c, foot);
        let place = [0, 1, 2].map(|k| (0..4).map(|i| weights[i] * c[i][k]).sum::<f64>());
        assert!(longest <= size + growth * distance(place, foot) + 1e-12);
    }
}

/// The number of shapes up to size, position and reflection: by all distances of corners, in an order
/// independent of numbering.
fn n_shapes(mesh: &TetMesh) -> usize {
    let key = |t: &[VertexId; 4]| {
        let c = corners(mesh, *t);
        let size = volume(c).abs().cbrt();
        let orders = (0..4).flat_map(|a| {
            (0..4).flat_map(move |b| (0..4).map(move |c| [a, b, c, 6usize.wrapping_sub(a + b + c)]))
        });
        let orders = orders.filter(|o| (0..4).all(|v| o.contains(&v)));
        let lengths =
            |o: [usize; 4]| tet::EDGES.map(|[i, j]| (distance(c[o[i]], c[o[j]]) / size * 1e6).round() as i64);
        orders.map(lengths).min().unwrap()
    };
    let mut all: Vec<_> = mesh.tets.iter().map(key).collect();
    all.sort_unstable();
    // Allow for rounding in either direction.
    all.dedup_by(|x, y| x.iter().zip(y).all(|(x, y)| x.abs_diff(*y) <= 2));
    all.len()
}

#[test]
fn few_shapes_come_of_one() {
    let threads = Threads::single();
    let one = |points: [Point; 4]| TetMesh::new(points.to_vec(), vec![[0, 1, 2, 3].map(VertexId)]);
    let divided_by = |rule: Rule, first: &TetMesh, generations: usize| {
        let options = Options { rule, ..Options::default() };
        let mut refinement = Refinement::new(first, options, &threads).unwrap();
        for _ in 0..generations {
            let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
            refinement.refine(&all, &threads).unwrap();
        }
        n_shapes(refinement.mesh())
    };
    let divided = |first: &TetMesh, generations| divided_by(Rule::Shortest, first, generations);
    let regular = one([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]);
    let path = one([[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
    for generations in 1..6 {
        assert_eq!((divided(&regular, generations), divided(&path, generations)), (2, 1));
    }
    let mesh = random_mesh(100, 6);
    let counts: Vec<usize> =
        mesh.tets.iter().take(40).map(|t| divided(&one(corners(&mesh, *t)), 4)).collect();
    let most = counts.iter().max().unwrap();
    println!(
        "40 random tets, four generations: {} shapes in the mean, at most {most}",
        counts.iter().sum::<usize>() as f64 / 40.0
    );
    assert!(*most <= 40);
    // Bey's rule never produces more than three, and mostly worse ones.
    for tet in mesh.tets.iter().take(40) {
        assert!(divided_by(Rule::Bey, &one(corners(&mesh, *tet)), 4) <= 3);
    }
}

#[test]
fn tets_that_no_division_keeps_are_reported() {
    let threads = Threads::single();
    let mesh = random_mesh(100, 12);
    let mut n_reported = 0;
    for t in &mesh.tets {
        let first = TetMesh::new(corners(&mesh, *t).to_vec(), vec![[0, 1, 2, 3].map(VertexId)]);
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        for _ in 0..2 {
            refinement.refine(&nearest(refinement.mesh(), first.points[0], 2), &threads).unwrap();
        }
        // No part of a tet that is not bad may be bad.
        let (root, now) = (worst(&first, eas), refinement.mesh());
        let floor = if root >= 0.2 { (0.95 * root).max(0.2) } else { 0.95 * root };
        let is_bad = |i: &u32| eas(corners(now, now.tets[*i as usize])) < floor * (1.0 - 1e-9);
        let expected: Vec<TetId> = (0..now.tets.len() as u32).filter(is_bad).map(TetId).collect();
        let left = refinement.left(&threads);
        assert_eq!(left.iter().map(|left| left.tet).collect::<Vec<_>>(), expected);
        assert!(left.iter().all(|left| left.root == TetId(0) && left.eas < floor));
        n_reported += usize::from(!left.is_empty());
    }
    println!("{n_reported} of {} tets have parts that are worse", mesh.tets.len());
    assert!(n_reported > 0 && n_reported < mesh.tets.len());
}
