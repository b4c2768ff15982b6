//! Prescribed motions, such as rotations, translations and affine maps, each at any fraction of it.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::mesh::bounds;

/// A motion of space that can be evaluated at any fraction.
#[derive(Clone, Debug, PartialEq)]
pub enum Prescribed {
    /// A translation of every point by the same vector.
    Shift(Point),
    /// A rotation about an axis through a centre.
    Turn {
        /// Direction of the axis, of any length but zero.
        axis: Point,
        /// Angle in radians, right-handed about the axis.
        angle: f64,
        /// A point on the axis.
        centre: Point,
    },
    /// `x' = A x + b`; each row holds a row of A and the entry of b.
    Affine([[f64; 4]; 3]),
    /// Bends what stands on a plane into an arc: a beam, a flap, a leaflet. What lies behind the plane stays.
    Bend {
        /// A point of the plane in which it is held.
        hinge: Point,
        /// The direction in which it stands at first; of any length but zero.
        along: Point,
        /// The direction in which it bends; only the part at right angles to `along` counts, and must not be
        /// zero.
        towards: Point,
        /// The length of the sheet, in the unit of the points.
        length: f64,
        /// The angle by which its end turns, in radians.
        angle: f64,
    },
    /// Several motions, each applied to the result of the one before.
    Sequence(Vec<Prescribed>),
}

impl Prescribed {
    /// The motions one after the other. A single motion is returned as it is: a translation alone is exact,
    /// but would round in a sequence.
    pub fn sequence(mut motions: Vec<Self>) -> Self {
        if motions.len() == 1 { motions.remove(0) } else { Self::Sequence(motions) }
    }

    /// The middle of the bounding box of some vertices: the default centre of rotation.
    pub fn middle(points: &[Point], vertices: &[VertexId]) -> Point {
        let around: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
        let [low, high] = bounds(&around).unwrap_or_default();
        [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]))
    }

    /// Checks that all numbers are finite and that directions have a length.
    ///
    /// # Errors
    /// When they are not; of kind [`Options`](crate::base::ErrorKind::Options), reporting what is wrong.
    pub fn check(&self) -> Result<()> {
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        let fine = match self {
            Self::Shift(by) => finite(by),
            Self::Turn { axis, angle, centre } => {
                if norm(*axis) == 0.0 {
                    return Err(Error::options("the axis of a rotation must not be zero"));
                }
                finite(axis) && angle.is_finite() && finite(centre)
            }
            Self::Affine(rows) => finite(rows.as_flattened()),
            Self::Bend { hinge, along, towards, length, angle } => {
                if norm(cross(*along, *towards)) == 0.0 || *length <= 0.0 {
                    return Err(Error::options(
                        "a bend needs a length above 0 and two directions that are not parallel",
                    ));
                }
                finite(hinge) && finite(along) && finite(towards) && length.is_finite() && angle.is_finite()
            }
            Self::Sequence(motions) => return motions.iter().try_for_each(Self::check),
        };
        if fine { Ok(()) } else { Err(Error::options("a number of a prescribed motion is not finite")) }
    }

    /// Where `fraction` of the motion takes a point: 0 leaves it in place, 1 is the whole motion. A rotation
    /// takes the fraction of its angle, so that every fraction of it is rigid.
    pub fn apply(&self, p: Point, fraction: f64) -> Point {
        match self {
            Self::Shift(by) => add(p, scale(*by, fraction)),
            Self::Turn { axis, angle, centre } => {
                add(*centre, rotate(sub(p, *centre), *axis, angle * fraction))
            }
            Self::Affine(rows) => {
                let image = rows.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d);
                add(p, scale(sub(image, p), fraction))
            }
            Self::Bend { hinge, along, towards, length, angle } => {
                let along = scale(*along, 1.0 / norm(*along));
                let off = sub(*towards, scale(along, dot(*towards, along)));
                add(
                    *hinge,
                    bend(sub(p, *hinge), along, scale(off, 1.0 / norm(off)), angle * fraction / length),
                )
            }
            Self::Sequence(motions) => motions.iter().fold(p, |p, motion| motion.apply(p, fraction)),
        }
    }

    /// The displacement of a point at `fraction` of the motion.
    pub fn displacement(&self, p: Point, fraction: f64) -> Point {
        match self {
            // Not as a difference of positions: that would round.
            Self::Shift(by) => scale(*by, fraction),
            _ => sub(self.apply(p, fraction), p),
        }
    }
}

/// Where a point of a beam along the unit vector `along` from the origin goes when the beam gets this
/// curvature towards the unit vector `off`.
fn bend(v: Point, along: Point, off: Point, curvature: f64) -> Point {
    let (height, aside) = (dot(v, along), dot(v, off));
    if height <= 0.0 || curvature == 0.0 {
        return v;
    }
    let angle = curvature * height;
    let (sin, cos) = angle.sin_cos();
    // (1 - cos) / angle from the half angle, which loses no digits.
    let half = (0.5 * angle).sin();
    let (up, over) = (sin / curvature - aside * sin, 2.0 * half * half / curvature + aside * cos);
    add(v, add(scale(along, up - height), scale(off, over - aside)))
}

