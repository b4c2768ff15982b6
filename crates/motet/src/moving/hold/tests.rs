//! Surfaces of boxes and balls that are requested to pass through each other: how near they come is measured
//! over all pairs of triangles.

use std::collections::HashMap;
use std::f64::consts::PI;

use super::Hold;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::distance::triangle_triangle::{closest, meet};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub, unit};

type Triangles = Vec<[VertexId; 3]>;

/// The surface of the cube from -1 to 1, each side divided into `n` by `n` squares of two triangles; facing
/// outward.
fn cube(n: i32) -> (Vec<Point>, Triangles) {
    let (mut points, mut ids, mut triangles) = (Vec::new(), HashMap::new(), Vec::new());
    let mut id = |key: [i32; 3]| {
        *ids.entry(key).or_insert_with(|| {
            points.push(key.map(|x| f64::from(x) / f64::from(n)));
            VertexId::new(points.len() - 1)
        })
    };
    for axis in 0..3 {
        for side in [-n, n] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut corner = |u: i32, v: i32| {
                    let mut key = [side; 3];
                    (key[(axis + 1) % 3], key[(axis + 2) % 3]) = (2 * (i + u) - n, 2 * (j + v) - n);
                    id(key)
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let both = [[a, b, c], [a, c, d]];
                triangles.extend(if side > 0 { both } else { both.map(|[a, b, c]| [a, c, b]) });
            }
        }
    }
    (points, triangles)
}

/// A box, by its centre and half its side lengths.
fn block(n: i32, middle: Point, half: Point) -> (Vec<Point>, Triangles) {
    let (points, triangles) = cube(n);
    let place = |p: Point| [0, 1, 2].map(|k| middle[k] + half[k] * p[k]);
    (points.into_iter().map(place).collect(), triangles)
}

/// A ball, by its centre and radius.
fn ball(n: i32, middle: Point, radius: f64) -> (Vec<Point>, Triangles) {
    let (points, triangles) = cube(n);
    // Evenly spaced in angle.
    let place = |p: Point| add(middle, scale(unit(p.map(|x| (x * PI / 4.0).tan())).unwrap(), radius));
    (points.into_iter().map(place).collect(), triangles)
}

/// Walls that share one list of nodes.
struct Scene {
    places: Vec<Point>,
    bodies: Vec<Triangles>,
    /// The wall of each node.
    of: Vec<usize>,
}

impl Scene {
    fn of(surfaces: Vec<(Vec<Point>, Triangles)>) -> Self {
        let mut scene = Self { places: Vec::new(), bodies: Vec::new(), of: Vec::new() };
        for (k, (points, triangles)) in surfaces.into_iter().enumerate() {
            let first = scene.places.len();
            let later = |v: VertexId| VertexId::new(first + v.index());
            scene.bodies.push(triangles.into_iter().map(|t| t.map(later)).collect());
            scene.of.extend(points.iter().map(|_| k));
            scene.places.extend(points);
        }
        scene
    }

    /// The scene with each point moved by `place`.
    fn placed(mut self, place: impl Fn(Point) -> Point) -> Self {
        self.places.iter_mut().for_each(|p| *p = place(*p));
        self
    }

    /// The positions of the nodes when each wall is requested to follow its motion, and how many were
    /// stopped.
    fn held(&self, hold: f64, motion: impl Fn(usize, Point) -> Point) -> (Vec<Point>, usize) {
        let threads = Threads::single();
        let mut hold = Hold::between(hold, &self.places, &self.bodies, &threads).unwrap();
        let of = |(&p, &k): (&Point, &usize)| sub(motion(k, p), p);
        let displacement: Vec<Point> = self.places.iter().zip(&self.of).map(of).collect();
        let held = hold.stop(&self.places, &displacement, &threads);
        assert_eq!(held.cramped, None);
        (self.places.iter().zip(held.displacement).map(|(&p, d)| add(p, d)).collect(), held.n_nodes)
    }

