//! The sum over the tets of a vertex that smoothing minimises, four tets at a time: 2.4 times as fast as one
//! by one.

use crate::algebra::Block;
use crate::base::Point;
use crate::base::four::{FourLanes, FourVectors, cross, dot, sub};
use crate::geometry::vector::scale;

/// `12 sqrt(3)`: makes the mean ratio of the regular tet 1.
const REGULAR: f64 = 20.784_609_690_826_528;
/// The scale of `r` at which `h` bends.
const DELTA: f64 = 0.02;

/// The tets of one vertex.
#[derive(Debug, Default)]
pub(super) struct Star {
    /// The other three corners of each tet, in the order that keeps the sign of its volume when the vertex
    /// comes first; four tets per entry.
    opposite: Vec<[[[f64; 4]; 3]; 3]>,
    /// 1 for a tet, 0 for a filler: the last entry may have fewer than four tets.
    counts: Vec<[f64; 4]>,
    n: usize,
}

/// The sum and the smallest mean ratio.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub(super) sum: f64,
    pub(super) worst: f64,
}

impl Star {
    pub(super) fn clear(&mut self) {
        self.opposite.clear();
        self.counts.clear();
        self.n = 0;
    }

    #[inline(always)]
    pub(super) fn push(&mut self, opposite: [Point; 3]) {
        let lane = self.n % 4;
        if lane == 0 {
            // Lanes without a tet hold a copy of this one, which is not counted.
            let [p, q, r] = opposite;
            let all = |p: Point| [[p[0]; 4], [p[1]; 4], [p[2]; 4]];
            self.opposite.push([all(p), all(q), all(r)]);
            self.counts.push([0.0; 4]);
        }
        if let (Some(four), Some(count)) = (self.opposite.last_mut(), self.counts.last_mut()) {
            for corner in 0..3 {
                for axis in 0..3 {
                    four[corner][axis][lane] = opposite[corner][axis];
                }
            }
            count[lane] = 1.0;
        }
        self.n += 1;
    }

    /// The mean length of the edges at the vertex, each counted once per tet.
    #[inline(always)]
    pub(super) fn mean_edge<F: FourLanes>(&self, machine: F::Machine, from: Point) -> f64 {
        let from = splat_point::<F>(machine, from);
        let mut sum = F::splat(machine, 0.0);
        for (&[p, q, r], count) in self.opposite.iter().zip(&self.counts) {
            let count = F::load(machine, count);
            for p in [p, q, r] {
                let edge = sub(vectors(machine, &p), from);
                sum = sum + count * dot(edge, edge).sqrt();
            }
        }
        sum.sum() / (3 * self.n) as f64
    }

    /// The value with the vertex at `x`.
    #[inline(always)]
    pub(super) fn value<F: FourLanes>(&self, machine: F::Machine, x: Point) -> Value {
        let x = splat_point::<F>(machine, x);
        let splat = |x: f64| F::splat(machine, x);
        let (mut sum, mut worst) = (splat(0.0), splat(f64::INFINITY));
        for ([p, q, r], count) in self.opposite.iter().zip(&self.counts) {
            let (p, q, r) = (vectors(machine, p), vectors(machine, q), vectors(machine, r));
            let count = F::load(machine, count);
            let (a, b, c) = (sub(p, x), sub(q, x), sub(r, x));
            let far = [sub(q, p), sub(r, q), sub(p, r)];
            let squares = dot(a, a)
                + dot(b, b)
                + dot(c, c)
                + (dot(far[0], far[0]) + dot(far[1], far[1]) + dot(far[2], far[2]));
            let ratio = splat(REGULAR) * dot(a, cross(b, c)) / (squares * squares.sqrt());
            worst = worst.min(ratio);
            sum = sum + count * barrier(machine, ratio).value;
        }
        Value { sum: sum.sum(), worst: worst.min_lane() }
    }

