//! Surfaces wrapped: against the boxes, tubes and balls that were torn apart.

use motet::base::{Threads, VertexId};
use motet::geometry::triangle::{area, centroid, middles};
use motet::mesh::shapes::ball;
use motet::mesh::{Surface, open_edges};
use motet::meshing::Surfaces;
use motet::preflight::{RepairKind, Repaired, Repairs, Role, own_crossings};
use motet::spatial::NearestTriangle;

use crate::common::random::Random;

use super::joints::{CASES, IMPRINT, Soup, box_of, moved, random_boxes, repaired, scale_of, sheet, together};

fn wrap(distance: f64) -> Repairs {
    Repairs { imprint: false, orient: true, wrap: Some(distance), ..IMPRINT }
}

fn volume(surfaces: &Surfaces) -> f64 {
    let cone = |t: &[VertexId; 3]| {
        let [[a, b, c], [d, e, f], [g, h, i]] = t.map(|v| surfaces.points[v.index()]);
        a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    };
    surfaces.triangles.iter().map(cone).sum::<f64>() / 6.0
}

fn total_area(surfaces: &Surfaces) -> f64 {
    surfaces.triangles.iter().map(|t| area(t.map(|v| surfaces.points[v.index()]))).sum()
}

/// Closed, free of crossings, and nowhere farther than `distance` from the given triangles.
fn assert_sound(surfaces: &Surfaces, done: &Repaired, given: &Soup, distance: f64) {
    assert_eq!((done.count(RepairKind::Wrapped), surfaces.roles.len()), (1, 1));
    assert!(open_edges(&surfaces.triangles).is_empty());
    assert!(own_crossings(&surfaces.points, &surfaces.triangles, &Threads::single()).is_empty());
    let tree = NearestTriangle::new(&given.0, &given.1, &Threads::single());
    for t in &surfaces.triangles {
        let corners = t.map(|v| surfaces.points[v.index()]);
        for p in corners.into_iter().chain(middles(corners)).chain([centroid(corners)]) {
            let away = tree.closest(p).unwrap().distance_squared.sqrt();
            assert!(away <= distance, "{p:?} is {away} away");
        }
    }
}

#[test]
fn bodies_that_cross_are_wrapped_as_one() {
    for case in 0..CASES {
        let second = [[0.4, 0.3, -0.2], [1.9, 0.8, 0.7]];
        let both = together(&[box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of([1, 2, 1], second)]);
        let expected = 1.0 + 1.5 * 0.5 * 0.9 - 0.6 * 0.5 * 0.7;
        let (both, unit) = (moved(case, &both), scale_of(case).1);
        let distance = 0.02 * unit;
        let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &wrap(distance));
        assert_sound(&surfaces, &done, &both, distance);
        let off = (volume(&surfaces) - expected * unit.powi(3)).abs();
        assert!(off < 0.5 * total_area(&surfaces) * distance, "case {case}: {off}");
        assert_eq!(done.count(RepairKind::DroppedThin), 0);
    }
}

/// A ball whose triangles share no vertices, every tenth of which is missing, and some are doubled.
#[test]
fn a_torn_ball_is_whole() {
    let given = Surface::boundary_of(&ball(12, 2));
    let (mut soup, mut random): (Soup, _) = (Soup::default(), Random(5));
    for t in &given.triangles {
        for _ in 0..[0, 1, 1, 1, 1, 1, 1, 1, 1, 2][(random.next() * 10.0) as usize] {
            let first = soup.0.len();
            soup.0.extend(t.map(|v| given.points[v.index()]));
            soup.1.push([0, 1, 2].map(|k| VertexId::new(first + k)));
        }
    }
    let whole = (given.points.clone(), given.triangles.clone());
    // Holes are as wide as a triangle: the surface there is that far from a plane.
    let (surfaces, done) = repaired(&[(&soup, Role::Boundary)], &wrap(0.01));
    assert_sound(&surfaces, &done, &whole, 0.05);
    assert!((volume(&surfaces) / given.enclosed_volume() - 1.0).abs() < 0.03, "{}", volume(&surfaces));
}

