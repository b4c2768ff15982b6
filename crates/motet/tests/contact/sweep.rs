//! The first contact of moving surfaces: never reported too late, and hardly too early; compared with roots
//! of the cubics and with dense sampling in time.

use crate::common::Numbers;
use motet::base::{Point, Threads, VertexId};
use motet::contact::{Sweep, sweep, sweep_own};
use motet::geometry::distance::triangle_triangle;
use motet::geometry::vector::{add, cross, dot, norm, scale, sub};
use motet::mesh::Surface;
use motet::mesh::shapes::ball;

type Triangle = [Point; 3];
const A: [[VertexId; 3]; 1] = [[VertexId(0), VertexId(1), VertexId(2)]];
const B: [[VertexId; 3]; 1] = [[VertexId(3), VertexId(4), VertexId(5)]];

fn always(_: u32, _: u32) -> bool {
    true
}

/// The contact time of two triangles alone.
fn time(x: [Triangle; 2], v: [Triangle; 2], horizon: f64) -> f64 {
    let found = sweep(x.as_flattened(), v.as_flattened(), &A, &B, horizon, always, &Threads::single());
    assert_eq!(found.times[0], found.times[1]);
    assert_eq!(found.first.map_or(f64::INFINITY, |f| f.time), found.times[0][0]);
    found.times[0][0]
}

fn at(x: [Triangle; 2], v: [Triangle; 2], time: f64) -> [Triangle; 2] {
    [0, 1].map(|t| [0, 1, 2].map(|k| add(x[t][k], scale(v[t][k], time))))
}

fn random(numbers: &mut Numbers) -> Point {
    [(); 3].map(|()| 2.0 * numbers.unit() - 1.0)
}

/// Two triangles beside each other that mostly approach each other: with a common motion, and of all shapes.
fn case(numbers: &mut Numbers) -> ([Triangle; 2], [Triangle; 2]) {
    let mut triangle = |shift: f64| [(); 3].map(|()| add(random(numbers), [shift, 0.0, 0.0]));
    let mut x = [triangle(0.0), triangle(2.0 + 0.5)];
    let (turning, common) =
        ([0.1, 1.0, 3.0][numbers.below(3)], scale(random(numbers), [0.0, 1.0, 100.0][numbers.below(3)]));
    let approach = [0.3, 1.0, 5.0][numbers.below(3)] * numbers.unit();
    let mut velocities =
        |along: f64| [(); 3].map(|()| add(add(scale(random(numbers), turning), [along, 0.0, 0.0]), common));
    let v = [velocities(approach), velocities(-approach)];
    if numbers.below(4) == 0 {
        // A needle.
        x[1][2] = add(x[1][1], scale(sub(x[1][2], x[1][1]), 1e-4));
    }
    (x, v)
}

/// Roots in [0, horizon] of the volume of the tet of four moving points, which has at most one root between
/// zeros of its slope.
fn coplanar_times(x: [Point; 4], v: [Point; 4], horizon: f64) -> Vec<f64> {
    let [a, b, c] = [1, 2, 3].map(|k| sub(x[k], x[0]));
    let [d, e, f] = [1, 2, 3].map(|k| sub(v[k], v[0]));
    let volume = |a, b, c| dot(cross(a, b), c);
    let cubic = [
        volume(a, b, c),
        volume(d, b, c) + volume(a, e, c) + volume(a, b, f),
        volume(d, e, c) + volume(d, b, f) + volume(a, e, f),
        volume(d, e, f),
    ];
    let value = |t: f64| ((cubic[3] * t + cubic[2]) * t + cubic[1]) * t + cubic[0];
    let (p, q) = (cubic[2] / (3.0 * cubic[3]), cubic[1] / (3.0 * cubic[3]));
    let root = (p * p - q).max(0.0).sqrt();
    let mut ends = vec![0.0, -p - root, -p + root, horizon];
    ends.retain(|t| (0.0..=horizon).contains(t));
    ends.sort_by(f64::total_cmp);
    let mut roots = Vec::new();
    for pair in ends.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        if value(low) * value(high) > 0.0 {
            continue;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if value(low) * value(middle) <= 0.0 { high = middle } else { low = middle }
        }
        roots.push(high);
    }
    roots
}

