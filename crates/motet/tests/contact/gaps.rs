//! Contact: gaps compared with brute force, in metres and in millimetres.

use crate::common::Numbers;
use crate::surfaces::{Shape, bodies, coil, cube, oracle, sheet, soup, torus};
use motet::base::{Point, Threads, VertexId};
use motet::contact::{Body, Contact, Options, Room};
use motet::geometry::distance::triangle_triangle;
use motet::geometry::vector::{add, distance, norm, scale, sub};

/// Metres and millimetres.
const UNITS: [f64; 2] = [1e-3, 1.0];

fn contact(shapes: &[Shape], options: Options) -> Contact {
    let (points, bodies) = bodies(shapes);
    Contact::new(points, bodies, options, &Threads::single()).expect("the shapes are sound")
}

/// Compares all gaps of two shapes with the oracle, and with a second measurement that starts from the first.
fn holds(shapes: &[Shape; 2], what: &str) {
    for unit in UNITS {
        let shapes = shapes.clone().map(|shape| shape.scaled(unit));
        let tolerance = 1e-12 * oracle::size(&shapes);
        let mut contact = contact(&shapes, Options::default());
        let gaps = contact.measure(&Threads::single());
        for (own, other) in [(0, 1), (1, 0)] {
            let body = &gaps.bodies[own];
            let first = if own == 0 { 0 } else { shapes[0].points.len() };
            for (i, v) in body.vertices.iter().enumerate() {
                let p = shapes[own].points[v.index() - first];
                let expected = oracle::to_shape(p, &shapes[other]);
                let got = body.gap[i].abs();
                assert!(
                    (got - expected).abs() <= tolerance,
                    "{what}, unit {unit}: {got} for {expected} at {p:?}"
                );
                let place = body.closest_point[i];
                assert!((distance(p, place) - got).abs() <= tolerance, "{what}: the place is not that far");
                let triangle = shapes[other].corners(body.closest_triangle[i].get().unwrap().index());
                assert!(
                    oracle::point_triangle(place, triangle) <= tolerance,
                    "{what}: the place is not on its triangle"
                );
                let way = add(p, scale(body.normal[i], body.gap[i]));
                assert!(distance(way, place) <= tolerance || got == 0.0, "{what}: the normal leads astray");
            }
        }
        let expected = oracle::shapes(&shapes[0], &shapes[1]);
        let nearest = gaps.pairs[0].nearest.expect("no limit was set");
        let got = nearest.distance;
        assert!((got - expected).abs() <= tolerance, "{what}, unit {unit}: least {got} for {expected}");
        assert!((distance(nearest.points[0], nearest.points[1]) - got).abs() <= tolerance);
        assert_eq!(contact.measure(&Threads::single()), gaps, "{what}: a guess changed an answer");
    }
}

#[test]
fn a_thousand_random_pairs_have_the_gaps_of_a_look_at_everything() {
    let mut numbers = Numbers(7);
    for case in 0..1000 {
        let mut shape = || match numbers.below(4) {
            0 => {
                let n = 1 + numbers.below(20);
                soup(&mut numbers, n)
            }
            1 => sheet(1 + numbers.below(4) as u32, |_, _| 0.3 * numbers.unit()),
            2 => {
                let large = 0.3 + numbers.unit();
                torus(
                    3 + numbers.below(4) as u32,
                    3 + numbers.below(4) as u32,
                    [large, 0.1 + 0.1 * numbers.unit()],
                )
            }
            _ => cube().map(|p| p.map(|x| x + 0.3 * numbers_wave(p, x))),
        };
        let (a, b) = (shape(), shape());
        let reach = 2.0 * numbers.unit();
        let shift = [(); 3].map(|()| reach * (numbers.unit() - 0.3));
        holds(&[a, b.shifted(shift)], &format!("random pair {case}"));
    }
}

/// A shift that depends only on the place.
fn numbers_wave(p: Point, x: f64) -> f64 {
    (3.0 * p[0] + 5.0 * p[1] + 7.0 * p[2] + 11.0 * x).sin()
}