/// Plane holes are closed in their planes.
#[test]
fn an_open_box_is_closed_whichever_way_it_faces() {
    let (points, triangles) = box_of([4; 3], [[0.0; 3], [1.0, 1.0, 3.0]]);
    let is_end = |t: &[VertexId; 3]| [0.0, 3.0].iter().any(|z| t.iter().all(|v| points[v.index()][2] == *z));
    let mut open: Vec<[VertexId; 3]> = triangles.iter().copied().filter(|t| !is_end(t)).collect();
    for _ in 0..2 {
        open.iter_mut().for_each(|t| t.swap(1, 2));
        let soup = (points.clone(), open.clone());
        let (surfaces, done) = repaired(&[(&soup, Role::Boundary)], &wrap(0.01));
        assert_sound(&surfaces, &done, &(points.clone(), triangles.clone()), 0.02);
        assert!((volume(&surfaces) - 3.0).abs() < 0.06, "{}", volume(&surfaces));
        assert!(done.new_points.iter().all(|(of, weights)| {
            of.iter().all(|v| v.index() < points.len()) && (weights.iter().sum::<f64>() - 1.0).abs() < 1e-9
        }));
    }
}

/// A part of a cylinder of radius 2, bent by 0.6 radians.
fn bent_sheet() -> Soup {
    let n = 12;
    let at = |i: usize, z: f64| {
        let angle = 0.6 * i as f64 / n as f64;
        [5.0 + 2.0 * angle.cos(), 2.0 * angle.sin(), z]
    };
    let points = (0..=n).flat_map(|i| [at(i, 0.0), at(i, 1.0)]).collect();
    let quad = |i: usize| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
    (points, (0..n).flat_map(quad).map(|t| t.map(VertexId::new)).collect())
}

/// A void stays, a sheet that encloses nothing goes, a plate thinner than the distance may go, which is said.
#[test]
fn what_is_left_out_is_said() {
    let (outer, (inner, faces)) =
        (box_of([3; 3], [[0.0; 3], [1.0; 3]]), box_of([2; 3], [[0.3; 3], [0.6; 3]]));
    let void = (inner, faces.into_iter().map(|[a, b, c]| [a, c, b]).collect());
    let apart = sheet([3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let plate = box_of([2; 3], [[-3.0, 0.0, 0.0], [-2.998, 1.0, 1.0]]);
    let bent = bent_sheet();
    let n_bent = bent.1.len();
    let all = together(&[outer, void, apart, bent, plate]);
    let (surfaces, done) = repaired(&[(&all, Role::Boundary)], &wrap(0.02));
    assert_sound(&surfaces, &done, &all, 0.02);
    assert!((volume(&surfaces) - (1.0 - 0.027)).abs() < 0.02, "{}", volume(&surfaces));
    assert!(done.count(RepairKind::DroppedOutside) >= 2 + n_bent);
    for nothing in [sheet([3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), bent_sheet()] {
        let (of, roles) = (vec![0; nothing.1.len()], [Role::Boundary]);
        let refused =
            motet::preflight::repair(&nothing.0, &nothing.1, &of, &roles, &wrap(0.02), &Threads::single());
        assert!(refused.unwrap_err().to_string().contains("enclose nothing"));
    }
}

#[test]
fn random_boxes_are_wrapped_as_the_cells_in_them() {
    for seed in 0..6u64 {
        let (bodies, n_cells) = random_boxes(seed, 4);
        let all = moved(seed as usize % CASES, &together(&bodies));
        let unit = scale_of(seed as usize % CASES).1;
        let (surfaces, done) = repaired(&[(&all, Role::Boundary)], &wrap(0.1 * unit));
        assert_sound(&surfaces, &done, &all, 0.1 * unit);
        let off = (volume(&surfaces) / unit.powi(3) - n_cells as f64).abs();
        assert!(off < 0.05 * total_area(&surfaces) / (unit * unit), "seed {seed}: {off}");
    }
}

#[test]
fn threads_and_bad_distances() {
    let both = together(&[
        box_of([2; 3], [[0.0; 3], [1.0; 3]]),
        box_of([1; 3], [[0.4, 0.3, -0.2], [1.9, 0.8, 0.7]]),
    ]);
    let with = |threads: &Threads, distance: f64| {
        let roles = [Role::Boundary];
        motet::preflight::repair(&both.0, &both.1, &vec![0; both.1.len()], &roles, &wrap(distance), threads)
    };
    let one = with(&Threads::single(), 0.02).unwrap();
    assert_eq!(one, with(&Threads::exactly(3).unwrap(), 0.02).unwrap());
    for distance in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
        let error = with(&Threads::single(), distance).unwrap_err().to_string();
        assert!(error.contains("wrapped surface"), "{error}");
    }
}