/// Rotates `v` by `angle` about an axis through the origin (Rodrigues 1840).
fn rotate(v: Point, axis: Point, angle: f64) -> Point {
    let k = scale(axis, 1.0 / norm(axis));
    let (sin, cos) = angle.sin_cos();
    let along = scale(k, dot(k, v) * (1.0 - cos));
    add(add(scale(v, cos), scale(cross(k, v), sin)), along)
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Point = [0.3, -1.2, 2.5];

    fn near(a: Point, b: Point) -> bool {
        norm(sub(a, b)) < 1e-14 * (1.0 + norm(a))
    }

    fn turn(angle: f64) -> Prescribed {
        Prescribed::Turn { axis: [1.0, 2.0, -0.5], angle, centre: [4.0, 5.0, 6.0] }
    }

    #[test]
    fn no_part_of_a_motion_leaves_points_in_place() {
        let motions = [Prescribed::Shift([1.0, 2.0, 3.0]), turn(1.0), Prescribed::Affine([[2.0; 4]; 3])];
        assert!(motions.iter().all(|m| near(m.apply(P, 0.0), P)));
        assert!(near(Prescribed::Sequence(motions.to_vec()).apply(P, 0.0), P));
    }

    #[test]
    fn half_a_turn_twice_is_the_turn() {
        let half_way = turn(2.0).apply(P, 0.5);
        assert!(near(turn(2.0).apply(half_way, 0.5), turn(2.0).apply(P, 1.0)));
        assert!(near(turn(std::f64::consts::TAU).apply(P, 1.0), P));
    }

    #[test]
    fn a_turn_is_right_handed_and_keeps_lengths() {
        let quarter =
            Prescribed::Turn { axis: [0.0, 0.0, 3.0], angle: std::f64::consts::FRAC_PI_2, centre: [0.0; 3] };
        assert!(near(quarter.apply([1.0, 0.0, 0.0], 1.0), [0.0, 1.0, 0.0]));
        let before = norm(sub(P, [4.0, 5.0, 6.0]));
        let after = norm(sub(turn(1.3).apply(P, 0.7), [4.0, 5.0, 6.0]));
        assert!((before - after).abs() < 1e-13);
    }

    #[test]
    fn a_sequence_turns_first_where_the_turn_is_first() {
        let shift = Prescribed::Shift([1.0, 0.0, 0.0]);
        let sequence = Prescribed::Sequence(vec![turn(0.4), shift.clone()]);
        assert!(near(sequence.apply(P, 1.0), shift.apply(turn(0.4).apply(P, 1.0), 1.0)));
    }

    #[test]
    fn a_beam_becomes_an_arc_of_its_length() {
        let (hinge, angle) = ([1.0, 2.0, 3.0], 1.25);
        let bend =
            Prescribed::Bend { hinge, along: [0.0, 0.0, 2.0], towards: [3.0, 0.0, 1.0], length: 4.0, angle };
        let at = |height: f64| bend.apply(add(hinge, [0.0, 0.0, height]), 1.0);
        let radius = 4.0 / angle;
        let centre = add(hinge, [radius, 0.0, 0.0]);
        for height in [0.5, 2.0, 4.0] {
            assert!((norm(sub(at(height), centre)) - radius).abs() < 1e-14);
        }
        let end = sub(at(4.0), hinge);
        assert!(near(end, [radius * (1.0 - angle.cos()), 0.0, radius * angle.sin()]));
        // Cross-sections stay straight, and everything behind the hinge stays.
        let [a, b] = [0.1, 0.3].map(|x| bend.apply(add(hinge, [x, 0.0, 3.0]), 1.0));
        assert!((norm(sub(a, b)) - 0.2).abs() < 1e-14);
        assert_eq!(bend.apply(sub(hinge, [0.0, 0.0, 1.0]), 1.0), sub(hinge, [0.0, 0.0, 1.0]));
        assert!(near(bend.apply(P, 0.0), P) && near(bend.apply(P, 1e-12), P));
        let flat =
            Prescribed::Bend { hinge, along: [0.0, 0.0, 1.0], towards: [0.0, 0.0, 2.0], length: 1.0, angle };
        assert!(flat.check().is_err() && bend.check().is_ok());
    }

    #[test]
    fn what_means_nothing_is_refused() {
        let still = Prescribed::Turn { axis: [0.0; 3], angle: 1.0, centre: [0.0; 3] };
        assert!(still.check().is_err());
        assert!(Prescribed::Shift([f64::NAN, 0.0, 0.0]).check().is_err());
        assert!(Prescribed::Sequence(vec![turn(f64::INFINITY)]).check().is_err());
        assert!(turn(1.0).check().is_ok());
    }
}
