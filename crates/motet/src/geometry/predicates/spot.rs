//! Signs for points that need not be representable: a vertex may lie anywhere on the segment between two
//! given points, or in the triangle of three.
//!
//! A point that divides a segment generally has no exact coordinates in `f64`: rounded, it leaves its segment
//! and every plane through it. Here it is kept as `from + share (to - from)`, in a triangle with a second
//! share of the way to its third corner (such points are called implicit by Attene 2020, *Indirect predicates
//! for geometric constructions*). As a share is an `f64` as well, the coordinates are integer multiples of a
//! power of two, so the exact stage needs no divisions: it is that of given points with longer numbers.
//!
//! There are three stages again. The first two use the coordinates as computed, in `f64` and in pairs, and
//! add the effect of their errors to the bounds. With all differences at most `L` long and wrong by at most
//! `e` in each component,
//! - a 3 x 3 determinant is wrong by at most `3 sqrt(3) e (L + sqrt(3) e)^2`; with an error of 2 e per
//!   difference (two points) `11 e (L + 4 e)^2` is enough;
//! - the in-sphere determinant, four terms of degree five, by at most `4 * 5 * sqrt(3) * 2 e (L + 4 e)^4`;
//!   `70 e (L + 4 e)^4` is used.

use super::exact::{self, Exact};
use super::insphere::minors;
use super::orient::orient3d;
use super::pair::{Pair, PairVector, U, cross, dot};
use super::{break_tie_of, insphere::insphere};
use crate::base::Point;
use crate::geometry::vector;
use pulp::Scalar;

/// A point on a segment or in a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Between {
    from: Point,
    to: [Point; 2],
    /// The shares of the ways to both points of `to`, which coincide on a segment.
    shares: [f64; 2],
    /// The coordinates, rounded.
    near: Point,
    /// The remainder of the rounding, itself rounded.
    rest: Point,
    /// The largest coordinate of the points that define it, in absolute value.
    size: f64,
}

impl Between {
    /// The point `from + share (to - from)`, where the share is the sum of two numbers: the nearest `f64` and
    /// the remainder. All must be finite, the share in (0, 1).
    pub(crate) fn new(from: Point, to: Point, share: [f64; 2]) -> Self {
        Self::within(from, [to, to], share)
    }

    /// The point `from + s (to - from) + t (third - from)`. All must be finite, both shares in [-1, 1] and
    /// their sum in [0, 1].
    pub(crate) fn within(from: Point, to: [Point; 2], shares: [f64; 2]) -> Self {
        let value = |i: usize| {
            let along = |k: usize| {
                Pair::difference(to[k][i], from[i]).times::<Scalar>(Pair { high: shares[k], low: 0.0 })
            };
            along(0).plus(along(1)).plus(Pair { high: from[i], low: 0.0 }).normalized()
        };
        let value = [value(0), value(1), value(2)];
        let size = [from, to[0], to[1]].as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        Self { from, to, shares, near: value.map(|p| p.high), rest: value.map(|p| p.low), size }
    }

    /// The nearest point with coordinates in `f64`, or a neighbour of it.
    pub(crate) fn rounded(&self) -> Point {
        self.near
    }

    /// The corners and the shares.
    #[cfg(test)]
    pub(crate) fn parts(&self) -> ([Point; 3], [f64; 2]) {
        ([self.from, self.to[0], self.to[1]], self.shares)
    }
}

/// A given point, or one on a segment or in a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spot<'a> {
    Given(Point),
    On(&'a Between),
}

impl Spot<'_> {
    fn near(&self) -> Point {
        match self {
            Self::Given(p) => *p,
            Self::On(between) => between.near,
        }
    }

    fn in_pairs(&self) -> PairVector {
        let (near, rest) = match self {
            Self::Given(p) => (*p, [0.0; 3]),
            Self::On(between) => (between.near, between.rest),
        };
        std::array::from_fn(|i| Pair { high: near[i], low: rest[i] })
    }

    fn exact(&self) -> Exact {
        match self {
            Self::Given(p) => Exact::given(*p),
            Self::On(between) => Exact::between(between.from, between.to, between.shares),
        }
    }

    /// The largest coordinate of the points that define it, in absolute value.
    fn size(&self) -> f64 {
        match self {
            Self::Given(p) => p.iter().fold(0.0, |m: f64, x| m.max(x.abs())),
            Self::On(between) => between.size,
        }
    }

    fn given(&self) -> Option<Point> {
        match self {
            Self::Given(p) => Some(*p),
            Self::On(_) => None,
        }
    }
}

/// The points themselves, if all are given.
fn all_given<const N: usize>(spots: &[Spot; N]) -> Option<[Point; N]> {
    let points = spots.map(|s| s.given().unwrap_or([f64::NAN; 3]));
    spots.iter().all(|s| matches!(s, Spot::Given(_))).then_some(points)
}

/// Range of sizes in which no stage before the exact one can over- or underflow.
const SIZES: std::ops::Range<f64> = 1e-30..1e30;

/// Bounds on the differences between spots and on their coordinates.
struct Reach {
    /// An upper bound on the length of the differences.
    length: f64,
    /// The largest coordinate, including those of the ends of segments: errors remain where coordinates
    /// cancel.
    coordinate: f64,
}

impl Reach {
    fn of(spots: &[Spot], points: &[Point]) -> Self {
        let origin = points[0];
        let longest = |m: f64, p: &Point| m.max(vector::norm(vector::sub(*p, origin)));
        let largest = spots.iter().fold(0.0, |m: f64, spot| m.max(spot.size()));
        Self { length: points.iter().fold(0.0, longest) * (1.0 + 1e-9), coordinate: largest }
    }