#[test]
fn a_thousand_degenerate_pairs_have_the_gaps_of_a_look_at_everything() {
    let mut numbers = Numbers(11);
    for case in 0..1000 {
        let grid = |numbers: &mut Numbers, n: usize| numbers.below(2 * n + 1) as f64 - n as f64;
        let step = [(); 3].map(|()| 0.5 * grid(&mut numbers, 3));
        let flat = |n: u32| sheet(n, |_, _| 0.0);
        let pair = match case % 8 {
            // Cubes on a grid: they touch in faces, edges and vertices, are nested, or coincide.
            0 => [cube(), cube().shifted(step)],
            1 => [cube(), cube().scaled(0.5).shifted(step)],
            // Sheets in one plane, apart or on top of each other.
            2 => [flat(3), flat(2).shifted([step[0], step[1], 0.0])],
            // A sheet that stands on another, or lies beside it.
            3 => [flat(2), flat(3).map(|p| [p[2] + step[0], p[0], p[1] + step[2]])],
            // Nested: round and flat ones with the same centre.
            4 => [torus(4, 6, [1.0, 0.5]), torus(4, 6, [1.0, 0.25 + 0.125 * grid(&mut numbers, 1)])],
            // Far apart.
            5 => [cube(), cube().shifted(step.map(|x| 1e6 * x + 3e6))],
            // Triangles without area, and all vertices twice.
            6 => {
                let mut flawed = flat(2);
                let n = flawed.points.len() as u32;
                let again = flawed.points.clone();
                flawed.points.extend(again);
                flawed.triangles.extend([[0, 0, 4], [0, 4, 8], [n, n + 4, n + 8], [2, 2, 2]]);
                [flawed, cube().shifted(step)]
            }
            // One triangle, a segment, or a point.
            _ => {
                let point = [0.5, 0.25, 0.0];
                let points = vec![point, add(point, step), [step[1], 0.5, step[2]]];
                let one = Shape { points, triangles: vec![[[0, 1, 2], [0, 1, 1], [0, 0, 0]][case / 8 % 3]] };
                [one, flat(2)]
            }
        };
        holds(&pair, &format!("degenerate pair {case}"));
    }
}

#[test]
fn a_guess_a_refit_and_threads_change_nothing() {
    let wave = |p: Point, t: f64| {
        let w = |x: f64| 0.01 * (9.0 * x + t).sin();
        [p[0] + w(p[1]), p[1] + w(p[2]), p[2] + w(p[0])]
    };
    let shapes = [torus(16, 60, [1.0, 0.3]), sheet(40, |x, y| 0.4 + 0.1 * (7.0 * x * y).sin())];
    let options = Options { warn: Some(0.2), ..Options::default() };
    let two = Threads::new(2).expect("two threads start");
    let (points, parts) = bodies(&shapes);
    let mut moving = Contact::new(points, parts, options, &two).expect("the shapes are sound");
    for step in 0..4 {
        let now = shapes.clone().map(|shape| shape.map(|p| wave(p, f64::from(step))));
        moving.refit(&bodies(&now).0, &two).expect("the points are finite");
        let anew = contact(&now, options).measure(&Threads::single());
        assert_eq!(moving.nearest(&two), [(anew.pairs[0].bodies, anew.pairs[0].nearest)]);
        assert_eq!(moving.measure(&two), anew);
        assert!(anew.is_warned());
    }
}

#[test]
fn every_warning_is_right_and_none_is_missing() {
    let mut numbers = Numbers(3);
    for case in 0..60 {
        let shapes = [soup(&mut numbers, 12), soup(&mut numbers, 12).shifted([0.4, 0.0, 0.0])];
        let warn = 0.02 + 0.1 * numbers.unit();
        let gaps =
            contact(&shapes, Options { warn: Some(warn), ..Options::default() }).measure(&Threads::single());
        for (own, other) in [(0, 1), (1, 0)] {
            let near = |t: usize| {
                let other = &shapes[other];
                let a = shapes[own].corners(t);
                (0..other.triangles.len()).any(|u| oracle::triangles(a, other.corners(u)) < warn)
            };
            for (t, triangle) in shapes[own].triangles.iter().enumerate() {
                // In a soup no two triangles share a vertex.
                for v in triangle {
                    assert_eq!(
                        gaps.bodies[own].warning[*v as usize],
                        near(t),
                        "case {case}, body {own}, triangle {t}"
                    );
                }
            }
        }
    }
}

