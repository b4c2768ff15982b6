//! Makes triangles on an implicit surface even: vertices move to the mean of their neighbours and back onto
//! the surface, and edges are flipped.

use std::collections::BTreeMap;

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};

/// Number of times that vertices are moved and edges flipped; the shapes have settled by then.
const ROUNDS: usize = 30;

/// Number of Newton steps onto the surface; functions that are nearly distances need few.
const STEPS: usize = 6;

/// The surface where a function of the position is 0, and a length of the size of its features.
pub(super) struct Implicit<F> {
    pub(super) function: F,
    pub(super) size: f64,
}

impl<F: Fn(Point) -> f64> Implicit<F> {
    /// The point on the surface to which the gradient leads from `p`.
    pub(super) fn project(&self, mut p: Point) -> Point {
        for _ in 0..STEPS {
            let gradient = self.gradient(p);
            let squared = dot(gradient, gradient);
            if squared > 0.0 {
                p = sub(p, scale(gradient, (self.function)(p) / squared));
            }
        }
        p
    }

    /// The point where the ray from the origin along a unit vector leaves the inside; the search ends at the
    /// distance `reach`.
    pub(super) fn exit_point(&self, direction: Point, reach: f64) -> Point {
        let is_outside = |s: f64| (self.function)(scale(direction, s)) > 0.0;
        let step = 0.05 * self.size;
        let n_steps = (reach / step) as usize;
        let first = (1..n_steps).find(|&i| is_outside(step * i as f64)).unwrap_or(n_steps);
        let [mut low, mut high] = [first - usize::from(first > 0), first].map(|i| step * i as f64);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if is_outside(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        scale(direction, high)
    }

    fn gradient(&self, p: Point) -> Point {
        let step = 1e-5 * self.size;
        [0, 1, 2].map(|axis| {
            let at = |s: f64| {
                let mut q = p;
                q[axis] += s;
                (self.function)(q)
            };
            (at(step) - at(-step)) / (2.0 * step)
        })
    }
}

/// A smooth minimum of two distances: rounded where they differ by less than `blend`, and exactly the smaller
/// one elsewhere.
pub(super) fn smooth_minimum(a: f64, b: f64, blend: f64) -> f64 {
    let share = (1.0 - (a - b).abs() / blend).max(0.0);
    a.min(b) - 0.25 * share * share * blend
}

/// Moves vertices that are not fixed, and flips edges, to make triangles even.
pub(super) fn even_out<F: Fn(Point) -> f64>(
    surface: &Implicit<F>,
    points: &mut [Point],
    triangles: &mut [[VertexId; 3]],
    is_fixed: &[bool],
) {
    for _ in 0..ROUNDS {
        flip(points, triangles);
        let middles = middles(points, triangles);
        for (v, middle) in middles.into_iter().enumerate().filter(|(v, _)| !is_fixed[*v]) {
            if let Some(middle) = middle {
                points[v] = surface.project(scale(add(points[v], middle), 0.5));
            }
        }
    }
    flip(points, triangles);
}

/// The mean of each vertex's neighbours, where it has any.
fn middles(points: &[Point], triangles: &[[VertexId; 3]]) -> Vec<Option<Point>> {
    let mut sums = vec![([0.0; 3], 0.0); points.len()];
    for &[a, b, c] in triangles {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            let (sum, n) = &mut sums[u.index()];
            *sum = add(*sum, points[v.index()]);
            *n += 1.0;
        }
    }
    sums.into_iter().map(|(sum, n)| (n > 0.0).then(|| scale(sum, 1.0 / n))).collect()
}

/// Flips edges where that makes the smallest angle of their two triangles larger; each triangle changes at
/// most once.
fn flip(points: &[Point], triangles: &mut [[VertexId; 3]]) {
    let mut sides: BTreeMap<[VertexId; 2], usize> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        sides.extend([([a, b], t), ([b, c], t), ([c, a], t)]);
    }
    let mut is_flipped = vec![false; triangles.len()];
    for ([a, b], s) in sides.clone() {
        let Some(&t) = sides.get(&[b, a]) else { continue };
        if a > b || is_flipped[s] || is_flipped[t] {
            continue;
        }
        let [c, d] = [s, t].map(|t| opposite(triangles[t], a, b));
        let after = [[a, d, c], [d, b, c]];
        let is_new = !sides.contains_key(&[c, d]) && !sides.contains_key(&[d, c]);
        if is_new && is_better(points, [triangles[s], triangles[t]], after) {
            [triangles[s], triangles[t]] = after;
            [is_flipped[s], is_flipped[t]] = [true; 2];
            // Prevents the same edge from being made twice; the other sides of these triangles are not looked
            // up again.
            sides.extend([([c, d], s), ([d, c], t)]);
        }
    }
}

fn opposite(triangle: [VertexId; 3], a: VertexId, b: VertexId) -> VertexId {
    triangle.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
}

/// Whether the smallest angle of two triangles is larger than that of two others, and they face the same way.
fn is_better(points: &[Point], before: [[VertexId; 3]; 2], after: [[VertexId; 3]; 2]) -> bool {
    let corners = |t: [VertexId; 3]| t.map(|v| points[v.index()]);
    let normal = |t: [VertexId; 3]| {
        let [a, b, c] = corners(t);
        cross(sub(b, a), sub(c, a))
    };
    let facing = add(normal(before[0]), normal(before[1]));
    let least =
        |pair: [[VertexId; 3]; 2]| pair.map(|t| smallest_angle(corners(t))).into_iter().fold(4.0, f64::min);
    after.iter().all(|&t| dot(normal(t), facing) > 0.0) && least(after) > least(before) + 1e-9
}

/// The smallest angle of a triangle, in radians.
fn smallest_angle([a, b, c]: [Point; 3]) -> f64 {
    let at = |p: Point, q: Point, r: Point| {
        let (u, v) = (sub(q, p), sub(r, p));
        norm(cross(u, v)).atan2(dot(u, v))
    };
    at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
}