    /// The value at `x`, and the step of Newton's method from there.
    #[inline(always)]
    pub(super) fn value_and_newton_step<F: FourLanes>(
        &self,
        machine: F::Machine,
        x: Point,
    ) -> (Value, Point) {
        let x = splat_point::<F>(machine, x);
        let splat = |x: f64| F::splat(machine, x);
        let (mut sum, mut worst) = (splat(0.0), splat(f64::INFINITY));
        let mut gradient = [splat(0.0); 3];
        // xx, xy, xz, yy, yz, zz
        let mut hessian = [splat(0.0); 6];
        for ([p, q, r], count) in self.opposite.iter().zip(&self.counts) {
            let (p, q, r) = (vectors(machine, p), vectors(machine, q), vectors(machine, r));
            let count = F::load(machine, count);
            let (a, b, c) = (sub(p, x), sub(q, x), sub(r, x));
            let (e, f, g) = (sub(q, p), sub(r, q), sub(p, r));
            // The volume is linear in x, the sum of squares is quadratic; the factor -2 of its slope is left
            // out.
            let volume_6 = dot(a, cross(b, c));
            let of_volume = cross(f, e);
            let squares = dot(a, a) + dot(b, b) + dot(c, c) + dot(e, e) + dot(f, f) + dot(g, g);
            let of_squares = [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]];
            let by_volume = splat(REGULAR) / (squares * squares.sqrt());
            let ratio = volume_6 * by_volume;
            let Barrier { value, first, second } = barrier(machine, ratio);
            let (first, second) = (first * count, second * count);
            let by_squares = splat(3.0) * ratio / squares;
            let slope = |i: usize| of_volume[i] * by_volume + of_squares[i] * by_squares;
            let slope = [slope(0), slope(1), slope(2)];
            let mixed = splat(3.0) * by_volume / squares;
            let twice = splat(15.0) * ratio / (squares * squares);
            let mut k = 0;
            for i in 0..3 {
                for j in i..3 {
                    let both = mixed * (of_volume[i] * of_squares[j] + of_squares[i] * of_volume[j])
                        + twice * (of_squares[i] * of_squares[j]);
                    let both = if i == j { both - splat(3.0) * by_squares } else { both };
                    hessian[k] = hessian[k] + second * (slope[i] * slope[j]) + first * both;
                    k += 1;
                }
                gradient[i] = gradient[i] + first * slope[i];
            }
            worst = worst.min(ratio);
            sum = sum + count * value;
        }
        let [xx, xy, xz, yy, yz, zz] = hessian.map(F::sum);
        let step = newton_step(gradient.map(F::sum), [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
        (Value { sum: sum.sum(), worst: worst.min_lane() }, step)
    }
}

/// `h(r)^-4` and its first two derivatives.
struct Barrier<F> {
    value: F,
    first: F,
    second: F,
}

#[inline(always)]
fn barrier<F: FourLanes>(machine: F::Machine, r: F) -> Barrier<F> {
    let splat = |x: f64| F::splat(machine, x);
    let half = splat(0.5);
    let square = splat(DELTA * DELTA);
    let root = (r * r + square).sqrt();
    // For inverted tets `r + root` would cancel.
    let h = r.select_positive(half * (r + root), half * square / (root - r));
    let (slope, bend) = (h / root, half * square / (root * root * root));
    let h2 = h * h;
    let value = splat(1.0) / (h2 * h2);
    let first = splat(-4.0) * value / h;
    Barrier { value, first: first * slope, second: splat(20.0) * value / h2 * (slope * slope) + first * bend }
}

/// Newton's step where the sum is convex, else a step in each coordinate separately.
fn newton_step(gradient: Point, hessian: [[f64; 3]; 3]) -> Point {
    let newton = hessian.inverse().map(|inverse| scale(inverse.times(gradient), -1.0));
    newton.unwrap_or_else(|| {
        std::array::from_fn(|i| {
            let bend = hessian[i][i].abs();
            if bend > 0.0 { -gradient[i] / bend } else { 0.0 }
        })
    })
}

#[inline(always)]
fn splat_point<F: FourLanes>(machine: F::Machine, p: Point) -> FourVectors<F> {
    [F::splat(machine, p[0]), F::splat(machine, p[1]), F::splat(machine, p[2])]
}

#[inline(always)]
fn vectors<F: FourLanes>(machine: F::Machine, numbers: &[[f64; 4]; 3]) -> FourVectors<F> {
    let [x, y, z] = numbers;
    [F::load(machine, x), F::load(machine, y), F::load(machine, z)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::four::Plain;
    use crate::geometry::tet::volume;

    const TET: [Point; 4] = [[0.1, 0.2, 0.7], [0.0, 0.0, 0.0], [0.3, 1.1, 0.1], [1.0, 0.1, 0.0]];

    fn star(tets: &[[Point; 3]]) -> Star {
        let mut star = Star::default();
        tets.iter().for_each(|tet| star.push(*tet));
        star
    }

    #[test]
    fn the_mean_ratio_is_one_for_the_regular_tet_and_has_the_sign_of_the_volume() {
        let regular = [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]];
        let ratio = |[a, b, c, d]: [Point; 4]| star(&[[b, c, d]]).value::<Plain>((), a).worst;
        assert!((ratio(regular) - 1.0).abs() < 1e-12);
        for tet in [TET, [TET[1], TET[0], TET[2], TET[3]]] {
            assert_eq!(ratio(tet) > 0.0, volume(tet) > 0.0);
        }
    }

    #[test]
    fn a_sum_is_that_of_its_tets() {
        let tets: Vec<[Point; 3]> =
            (0..7).map(|k| [TET[1], [0.3, 1.1, 0.1 * f64::from(k)], TET[3]]).collect();
        let one = |tet: &[Point; 3]| star(std::slice::from_ref(tet)).value::<Plain>((), TET[0]);
        let apart: f64 = tets.iter().map(|tet| one(tet).sum).sum();
        let worst = tets.iter().map(|tet| one(tet).worst).fold(f64::INFINITY, f64::min);
        let all = star(&tets);
        for value in [all.value::<Plain>((), TET[0]), all.value_and_newton_step::<Plain>((), TET[0]).0] {
            assert!((value.sum - apart).abs() < 1e-12 * apart && value.worst == worst);
        }
    }

    /// Newton's step leads to where the slope of the parabola is zero; here it is computed from differences
    /// of the sum.
    #[test]
    fn derivatives_are_those_of_differences() {
        let star = star(&[
            [TET[1], TET[2], TET[3]],
            [TET[1], TET[3], [0.2, -1.0, 0.3]],
            [TET[3], TET[2], [0.9, 0.8, 1.2]],
        ]);
        // Upright, flat and inverted tets at the vertex.
        for x in [TET[0], [0.3, 0.2, 0.01], [0.2, 0.3, -0.1]] {
            let step = 1e-4;
            let at = |by: [f64; 3]| star.value::<Plain>((), [x[0] + by[0], x[1] + by[1], x[2] + by[2]]).sum;
            let unit = |i: usize, by: f64| std::array::from_fn(|k| if k == i { by } else { 0.0 });
            let both = |i: usize, j: usize, a: f64, b: f64| {
                let mut by = unit(i, a);
                by[j] += b;
                at(by)
            };
            let slope: Point =
                std::array::from_fn(|i| (at(unit(i, step)) - at(unit(i, -step))) / (2.0 * step));
            let bend: [[f64; 3]; 3] = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let same = both(i, j, step, step) + both(i, j, -step, -step);
                    let other = both(i, j, step, -step) + both(i, j, -step, step);
                    (same - other) / (4.0 * step * step)
                })
            });
            let (expected, found) = (newton_step(slope, bend), star.value_and_newton_step::<Plain>((), x).1);
            let size = expected.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            for i in 0..3 {
                assert!((expected[i] - found[i]).abs() < 1e-3 * size, "{expected:?} {found:?}");
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn wide_and_plain_instructions_give_the_same_bits() {
        use crate::base::four::Wide;
        let Some(machine) = pulp::x86::V3::try_new() else {
            return println!("skipped: no wide instructions here");
        };
        let tets: Vec<[Point; 3]> =
            (0..9).map(|k| [TET[1], [0.3, 1.1, 0.7 - 0.2 * f64::from(k)], TET[3]]).collect();
        let star = star(&tets);
        let ((value, step), (value_wide, step_wide)) = (
            star.value_and_newton_step::<Plain>((), TET[0]),
            star.value_and_newton_step::<Wide>(machine, TET[0]),
        );
        assert!(step == step_wide && value.sum == value_wide.sum && value.worst == value_wide.worst);
        let (value, value_wide) = (star.value::<Plain>((), TET[0]), star.value::<Wide>(machine, TET[0]));
        assert!(value.sum == value_wide.sum && value.worst == value_wide.worst);
        assert_eq!(star.mean_edge::<Plain>((), TET[0]), star.mean_edge::<Wide>(machine, TET[0]));
    }
}