/// The first of these times at which the triangles practically touch: where a vertex reaches a face, or an
/// edge an edge.
fn first_contact(x: [Triangle; 2], v: [Triangle; 2], horizon: f64) -> f64 {
    let (all_x, all_v) = (x.as_flattened(), v.as_flattened());
    let vertex_face = (0..3).flat_map(|k| [[k, 3, 4, 5], [3 + k, 0, 1, 2]]);
    let edges = [[0, 1], [1, 2], [2, 0]];
    let edge_edge = edges.iter().flat_map(|[i, j]| edges.iter().map(move |[k, l]| [*i, *j, 3 + k, 3 + l]));
    let mut first = f64::INFINITY;
    for four in vertex_face.chain(edge_edge) {
        for t in coplanar_times(four.map(|k| all_x[k]), four.map(|k| all_v[k]), horizon) {
            let [a, b] = at(x, v, t);
            let size = a.iter().chain(&b).map(|p| norm(sub(*p, a[0]))).fold(0.0, f64::max);
            if t < first && triangle_triangle::closest(a, b).distance() <= 1e-11 * size {
                first = t;
            }
        }
    }
    first
}

#[test]
fn two_triangles_touch_when_the_roots_of_the_cubics_say() {
    let (mut numbers, mut n_touch, mut n_miss, mut early) = (Numbers(1), 0, 0, Vec::new());
    for k in 0..30_000 {
        let (x, v) = case(&mut numbers);
        let horizon = [1.0, 5.0, 50.0][k % 3];
        let (found, expected) = (time(x, v, horizon), first_contact(x, v, horizon));
        assert!(found <= expected * (1.0 + 1e-9), "case {k}: {found} but touches at {expected}");
        if expected.is_finite() {
            n_touch += 1;
            early.push(1.0 - found / expected);
            if found < 0.999 * expected {
                let [a, b] = at(x, v, found);
                let distance = triangle_triangle::closest(a, b).distance();
                println!("case {k}: {found} for {expected}, where the distance is {distance:e} {x:?} {v:?}");
            }
        } else if found.is_infinite() {
            n_miss += 1;
        } else {
            let [a, b] = at(x, v, found);
            println!(
                "case {k}: no contact found, at {found} the distance is {:e}",
                triangle_triangle::closest(a, b).distance()
            );
        }
    }
    early.sort_by(f64::total_cmp);
    let part = |p: f64| early[((early.len() - 1) as f64 * p) as usize];
    println!(
        "{n_touch} touch, {n_miss} miss, {} else; early by: half below {:.1e}, 99 of 100 {:.1e}, 999 of 1000 {:.1e}, worst {:.1e}",
        30_000 - n_touch - n_miss,
        part(0.5),
        part(0.99),
        part(0.999),
        part(1.0)
    );
    assert!(n_touch > 5000 && n_miss > 3000);
    assert!(part(1.0) < 0.01);
}

#[test]
fn no_time_is_called_free_at_which_triangles_meet() {
    let mut numbers = Numbers(2);
    for k in 0..2000 {
        let (mut x, v) = case(&mut numbers);
        // Nearer, so that some meet at once.
        x[1].iter_mut().for_each(|p| p[0] -= 1.5 * numbers.unit());
        let found = time(x, v, 3.0);
        let met = (0..=600).map(|s| f64::from(s) * 0.005).find(|&t| {
            let [a, b] = at(x, v, t);
            triangle_triangle::meet(a, b)
        });
        assert!(met.is_none_or(|t| found <= t * (1.0 + 1e-14)), "case {k}: {found} {met:?}");
        assert_eq!(met == Some(0.0), found == 0.0);
    }
}

#[test]
fn the_unit_of_length_the_origin_and_a_common_motion_hardly_matter() {
    let (mut numbers, mut worst) = (Numbers(3), [0.0f64; 5]);
    for _ in 0..3000 {
        let (x, v) = case(&mut numbers);
        let expected = time(x, v, 5.0);
        let every = |t: [Triangle; 2], of: &dyn Fn(Point) -> Point| t.map(|t| t.map(of));
        for (k, unit) in [1e-3, 1e3, 1e-140].into_iter().enumerate() {
            let scaled = |p| scale(p, unit);
            let found = time(every(x, &scaled), every(v, &scaled), 5.0);
            assert_eq!(found.is_finite(), expected.is_finite());
            if found.is_finite() {
                worst[k] = worst[k].max((found / expected - 1.0).abs());
            }
        }
        let far = |p: Point| add(p, [1e8, -1e8, 1e8]);
        let fast = |p: Point| add(p, [1e6, 1e6, -1e6]);
        for (k, (x, v)) in [(every(x, &far), v), (x, every(v, &fast))].into_iter().enumerate() {
            let found = time(x, v, 5.0);
            if found.is_finite() && expected.is_finite() {
                worst[3 + k] = worst[3 + k].max((found / expected - 1.0).abs());
            }
        }
    }
    println!(
        "times differ by: units {:.1e} {:.1e} {:.1e}, origin at 1e8 {:.1e}, motion of 1e6 {:.1e}",
        worst[0], worst[1], worst[2], worst[3], worst[4]
    );
    assert!(worst[..3].iter().all(|w| *w < 1e-6) && worst[3] < 1e-3 && worst[4] < 1e-3);
}