#[test]
fn two_edges_that_cross_are_nearer_than_any_vertex() {
    let shape = |a: Point, b: Point, c: Point| Shape { points: vec![a, b, c], triangles: vec![[0, 1, 2]] };
    let lower = shape([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]);
    let upper = shape([0.0, -1.0, 0.1], [0.0, 1.0, 0.1], [0.0, 0.0, 1.0]);
    let gaps = contact(&[lower, upper], Options { warn: Some(0.11), ..Options::default() })
        .measure(&Threads::single());
    assert!((gaps.least() - 0.1).abs() < 1e-15);
    let least = gaps.bodies.iter().flat_map(|body| &body.gap).copied().fold(f64::INFINITY, f64::min);
    assert!(least > 0.7, "{least}");
    assert!(gaps.is_warned(), "what warns is the distance of surfaces, not of vertices");
}

#[test]
fn a_cube_in_a_cube_is_negative_and_in_a_room_positive() {
    let inner = cube().scaled(0.5).shifted([0.25; 3]);
    for turned in [false, true] {
        let outer = if turned { cube().turned_inside_out() } else { cube() };
        let (points, mut two) = bodies(&[inner.clone(), outer]);
        two[1].room = Room::No;
        let gaps = Contact::new(points.clone(), two.clone(), Options::default(), &Threads::single())
            .unwrap()
            .measure(&Threads::single());
        assert!(gaps.bodies[0].gap.iter().all(|&gap| gap == -0.25), "{:?}", gaps.bodies[0].gap);
        assert!(gaps.bodies[1].gap.iter().all(|&gap| gap > 0.0));
        assert_eq!((gaps.pairs[0].n_wrong, gaps.pairs[0].depth), ([8, 0], 0.25));
        assert!(gaps.pairs[0].crossings.is_empty() && gaps.pairs[0].is_penetrated());
        two[1].room = Room::Yes;
        let mut room = Contact::new(points, two, Options::default(), &Threads::single()).unwrap();
        let gaps = room.measure(&Threads::single());
        assert!(gaps.bodies[0].gap.iter().all(|&gap| gap == 0.25));
        assert!(!gaps.pairs[0].is_penetrated());
        // After a shift, one half is outside the room.
        let mut points = room.points().to_vec();
        points[..8].iter_mut().for_each(|p| p[0] += 0.5);
        room.refit(&points, &Threads::single()).unwrap();
        let gaps = room.measure(&Threads::single());
        assert_eq!(gaps.pairs[0].n_wrong[0], 4);
        assert_eq!(gaps.pairs[0].depth, 0.25);
        assert!(!gaps.pairs[0].crossings.is_empty());
        assert_eq!(gaps.least(), 0.0);
    }
}

#[test]
fn a_sheet_that_folds_meets_itself_and_one_that_is_flat_does_not() {
    // Rolled up along x to a spiral whose turns are 0.1 apart; lengths along the sheet are kept, apart from
    // chords.
    let spiral = |x: f64, y: f64| {
        let radius = |u: f64| 0.3 + 0.1 * u / std::f64::consts::TAU;
        let u = 12.0 * x;
        [radius(u) * u.cos(), radius(u) * u.sin(), y]
    };
    let rolled = sheet(60, |_, _| 0.0).map(|p| spiral(p[0], p[1]));
    let options = Options { own: true, warn: Some(0.12), ..Options::default() };
    let gaps = contact(std::slice::from_ref(&rolled), options).measure(&Threads::single());
    let body = &gaps.bodies[0];
    // Each point with a turn beside it is measured to that turn.
    let inner = (0..body.gap.len()).filter(|&i| 12.0 * f64::from(i as u32 / 61) / 60.0 < 12.0 - 7.0);
    for i in inner {
        assert!((0.085..0.101).contains(&body.gap[i]), "{} at {i}", body.gap[i]);
        assert!(body.warning[i]);
    }
    let least = gaps.least();
    assert!((0.08..0.1).contains(&least), "{least}");
    for flat in [sheet(30, |_, _| 0.0), sheet(30, |x, y| 0.1 * (6.0 * x).sin() * (6.0 * y).cos())] {
        let gaps =
            contact(&[flat], Options { own: true, within: 0.3, ..options }).measure(&Threads::single());
        assert!(gaps.bodies[0].closest_body.iter().all(|b| b.is_none()));
        assert!(gaps.pairs[0].nearest.is_none() && !gaps.is_warned());
    }
}