    /// The positions of the nodes after each of `n` steps.
    fn steps(&self, hold: f64, n: usize, motion: impl Fn(usize, usize, Point) -> Point) -> Vec<Vec<Point>> {
        let threads = Threads::single();
        let mut hold = Hold::between(hold, &self.places, &self.bodies, &threads).unwrap();
        let step = |step: usize| {
            let of = |(&p, &k): (&Point, &usize)| sub(motion(step, k, p), p);
            let displacement: Vec<Point> = self.places.iter().zip(&self.of).map(of).collect();
            let held = hold.stop(&self.places, &displacement, &threads);
            hold.advance(&held.displacement, 1.0);
            self.places.iter().zip(held.displacement).map(|(&p, d)| add(p, d)).collect()
        };
        (1..=n).map(step).collect()
    }

    /// The least distance between any two walls, over all pairs of triangles.
    fn gap(&self, at: &[Point]) -> f64 {
        let corners = |t: &[VertexId; 3]| t.map(|v| at[v.index()]);
        let mut least = f64::INFINITY;
        for (k, a) in self.bodies.iter().enumerate() {
            for b in self.bodies[k + 1..].iter().flatten() {
                let near = a.iter().map(|a| closest(corners(a), corners(b)).distance());
                least = near.fold(least, f64::min);
            }
        }
        least
    }

    /// Asserts that every wall is sound: no triangle turned over or lost, and none through another.
    fn assert_sound(&self, at: &[Point], what: &str) {
        for body in &self.bodies {
            for t in body {
                let [was, is] = [&self.places[..], at].map(|p| area_vector(t.map(|v| p[v.index()])));
                let corners = |p: &[Point]| t.map(|v| p[v.index()]);
                assert!(
                    dot(was, is) > 0.02 * dot(was, was),
                    "{what}: {t:?} is turned over or lost: {:?} became {:?}",
                    corners(&self.places),
                    corners(at)
                );
            }
            for (i, a) in body.iter().enumerate() {
                let others = body[i + 1..].iter().filter(|b| a.iter().all(|v| !b.contains(v)));
                let corners = |t: &[VertexId; 3]| t.map(|v| at[v.index()]);
                assert!(
                    others.clone().all(|b| !meet(corners(a), corners(b))),
                    "{what}: a wall is through itself"
                );
            }
        }
    }
}

/// Where a point of a scene is placed.
type Placing = fn(Point) -> Point;

/// Rotated about an axis, shifted, and in another unit of length.
fn elsewhere(p: Point) -> Point {
    let axis = unit([1.0, -0.4, 0.7]).unwrap();
    let (sine, cosine) = 0.9f64.sin_cos();
    let along = scale(axis, dot(axis, p) * (1.0 - cosine));
    add(scale(add(add(scale(p, cosine), scale(cross(axis, p), sine)), along), 7.0), [40.0, -3.0, 11.0])
}

fn small_and_far(p: Point) -> Point {
    scale(add(p, [30.0, -70.0, 20.0]), 1e-3)
}