#[test]
fn plain_motions_have_plain_times() {
    let lower: Triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let over = |z: f64| lower.map(|p| [p[0], p[1], z]);
    let all = |v: Point| [v; 3];
    let still = all([0.0; 3]);
    let is = |found: f64, expected: f64| {
        assert!(found <= expected && found >= expected * (1.0 - 1e-5), "{found} for {expected}");
    };
    // Parallel, coming together, with a finite and without a horizon.
    is(time([lower, over(1.0)], [still, all([0.0, 0.0, -0.5])], 3.0), 2.0);
    is(time([lower, over(1.0)], [still, all([0.0, 0.0, -0.5])], f64::INFINITY), 2.0);
    is(time([lower, over(1.0)], [still, all([0.0, 0.0, -1e-9])], f64::INFINITY), 1e9);
    // Two ways in which the contact comes too late.
    for horizon in [1.9, 0.0, -1.0, f64::NAN] {
        assert_eq!(time([lower, over(1.0)], [still, all([0.0, 0.0, -0.5])], horizon), f64::INFINITY);
    }
    for horizon in [5.0, f64::INFINITY] {
        // Moving apart, along each other, together, not at all.
        for v in [[0.0, 0.0, 1.0], [3.0, 2.0, 0.0], [0.0; 3]] {
            assert_eq!(time([lower, over(1.0)], [still, all(v)], horizon), f64::INFINITY, "{v:?}");
            assert_eq!(time([lower, over(1e-9)], [still, all(v)], horizon), f64::INFINITY, "{v:?}");
        }
        assert_eq!(time([lower, over(1.0)], [all([1.0, 2.0, -3.0]); 2], horizon), f64::INFINITY);
        // Already in contact: in a plane, at a vertex, through each other; even when they separate.
        for other in [
            lower,
            over(0.0).map(|p| add(p, [1.0, 0.0, 0.0])),
            [[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [2.0, 2.0, 0.0]],
        ] {
            assert_eq!(time([lower, other], [still, all([1.0, 1.0, 1.0])], horizon), 0.0);
        }
        // In one plane, edge to edge.
        let beside = lower.map(|p| [3.0 - p[0], 1.0 - p[1], 0.0]);
        is(time([lower, beside], [still, all([-1.0, 0.0, 0.0])], horizon), 2.0);
    }
    // Passing each other by a hair, and hitting by one.
    let past = |z: f64| [[-2.0, 0.0, z], [-2.0, 1.0, z], [-3.0, 0.5, z + 1.0]];
    assert_eq!(time([lower, past(1e-5)], [still, all([1.0, 0.0, 0.0])], 9.0), f64::INFINITY);
    is(time([lower, past(-1e-5)], [still, all([1.0, 0.0, 0.0])], 9.0), 2.00001);
    // Points and segments.
    is(time([lower, all([0.2, 0.2, 1.0])], [still, all([0.0, 0.0, -1.0])], f64::INFINITY), 1.0);
    is(time([all([0.0; 3]), all([0.0, 0.0, 1.0])], [still, all([0.0, 0.0, -1.0])], f64::INFINITY), 1.0);
    // Not finite: no contact, no panic.
    assert_eq!(time([lower, all([f64::NAN; 3])], [still, still], 1.0), f64::INFINITY);
    assert_eq!(time([lower, lower], [still, all([f64::INFINITY; 3])], 1.0), f64::INFINITY);
}

/// Two bumpy balls that approach each other, with a separate motion for each vertex.
fn balls(n: usize, seed: u64) -> (Vec<Point>, Vec<Point>, [Vec<[VertexId; 3]>; 2]) {
    let mut numbers = Numbers(seed);
    let surface = Surface::boundary_of(&ball(n, 1));
    let (mut points, mut velocity) = (Vec::new(), Vec::new());
    let surfaces = [-1.3, 1.3].map(|shift: f64| {
        let start = points.len() as u32;
        for p in &surface.points {
            points.push(add(scale(*p, 1.0 + 0.1 * numbers.unit()), [shift, 0.0, 0.0]));
            velocity.push(add(scale(random(&mut numbers), 0.1), [7.0 - shift, 1.0, 0.2]));
        }
        surface.triangles.iter().map(|t| t.map(|v| VertexId(v.0 + start))).collect()
    });
    (points, velocity, surfaces)
}

fn of(points: &[Point], t: [VertexId; 3]) -> Triangle {
    t.map(|v| points[v.index()])
}

fn by_all_pairs(points: &[Point], velocity: &[Point], [a, b]: [&[[VertexId; 3]]; 2], horizon: f64) -> Sweep {
    let mut expected =
        Sweep { first: None, times: [vec![f64::INFINITY; a.len()], vec![f64::INFINITY; b.len()]] };
    for (i, &t) in a.iter().enumerate() {
        for (j, &u) in b.iter().enumerate() {
            let found = time([of(points, t), of(points, u)], [of(velocity, t), of(velocity, u)], horizon);
            expected.times[0][i] = expected.times[0][i].min(found);
            expected.times[1][j] = expected.times[1][j].min(found);
        }
    }
    expected
}

#[test]
fn surfaces_have_the_times_of_all_their_pairs_for_any_number_of_threads() {
    for (n, horizon) in [(2, 0.2), (2, f64::INFINITY), (3, 1.0), (3, 0.1)] {
        for seed in 0..3 {
            let (points, velocity, [a, b]) = balls(n, seed);
            let expected = by_all_pairs(&points, &velocity, [&a, &b], horizon);
            for n_threads in [1, 2, 4] {
                let threads = Threads::new(n_threads).unwrap();
                let found = sweep(&points, &velocity, &a, &b, horizon, always, &threads);
                assert_eq!(found.times, expected.times);
                let least = expected.times[0].iter().copied().fold(f64::INFINITY, f64::min);
                let Some(first) = found.first else {
                    assert_eq!(least, f64::INFINITY);
                    continue;
                };
                let [i, j] = first.triangles.map(|t| t as usize);
                assert_eq!((first.time, expected.times[0][i], expected.times[1][j]), (least, least, least));
                let then: Vec<Point> =
                    points.iter().zip(&velocity).map(|(p, v)| add(*p, scale(*v, first.time))).collect();
                for t in [a[i], b[j]] {
                    assert!(triangle_triangle::closest(of(&then, t), [first.place; 3]).distance() < 1e-5);
                }
                // Without the first pair, another is first.
                let without = |i, j| [i, j] != first.triangles;
                let second = sweep(&points, &velocity, &a, &b, horizon, without, &threads).first;
                assert!(second.is_none_or(|s| s.time >= first.time && s.triangles != first.triangles));
            }
        }
    }
}

#[test]
fn a_surface_meets_itself_as_two_would() {
    let (points, velocity, [a, b]) = balls(3, 9);
    let both = [a.clone(), b.clone()].concat();
    let n = a.len() as u32;
    let threads = Threads::new(2).unwrap();
    let expected = sweep(&points, &velocity, &a, &b, 2.0, always, &Threads::single());
    let found = sweep_own(&points, &velocity, &both, 2.0, |i, j| i < n && j >= n, &threads);
    assert_eq!(found.times[0], expected.times.concat());
    assert_eq!(found.times[0], found.times[1]);
    let (found, expected) = (found.first.unwrap(), expected.first.unwrap());
    assert_eq!(found.triangles, [expected.triangles[0], expected.triangles[1] + n]);
    assert_eq!((found.time, found.place), (expected.time, expected.place));
    // A ball that shrinks to a point: neighbours are left out, the others touch at the end.
    let shrink: Vec<Point> = points.iter().map(|p| sub([-1.3, 0.0, 0.0], *p)).collect();
    let found = sweep_own(&points, &shrink, &a, 2.0, always, &threads);
    assert!(found.times[0].iter().all(|t| (0.999..=1.0).contains(t)), "{:?}", found.first);
}