#[test]
fn a_coil_sees_its_next_turn_and_not_its_own_wire() {
    for unit in UNITS {
        let wire = coil(12, 240, [1.0, 0.1], 0.3, 4.0).scaled(unit);
        let options = Options { own: true, within: 0.25 * unit, ..Options::default() };
        let gaps = contact(std::slice::from_ref(&wire), options).measure(&Threads::single());
        let nearest = gaps.pairs[0].nearest.expect("turns are 0.1 apart");
        // Turns rise by 0.3 and the wire is 0.2 thick; their slope brings them a little nearer.
        let across = 0.3 / (1.0 + (0.3 / std::f64::consts::TAU).powi(2)).sqrt();
        assert!((nearest.distance / unit - (across - 0.2)).abs() < 6e-3, "{}", nearest.distance / unit);
        let body = &gaps.bodies[0];
        for (i, v) in body.vertices.iter().enumerate().filter(|(i, _)| body.closest_body[*i].is_some()) {
            let p = wire.points[v.index()];
            let to = body.closest_point[i];
            assert!(
                norm(sub(to, p)) > 0.09 * unit && (to[2] - p[2]).abs() > 0.05 * unit,
                "{p:?} sees {to:?}"
            );
        }
    }
}

#[test]
fn leaflets_that_share_an_edge_are_measured_away_from_it() {
    // A wedge of 20 degrees: two sheets that share the line x = 0.
    let angle = 20f64.to_radians();
    let lower = sheet(20, |_, _| 0.0);
    let n = lower.points.len();
    let points: Vec<Point> = lower
        .points
        .iter()
        .copied()
        .chain(lower.points.iter().map(|p| [p[0] * angle.cos(), p[1], p[0] * angle.sin()]))
        .collect();
    let id = |v: u32, second: bool| {
        let is_shared = lower.points[v as usize][0] == 0.0;
        VertexId(if second && !is_shared { v + n as u32 } else { v })
    };
    let body = |second: bool| Body {
        name: format!("leaflet {second}"),
        triangles: lower.triangles.iter().map(|t| t.map(|v| id(v, second))).collect(),
        room: Room::Found,
    };
    let mut wedge =
        Contact::new(points.clone(), vec![body(false), body(true)], Options::default(), &Threads::single())
            .unwrap();
    let gaps = wedge.measure(&Threads::single());
    let lower = &gaps.bodies[0];
    for (v, gap) in lower.vertices.iter().zip(&lower.gap) {
        let x = points[v.index()][0];
        if x > 0.0 {
            assert!((gap - x * angle.sin()).abs() < 1e-12, "{gap} at {x}");
        }
    }
}

#[test]
fn what_is_no_surface_is_refused_with_the_place() {
    let (points, two) = bodies(&[cube(), cube().shifted([3.0, 0.0, 0.0])]);
    let refused = |points: &[Point], bodies: &[Body], options: Options| {
        Contact::new(points.to_vec(), bodies.to_vec(), options, &Threads::single())
            .expect_err("it is flawed")
            .to_string()
    };
    let plain = Options::default();
    assert!(refused(&points, &two[..1], plain).contains("another surface"));
    assert!(refused(&points, &[], plain).contains('0'));
    let empty = Body { triangles: Vec::new(), ..two[0].clone() };
    assert!(refused(&points, &[two[0].clone(), empty], plain).contains("no triangles"));
    let mut nan = points.clone();
    nan[11][1] = f64::NAN;
    let said = refused(&nan, &two, plain);
    assert!(said.contains("body1") && said.contains("point 11"), "{said}");
    let mut beyond = two.clone();
    beyond[1].triangles[3][2] = VertexId(99);
    let said = refused(&points, &beyond, plain);
    assert!(said.contains("point 99") && said.contains("triangle 3"), "{said}");
    for options in [Options { warn: Some(-1.0), ..plain }, Options { within: f64::NAN, ..plain }] {
        assert!(refused(&points, &two, options).contains("not negative"));
    }
    let mut sound = Contact::new(points.clone(), two, plain, &Threads::single()).unwrap();
    assert!(
        sound.refit(&nan, &Threads::single()).is_err()
            && sound.refit(&points[1..], &Threads::single()).is_err()
    );
    assert_eq!(sound.points(), points, "nothing is taken over");
}