    fn is_safe(&self) -> bool {
        SIZES.contains(&self.length) && self.coordinate < SIZES.end
    }

    /// Error of a rounded coordinate: half a unit in the last place, doubled for safety.
    fn rounded(&self) -> f64 {
        2.0 * U * self.coordinate
    }

    /// Error of a coordinate as a pair: 15 u^2 (|from| + s |to - from| + t |third - from|) by the rules in
    /// `pair`, at most 45 u^2 times the largest coordinate; normalised once for the coordinate, and once more
    /// as a difference.
    fn in_pairs(&self) -> f64 {
        128.0 * U * U * self.coordinate
    }
}

/// [`orient3d`] of four spots.
pub(crate) fn orient3d_of(spots: [Spot; 4]) -> i8 {
    if let Some([a, b, c, d]) = all_given(&spots) {
        return orient3d(a, b, c, d);
    }
    let points = spots.map(|s| s.near());
    let reach = Reach::of(&spots, &points);
    if reach.is_safe() {
        let [b, c, d] = [1, 2, 3].map(|i| vector::sub(points[i], points[0]));
        let determinant = vector::dot(vector::cross(b, c), d);
        // 9 u times a permanent of at most 3 sqrt(3) L^3.
        let bound =
            |e: f64, own: f64| 11.0 * e * (reach.length + 4.0 * e).powi(2) + own * reach.length.powi(3);
        if determinant.abs() > bound(reach.rounded(), 48.0 * U) {
            return if determinant > 0.0 { 1 } else { -1 };
        }
        let [b, c, d] = differences(&spots);
        let determinant = dot::<Scalar>(cross::<Scalar>(b, c), d).value();
        if determinant.abs() > bound(reach.in_pairs(), 600.0 * U * U) {
            return if determinant > 0.0 { 1 } else { -1 };
        }
    }
    exact::orient3d_of(spots.map(|s| s.exact()))
}

/// Volumes of several tets, each accurate to the last digits and all divided by one common number, so that
/// their ratios are accurate too.
pub(crate) fn volume_ratios<const N: usize>(tets: [[Spot; 4]; N]) -> [f64; N] {
    exact::orient3d_ratios_of(tets.map(|spots| spots.map(|s| s.exact())))
}

/// [`insphere`] of five spots.
pub(crate) fn insphere_of(spots: [Spot; 5]) -> i8 {
    if let Some([a, b, c, d, e]) = all_given(&spots) {
        return insphere(a, b, c, d, e);
    }
    let points = spots.map(|s| s.near());
    let reach = Reach::of(&spots, &points);
    if reach.is_safe() {
        let [b, c, d, x] = [1, 2, 3, 4].map(|i| vector::sub(points[i], points[0]));
        let [b2, c2, d2, x2] = [b, c, d, x].map(|v| vector::dot(v, v));
        let (normal, volume) = minors::<Scalar>([b, c, d], [b2, c2, d2]);
        let determinant = vector::dot(normal, x) - volume * x2;
        // 20 u P (S m + r^2) with m at most sqrt(3) L.
        let bound =
            |e: f64, own: f64| 70.0 * e * (reach.length + 4.0 * e).powi(4) + own * reach.length.powi(5);
        if determinant.abs() > bound(reach.rounded(), 130.0 * U) {
            return if determinant > 0.0 { 1 } else { -1 };
        }
        let determinant = insphere_in_pairs(differences(&spots)).value();
        if determinant.abs() > bound(reach.in_pairs(), 4200.0 * U * U) {
            return if determinant > 0.0 { 1 } else { -1 };
        }
    }
    exact::insphere_of(spots.map(|s| s.exact()))
}

/// [`super::insphere_perturbed`] of five spots.
pub(crate) fn insphere_perturbed_of(spots: [Spot; 5], ranks: [u32; 5]) -> i8 {
    match insphere_of(spots) {
        0 => break_tie_of(spots, ranks, orient3d_of),
        sign => sign,
    }
}

/// Differences from the first spot, each pair normalised: the rules in `pair` require corrections that are
/// small compared with what they correct.
fn differences<const N: usize, const M: usize>(spots: &[Spot; N]) -> [PairVector; M] {
    let origin = spots[0].in_pairs();
    std::array::from_fn(|k| {
        let p = spots[k + 1].in_pairs();
        std::array::from_fn(|i| {
            let Pair { high, low } = Pair::difference(p[i].high, origin[i].high);
            Pair { high, low: low + (p[i].low - origin[i].low) }.normalized()
        })
    })
}

fn insphere_in_pairs([b, c, d, x]: [PairVector; 4]) -> Pair {
    let squared = |v: PairVector| dot::<Scalar>(v, v);
    let scaled = |v: PairVector, s: Pair| v.map(|p| p.times::<Scalar>(s));
    let minus = |p: PairVector, q: PairVector| [p[0].minus(q[0]), p[1].minus(q[1]), p[2].minus(q[2])];
    let plus = |p: PairVector, q: PairVector| [p[0].plus(q[0]), p[1].plus(q[1]), p[2].plus(q[2])];
    let bc = cross::<Scalar>(b, c);
    let w = minus(scaled(c, squared(b)), scaled(b, squared(c)));
    let normal = plus(cross::<Scalar>(w, d), scaled(bc, squared(d)));
    dot::<Scalar>(normal, x).minus(dot::<Scalar>(bc, d).times::<Scalar>(squared(x)))
}