/// The first wall is 0.8 above the second and is requested to go down by a fraction of that; a distance of
/// 0.2 is kept.
fn pressed(name: &str, surfaces: impl Fn() -> Vec<(Vec<Point>, Triangles)>) {
    for part in [0.5, 0.75, 0.9, 1.0, 1.25, 1.5, 3.0, 5.0] {
        let placed: [(Placing, f64); 3] = [(|p| p, 1.0), (elsewhere, 7.0), (small_and_far, 1e-3)];
        for (place, unit) in placed {
            let scene = Scene::of(surfaces()).placed(place);
            let down = sub(place([0.0, -0.8 * part, 0.0]), place([0.0; 3]));
            let (at, n) = scene.held(0.2 * unit, |k, p| if k == 0 { add(p, down) } else { p });
            let (gap, what) =
                (scene.gap(&at) / unit, format!("{name}, {part} of the way, in units of {unit}"));
            let expected = (0.8 * (1.0 - part)).max(0.2);
            // Until walls are stopped, positions are as exact as rounded coordinates.
            assert!(gap >= expected * (1.0 - 1e-9), "{what}: {gap}");
            assert!(gap <= expected * (1.0 + 1e-4), "{what}: {gap}");
            assert_eq!(n > 0, part > 0.75, "{what}: {n}");
            scene.assert_sound(&at, &what);
            let stays = |(p, q): (&Point, &Point)| p == q;
            let second = scene.of.iter().position(|k| *k == 1).unwrap();
            assert!(
                scene.places[second..].iter().zip(&at[second..]).all(stays),
                "{what}: the other wall moved"
            );
        }
    }
}

#[test]
fn a_flat_wall_stops_in_front_of_a_flat_one() {
    pressed("like on like", || {
        vec![block(3, [0.0, 0.8, 0.0], [1.5, 0.4, 1.5]), block(3, [0.0, -0.8, 0.0], [1.5, 0.4, 1.5])]
    });
    pressed("wide on narrow", || {
        vec![block(4, [0.1, 0.8, 0.0], [2.0, 0.4, 2.0]), block(2, [0.0, -0.8, 0.0], [0.9, 0.4, 0.9])]
    });
    pressed("narrow on wide", || {
        vec![block(2, [0.1, 0.8, 0.0], [0.9, 0.4, 0.9]), block(3, [0.0, -0.8, 0.0], [2.0, 0.4, 2.0])]
    });
}

#[test]
fn balls_and_boxes_stop_in_front_of_each_other() {
    pressed("ball on ball", || vec![ball(4, [0.0, 1.4, 0.0], 1.0), ball(4, [0.0, -1.4, 0.0], 1.0)]);
    pressed("ball on finer ball", || vec![ball(4, [0.0, 1.4, 0.0], 1.0), ball(6, [0.0, -1.4, 0.0], 1.0)]);
    pressed("box on ball", || {
        vec![block(2, [0.0, 1.0, 0.0], [1.2, 0.6, 1.2]), ball(4, [0.0, -1.4, 0.0], 1.0)]
    });
    pressed("ball on box", || {
        vec![ball(4, [0.0, 1.4, 0.0], 1.0), block(3, [0.0, -1.0, 0.0], [1.2, 0.6, 1.2])]
    });
}

/// A ball inside a room, requested to go into a corner of it and beyond.
#[test]
fn a_ball_stops_in_a_corner_of_its_room_and_in_a_hollow_one() {
    for far in [1.5, 2.0, 3.0, 9.0] {
        let scene = Scene::of(vec![ball(4, [0.0; 3], 1.0), block(2, [0.0; 3], [3.0; 3])]);
        let (at, n) = scene.held(0.2, |k, p| if k == 0 { add(p, [far, far, 0.0]) } else { p });
        let expected = (2.0 - far).max(0.2);
        assert!((scene.gap(&at) / expected - 1.0).abs() < 1e-3, "{far}: {}", scene.gap(&at));
        assert_eq!(n > 0, far > 1.8);
        scene.assert_sound(&at, &format!("corner, {far}"));
        let scene = Scene::of(vec![ball(3, [0.0; 3], 1.0), ball(5, [0.0; 3], 3.0)]);
        let (at, n) = scene.held(0.2, |k, p| if k == 0 { add(p, [0.3 * far, far, 0.0]) } else { p });
        assert!(n > 0 || far < 1.8);
        assert!(scene.gap(&at) >= 0.2 * (1.0 - 1e-3), "{far}: {}", scene.gap(&at));
        scene.assert_sound(&at, &format!("hollow, {far}"));
    }
}