#[test]
fn what_is_remembered_of_far_parts_never_hides_a_near_one() {
    let mut numbers = Numbers(5);
    for case in 0..12 {
        let mut shapes = [torus(10, 30, [1.0, 0.3]), sheet(14, |x, y| 0.5 + 0.2 * (5.0 * x * y).sin())];
        let mut handle = contact(&shapes, Options::default());
        for step in 0..30 {
            // Small steps, and now and then a jump or one vertex alone.
            let reach = if step % 9 == 8 { 0.3 } else { 0.02 };
            let shift = [(); 3].map(|()| reach * (numbers.unit() - 0.5));
            let shape = &mut shapes[numbers.below(2)];
            if step % 5 == 4 {
                let v = numbers.below(shape.points.len());
                shape.points[v] = add(shape.points[v], scale(shift, 10.0));
            } else {
                shape.points.iter_mut().for_each(|p| *p = add(*p, shift));
            }
            let points = bodies(&shapes).0;
            handle.refit(&points, &Threads::single()).expect("the points are finite");
            let anew = contact(&shapes, Options::default()).nearest(&Threads::single());
            assert_eq!(handle.nearest(&Threads::single()), anew, "case {case}, step {step}");
        }
    }
}

#[test]
fn a_vertex_deep_inside_is_reported_however_short_the_reach() {
    let (points, mut two) = bodies(&[cube().scaled(0.1).shifted([0.45; 3]), cube()]);
    two[1].room = Room::No;
    let options = Options { within: 0.01, ..Options::default() };
    let gaps = Contact::new(points, two, options, &Threads::single()).unwrap().measure(&Threads::single());
    assert_eq!((gaps.pairs[0].n_wrong, gaps.pairs[0].nearest), ([8, 0], None));
    assert!(gaps.bodies[0].gap.iter().all(|gap| (gap + 0.45).abs() < 1e-12), "{:?}", gaps.bodies[0].gap);
    assert!((gaps.pairs[0].depth - 0.45).abs() < 1e-12);
}

#[test]
fn what_crosses_counts_whichever_way_it_faces() {
    // Two plates that cross at a small angle, so that their normals are much alike.
    let plate = || cube().map(|p| [4.0 * p[0], 4.0 * p[1], 0.1 * p[2]]);
    let turned = plate().map(|p| [p[0], p[1], p[2] + 0.05 * (p[0] - 2.0)]);
    let facing = Options { facing: true, ..Options::default() };
    let gaps = contact(&[plate(), turned.clone()], facing).measure(&Threads::single());
    assert_eq!(gaps.least(), 0.0);
    let all = contact(&[plate(), turned.clone()], Options::default()).measure(&Threads::single());
    assert_eq!(gaps.pairs[0].crossings, all.pairs[0].crossings);
    assert!(all.pairs[0].crossings.len() > 2);
    // Both as one body, and a bow-tie whose triangles share the vertex where they cross.
    let mut both = plate();
    both.triangles.extend(turned.triangles.iter().map(|t| t.map(|v| v + 8)));
    both.points.extend(turned.points);
    let own = Options { own: true, within: 1.0, ..Options::default() };
    let gaps = contact(&[both], own).measure(&Threads::single());
    assert_eq!((gaps.least(), gaps.pairs[0].crossings.len()), (0.0, all.pairs[0].crossings.len()));
    let points = vec![[0.0; 3], [2.0, 1.0, 0.0], [2.0, -1.0, 0.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
    let tie = Shape { points, triangles: vec![[0, 1, 2], [0, 3, 4]] };
    let gaps = contact(&[tie], own).measure(&Threads::single());
    assert_eq!(gaps.pairs[0].crossings, [[0, 1]]);
}

#[test]
fn a_surface_beside_a_far_larger_one_loses_nothing() {
    let mut numbers = Numbers(23);
    for size in [1e3, 1e8, 1e10, 1e14] {
        for case in 0..40 {
            let small = soup(&mut numbers, 9);
            let mut large = soup(&mut numbers, 9).map(|p| p.map(|x| size * (x - 0.5)));
            // Some triangles with one corner nearby.
            for v in [0, 3, 12] {
                large.points[v] = [(); 3].map(|()| 3.0 * numbers.unit());
            }
            for pair in [[small.clone(), large.clone()], [large, small]] {
                // The oracle's signs are wrong at such sizes.
                let least = |i| (0..9).map(move |j| (i, j));
                let expected = (0..9)
                    .flat_map(least)
                    .map(|(i, j)| triangle_triangle::closest(pair[0].corners(i), pair[1].corners(j)))
                    .map(|closest| closest.distance_squared.sqrt())
                    .fold(f64::INFINITY, f64::min);
                let got = contact(&pair, Options::default()).nearest(&Threads::single())[0]
                    .1
                    .expect("no limit")
                    .distance;
                assert!(
                    (got - expected).abs() <= 1e-15 * size,
                    "size {size}, case {case}: {got} for {expected}"
                );
            }
        }
    }
}
