//! The rigid motion that best fits the motion of some vertices.

use crate::base::Point;
use crate::base::four::{FourLanes, FourVectors, cross, sub as sub4};
use crate::geometry;
use crate::geometry::vector::sub;

/// A rotation about a centre and a translation.
#[derive(Clone, Debug)]
pub(super) struct Rigid {
    centre: Point,
    shift: Point,
    /// Unit vector.
    axis: Point,
    /// Half the angle of rotation, which is from 0 to pi.
    half_angle: f64,
    /// Sine and cosine of `k / TABLE_SIZE` of the half angle, for each `k` up to [`TABLE_SIZE`]; empty where
    /// nothing rotates.
    angle_table: Vec<[f64; 2]>,
}

/// Size of the table of angles. With it, a step of 32,000 vertices takes 0.5 of the time that it takes with a
/// sine and a cosine for each vertex.
const TABLE_SIZE: usize = 512;

impl Rigid {
    /// The motion that [fits best](geometry::rigid::Rigid::fit); the identity, to the bit, where all points
    /// stay.
    pub(super) fn fit(pairs: &[(Point, Point)]) -> Self {
        let geometry::rigid::Rigid { centres, axis, half_angle } = geometry::rigid::Rigid::fit(pairs);
        let part = |k: usize| {
            let (sine, cosine) = (half_angle * k as f64 / TABLE_SIZE as f64).sin_cos();
            [sine, cosine]
        };
        let angle_table = if half_angle > 0.0 { (0..=TABLE_SIZE).map(part).collect() } else { Vec::new() };
        Self { centre: centres[0], shift: sub(centres[1], centres[0]), axis, half_angle, angle_table }
    }

    /// The displacements of four points with these shares of translation and rotation.
    #[inline(always)]
    pub(super) fn displacement<F: FourLanes>(
        &self,
        machine: F::Machine,
        p: FourVectors<F>,
        [shift, turn]: [[f64; 4]; 2],
    ) -> FourVectors<F> {
        let splat = |x: f64| F::splat(machine, x);
        let by = F::load(machine, &shift);
        let shifted = [splat(self.shift[0]) * by, splat(self.shift[1]) * by, splat(self.shift[2]) * by];
        if self.angle_table.is_empty() {
            return shifted;
        }
        let (mut sines, mut cosines, mut rests) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        for i in 0..4 {
            let at = turn[i] * TABLE_SIZE as f64;
            let k = (at as usize).min(TABLE_SIZE);
            [sines[i], cosines[i]] = self.angle_table[k];
            rests[i] = at - k as f64;
        }
        let (sine, cosine) = (F::load(machine, &sines), F::load(machine, &cosines));
        // The rest of the angle is below pi / 1024: the truncation error of the series is below 1e-17.
        let rest = F::load(machine, &rests) * splat(self.half_angle / TABLE_SIZE as f64);
        let square = rest * rest;
        let small_sine =
            rest * (splat(1.0) - square * splat(1.0 / 6.0) * (splat(1.0) - square * splat(0.05)));
        let small_cosine = splat(1.0) - splat(0.5) * square * (splat(1.0) - square * splat(1.0 / 12.0));
        let (sine, cosine) =
            (sine * small_cosine + cosine * small_sine, cosine * small_cosine - sine * small_sine);
        let splat_point = |p: Point| [splat(p[0]), splat(p[1]), splat(p[2])];
        let axis = splat_point(self.axis);
        let across = cross(axis, sub4(p, splat_point(self.centre)));
        let back = cross(axis, across);
        // sin a = 2 sin a/2 cos a/2, 1 - cos a = 2 sin^2 a/2
        let twice = sine + sine;
        let (sine_of_all, one_less_cosine) = (twice * cosine, twice * sine);
        let of_axis = |i: usize| across[i] * sine_of_all + back[i] * one_less_cosine + shifted[i];
        [of_axis(0), of_axis(1), of_axis(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::four::Plain;
    use crate::geometry::vector::{add, distance};
    use crate::motion::Prescribed;

    fn points() -> Vec<Point> {
        (0..20).map(|i| f64::from(i) * 0.7).map(|t| [t.sin() + 3.0, (2.0 * t).cos(), 0.2 * t]).collect()
    }

    fn displacement(rigid: &Rigid, p: Point, [shift, turn]: [f64; 2]) -> Point {
        let four = p.map(|x| Plain::splat((), x));
        rigid.displacement((), four, [[shift; 4], [turn; 4]]).map(|x| x.stored()[2])
    }

    fn fitted(turn: &Prescribed, shift: Point) -> Rigid {
        Rigid::fit(&points().into_iter().map(|p| (p, add(turn.apply(p, 1.0), shift))).collect::<Vec<_>>())
    }

    #[test]
    fn a_rigid_motion_is_found_and_parts_of_it_are_parts_of_the_turn() {
        let (axis, centre, shift) = ([0.3, -0.4, 1.2], [3.0, 1.0, -2.0], [0.5, 0.0, -7.0]);
        for degrees in [1e-3, 15.0, 90.0, 179.0] {
            let turn = |part: f64| Prescribed::Turn { axis, angle: part * f64::to_radians(degrees), centre };
            let rigid = fitted(&turn(1.0), shift);
            for part in [0.0, 0.001, 0.37, 0.5, 0.9999, 1.0] {
                for p in points() {
                    // About the mean of the points, whatever the centre was.
                    let middle = rigid.centre;
                    let own =
                        Prescribed::Turn { axis, angle: part * f64::to_radians(degrees), centre: middle };
                    let expected = sub(own.apply(p, 1.0), p);
                    assert!(
                        distance(displacement(&rigid, p, [0.0, part]), expected) < 1e-13,
                        "{degrees} {part}"
                    );
                }
            }
            for p in points() {
                let expected = sub(add(turn(1.0).apply(p, 1.0), shift), p);
                assert!(distance(displacement(&rigid, p, [1.0, 1.0]), expected) < 1e-13, "{degrees}");
            }
        }
    }

    #[test]
    fn what_stays_stays_to_the_bit() {
        let rigid = Rigid::fit(&points().into_iter().map(|p| (p, p)).collect::<Vec<_>>());
        assert!(points().into_iter().all(|p| displacement(&rigid, p, [0.4, 0.7]) == [0.0; 3]));
        assert!(rigid.angle_table.is_empty());
    }
}