/// A ball that comes down into the corner between two walls: a floor, and a block beside it.
#[test]
fn what_gives_way_to_two_walls_keeps_its_distance_from_both() {
    for far in [0.2, 1.0, 2.0, 6.0] {
        let scene = Scene::of(vec![
            ball(4, [0.0; 3], 1.0),
            block(2, [0.0, -2.1, 0.0], [5.0, 0.5, 5.0]),
            block(2, [2.1, 1.0, 0.0], [0.5, 2.25, 5.0]),
        ]);
        let (at, n) = scene.held(0.3, |k, p| if k == 0 { add(p, [far, -far, 0.0]) } else { p });
        // The two walls themselves are 0.35 apart.
        let expected = (0.6f64 - far).clamp(0.3, 0.35);
        assert!((scene.gap(&at) / expected - 1.0).abs() < 1e-3, "{far}: {}", scene.gap(&at));
        assert_eq!(n > 0, far > 0.3);
        scene.assert_sound(&at, &format!("two walls, {far}"));
    }
}

/// A square sheet of 2 n n triangles with an open rim.
fn sheet(n: usize, middle: Point, half: f64) -> (Vec<Point>, Triangles) {
    let x = |i: usize| half * (2.0 * i as f64 / n as f64 - 1.0);
    let points = (0..=n).flat_map(|i| (0..=n).map(move |j| add(middle, [x(i), 0.0, x(j)]))).collect();
    let id = |i: usize, j: usize| VertexId::new(i * (n + 1) + j);
    let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let triangles = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (points, triangles.collect())
}

#[test]
fn membranes_stop_in_front_of_each_other() {
    pressed("sheets", || vec![sheet(5, [0.1, 0.4, 0.0], 1.0), sheet(4, [0.0, -0.4, 0.0], 1.1)]);
    pressed("narrow sheet", || vec![sheet(5, [0.1, 0.4, 0.0], 1.0), sheet(2, [0.0, -0.4, 0.0], 0.4)]);
}

#[test]
fn a_wall_gives_way_to_one_that_comes_to_it() {
    for far in [0.5, 1.0, 3.0, 20.0] {
        let scene =
            Scene::of(vec![ball(4, [0.1, 1.4, 0.0], 1.0), block(3, [0.0, -0.8, 0.0], [1.5, 0.4, 1.5])]);
        let (at, n) = scene.held(0.2, |k, p| if k == 1 { add(p, [0.0, far, 0.0]) } else { p });
        let expected = (0.8f64 - far).max(0.2);
        assert!((scene.gap(&at) / expected - 1.0).abs() < 1e-4, "{far}: {}", scene.gap(&at));
        assert_eq!(n > 0, far > 0.6, "{far}");
        scene.assert_sound(&at, &format!("pushed by {far}"));
    }
}

#[test]
fn what_goes_round_in_steps_goes_round() {
    let scene = Scene::of(vec![ball(4, [0.0, 1.4, 0.0], 1.0), ball(4, [0.0, -1.4, 0.0], 1.0)]);
    let round = |step: usize, k: usize, p: Point| {
        let (sine, cosine) = (step as f64 * 15f64.to_radians()).sin_cos();
        let off = [p[0], p[1] + 1.4];
        if k == 0 {
            [off[0] * cosine - off[1] * sine, off[0] * sine + off[1] * cosine - 1.4, p[2]]
        } else {
            p
        }
    };
    for (step, at) in (1..).zip(scene.steps(0.2, 24, round)) {
        let requested = scene.places.iter().zip(&scene.of).map(|(&p, &k)| round(step, k, p));
        assert!(requested.zip(&at).all(|(p, q)| norm(sub(p, *q)) < 1e-14), "step {step}");
    }
}

