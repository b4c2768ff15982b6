//! Triangles that must stay apart: free as long as they are, stopped at the permitted distance, and, if
//! nearer at first, moved only by a part.

use crate::common::Numbers;
use motet::base::{Point, Threads, VertexId};
use motet::contact::{SLACK, sweep_apart};
use motet::geometry::distance::triangle_triangle;
use motet::geometry::vector::{add, scale, sub};

type Triangle = [Point; 3];

const HORIZON: f64 = 4.0;

fn time(x: [Triangle; 2], v: [Triangle; 2], apart: f64) -> f64 {
    let all = [0, 3].map(|first| [[0, 1, 2].map(|k| VertexId::new(first + k))]);
    let (points, velocity) = (x.as_flattened(), v.as_flattened());
    sweep_apart(points, velocity, [&all[0], &all[1]], &[apart], HORIZON, &Threads::single())[0]
}

fn distance(x: [Triangle; 2], v: [Triangle; 2], time: f64) -> f64 {
    let [a, b] = [0, 1].map(|t| [0, 1, 2].map(|k| add(x[t][k], scale(v[t][k], time))));
    triangle_triangle::closest(a, b).distance()
}

fn random(numbers: &mut Numbers) -> Point {
    [(); 3].map(|()| 2.0 * numbers.unit() - 1.0)
}

/// Two triangles beside each other that approach each other and turn.
fn case(numbers: &mut Numbers, gap: f64) -> [[Triangle; 2]; 2] {
    let x = [0.0, 2.0 + gap].map(|at| [(); 3].map(|()| add(random(numbers), [at, 0.0, 0.0])));
    let v = [0.5, -0.5].map(|fast| [(); 3].map(|()| add(scale(random(numbers), 0.3), [fast, 0.0, 0.0])));
    [x, v]
}

#[test]
fn triangles_stop_where_they_are_as_near_as_they_may_come() {
    let (mut numbers, mut n_stopped) = (Numbers(1), 0);
    for k in 0..3000 {
        let [x, v] = case(&mut numbers, 0.5);
        let apart = [1e-9, 1e-7, 1e-3, 0.1, 0.3][k % 5];
        if distance(x, v, 0.0) <= apart {
            continue;
        }
        let found = time(x, v, apart);
        // The effect of rounding: positions are about 10.
        let rounding = 1e-13;
        let until = found.min(HORIZON);
        for s in 0..=40 {
            let d = distance(x, v, until * f64::from(s) / 40.0);
            assert!(d >= apart - rounding, "case {k}: {d} at {s}/40 of {found}, to stay {apart} apart");
        }
        if found.is_finite() {
            n_stopped += 1;
            assert!(found <= HORIZON);
            let d = distance(x, v, found);
            assert!(d <= 1.01 * apart + rounding, "case {k}: {d} at {found}, to stay {apart} apart");
        }
    }
    assert!(n_stopped > 1000, "{n_stopped}");
}

#[test]
fn those_that_are_nearer_at_first_keep_a_part_of_their_distance() {
    let (mut numbers, mut n_stopped, mut n_free) = (Numbers(2), 0, 0);
    for k in 0..3000 {
        let [x, mut v] = case(&mut numbers, 0.0);
        if k % 3 == 0 {
            v.swap(0, 1);
        }
        let first = distance(x, v, 0.0);
        if first == 0.0 {
            continue;
        }
        let found = time(x, v, 3.0 * first);
        let until = found.min(HORIZON);
        for s in 0..=40 {
            let d = distance(x, v, until * f64::from(s) / 40.0);
            assert!(d >= SLACK * first - 1e-13, "case {k}: {d} at {s}/40 of {found}, {first} at first");
        }
        if found.is_finite() {
            n_stopped += 1;
            let d = distance(x, v, found);
            assert!(d <= 1.01 * SLACK * first + 1e-13, "case {k}: {d} at {found}, {first} at first");
        } else {
            n_free += 1;
        }
    }
    assert!(n_stopped > 500 && n_free > 500, "{n_stopped} {n_free}");
}

#[test]
fn plates_that_do_not_turn_have_plain_times() {
    let lower: Triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let still = [[0.0; 3]; 3];
    for (gap, speed, apart) in [(1.0, 0.5, 0.25), (2.0, 1.0, 1e-6), (0.75, 0.25, 0.0)] {
        let upper = lower.map(|p| add(p, [0.0, 0.0, gap]));
        let down = still.map(|p| sub(p, [0.0, 0.0, speed]));
        let (found, expected) = (time([lower, upper], [still, down], apart), (gap - apart) / speed);
        assert!(found <= expected && found > expected * (1.0 - 1e-5), "{found} for {expected}");
        assert_eq!(time([lower, upper], [still, down.map(|v| scale(v, -1.0))], apart), f64::INFINITY);
        assert_eq!(time([lower, upper], [down; 2], apart), f64::INFINITY, "together");
    }
}