#[test]
fn what_is_pressed_on_for_long_stays_and_what_comes_back_is_where_it_was() {
    // Off centre, so that the ball could slip.
    let scene = Scene::of(vec![ball(4, [0.3, 1.4, 0.1], 1.0), ball(4, [0.0, -1.4, 0.0], 1.0)]);
    let pressed = scene.steps(0.2, 20, |_, k, p| if k == 0 { add(p, [0.0, -2.0, 0.0]) } else { p });
    for at in &pressed {
        assert!((scene.gap(at) / 0.2 - 1.0).abs() < 1e-4, "{}", scene.gap(at));
        scene.assert_sound(at, "pressed on");
        let farthest = at.iter().zip(&pressed[0]).map(|(&p, &q)| norm(sub(p, q))).fold(0.0, f64::max);
        assert!(farthest < 0.2, "slipped by {farthest}");
    }
    // A hundred times there and back.
    let beat = |step: usize| [0.0, -0.5, -1.0, -2.0, -0.5, 0.0][step % 6];
    let beaten = scene.steps(0.2, 600, |step, k, p| if k == 0 { add(p, [0.0, beat(step), 0.0]) } else { p });
    for (step, at) in (1..).zip(&beaten) {
        assert!(step > 6 || scene.gap(at) > 0.2 * (1.0 - 1e-9), "step {step}: {}", scene.gap(at));
        if beat(step) == 0.0 {
            assert!(*at == scene.places, "step {step}");
        }
        assert!(step <= 6 || *at == beaten[step - 7], "step {step} is as a cycle before");
    }
}

#[test]
fn walls_without_room_are_reported_and_so_is_how_far_a_node_was_stopped() {
    let threads = Threads::single();
    let scene = Scene::of(vec![
        ball(4, [0.0; 3], 1.0),
        block(2, [0.0, -2.1, 0.0], [5.0, 0.5, 5.0]),
        block(2, [0.0, 2.1, 0.0], [5.0, 0.5, 5.0]),
    ]);
    let mut hold = Hold::between(0.3, &scene.places, &scene.bodies, &threads).unwrap();
    let to = |by: [f64; 3]| -> Vec<Point> { scene.of.iter().map(|k| [0.0, by[*k], 0.0]).collect() };
    let held = hold.stop(&scene.places, &to([-5.0, 0.0, 0.0]), &threads);
    let stopped = held.farthest.unwrap();
    assert!(held.cramped.is_none() && stopped.wall == 0 && (stopped.short - 4.7).abs() < 1e-3, "{stopped:?}");
    // The two blocks come as near to each other as allowed: no space is left for the ball.
    let held = hold.stop(&scene.places, &to([0.0, 0.0, -3.0]), &threads);
    assert_eq!(held.cramped, Some(0));
    for too_small in [0.0, -1.0, 1e-13, f64::NAN, f64::INFINITY] {
        assert!(Hold::between(too_small, &scene.places, &scene.bodies, &threads).is_err());
    }
}

#[test]
fn walls_that_both_move_stop_by_how_they_move_to_each_other() {
    let scene = || Scene::of(vec![ball(4, [0.0, 1.4, 0.0], 1.0), ball(4, [0.0, -1.4, 0.0], 1.0)]);
    // Each goes half of the way: the second reaches its requested place.
    let (at, n) = scene().held(0.2, |k, p| add(p, [0.0, if k == 0 { -0.6 } else { 0.6 }, 0.0]));
    assert!(n > 0 && (scene().gap(&at) - 0.2).abs() < 1e-4 * 0.2, "{}", scene().gap(&at));
    // Both move far away together, shifted and rotated: nothing stops, to the bit.
    let both = |p: Point| elsewhere(scale(p, 1.0 / 7.0));
    let (at, n) = scene().held(0.2, |_, p| both(p));
    assert_eq!(n, 0);
    assert!((scene().gap(&at) - 0.8).abs() < 1e-12);
    // And one of them nearer than allowed.
    let (at, n) = scene().held(0.2, |k, p| both(if k == 0 { add(p, [0.0, -1.5, 0.0]) } else { p }));
    assert!(n > 0 && (scene().gap(&at) - 0.2).abs() < 1e-4 * 0.2, "{}", scene().gap(&at));
    // The second grows until there is no more space.
    let grown = |p: Point| add([0.0, -1.4, 0.0], scale(sub(p, [0.0, -1.4, 0.0]), 1.9));
    let (at, n) = scene().held(0.2, |k, p| if k == 1 { grown(p) } else { p });
    assert!(n > 0 && scene().gap(&at) >= 0.2 * (1.0 - 1e-3), "{}", scene().gap(&at));
}

#[test]
fn what_slides_along_far_goes_all_the_way() {
    // Next to a long wall, just above the distance from it, and pressed onto it.
    let scene =
        || Scene::of(vec![ball(4, [0.0, 1.25, 0.0], 1.0), block(4, [50.0, -1.0, 0.0], [60.0, 1.0, 2.0])]);
    let (at, n) = scene().held(0.2, |k, p| if k == 0 { add(p, [90.0, 0.0, 0.0]) } else { p });
    assert_eq!(n, 0, "{:?}", at[0]);
    let (at, n) = scene().held(0.2, |k, p| if k == 0 { add(p, [90.0, -0.3, 0.0]) } else { p });
    let lowest =
        at[..scene().of.iter().filter(|k| **k == 0).count()].iter().map(|p| p[1]).fold(9.0, f64::min);
    assert!(n > 0 && (lowest - 0.2).abs() < 1e-9, "{lowest}");
    // Friction holds it back by at most how far it is pressed on.
    let middle = at.iter().zip(&scene().of).filter(|(_, k)| **k == 0).map(|(p, _)| p[0]).fold(0.0, f64::max);
    assert!((90.7..=91.0).contains(&middle), "{middle}");
}

#[test]
fn what_is_joined_to_a_wall_stays_as_near_as_it_was() {
    // A strip that stands on a floor, joined to it at its foot, bends down onto it.
    let (mut points, mut floor, mut strip) = (Vec::new(), Vec::new(), Vec::new());
    let (n, width) = (12, 3);
    let id = |i: usize, j: usize| VertexId::new(i * (width + 1) + j);
    for i in 0..=2 * n {
        (0..=width).for_each(|j| points.push([i as f64 - n as f64, 0.0, j as f64]));
    }
    let first = points.len();
    for i in 1..=n {
        (0..=width).for_each(|j| points.push([0.0, i as f64, j as f64]));
    }
    let quad = |a, b, c, d| [[a, b, c], [a, c, d]];
    for j in 0..width {
        (0..2 * n).for_each(|i| floor.extend(quad(id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1))));
        let up = |i: usize, j: usize| {
            if i == 0 { id(n, j) } else { VertexId::new(first + (i - 1) * (width + 1) + j) }
        };
        (0..n).for_each(|i| strip.extend(quad(up(i, j), up(i + 1, j), up(i + 1, j + 1), up(i, j + 1))));
    }
    let of = (0..points.len()).map(|i| usize::from(i < first)).collect();
    let scene = Scene { places: points, bodies: vec![strip, floor], of };
    for degrees in [45.0f64, 85.0, 100.0, 130.0] {
        // Bent more, the farther from the foot.
        let bent = |p: Point| {
            let angle = degrees.to_radians() * (p[1] / n as f64).min(1.0);
            [p[1] * angle.sin(), p[1] * angle.cos(), p[2]]
        };
        let (at, held) = scene.held(1.5, |k, p| if k == 0 { bent(p) } else { p });
        assert!(held > 0, "{degrees}: {held}");
        for (p, q) in scene.places.iter().zip(&at).skip(first) {
            assert!(
                q[1] >= p[1].min(1.5) * (1.0 - 1e-3) || q[0].abs() > 12.0,
                "{degrees}: {p:?} is at {q:?}"
            );
        }
    }
}
