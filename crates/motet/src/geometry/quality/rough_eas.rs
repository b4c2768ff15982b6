//! Approximate EAS of many tets, to find the few that are worth an exact evaluation.
//!
//! Four tets at a time and without arctangents: a fifth of the time of [`eas`](super::eas). What is left out
//! is the second, exact evaluation of the extreme angle.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::{Arch, Simd, WithSimd};

use crate::base::{Point, VertexId, lanewise};
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::quality::eas;
use crate::geometry::tet::EDGES;

/// The largest difference between [`rough_eas`] and [`eas`](super::eas()): 0.004 in an angle of
/// [`FRAC_PI_3`], and some for rounding.
pub const ROUGH_EAS_ERROR: f64 = 0.005;

/// EAS of each tet to within [`ROUGH_EAS_ERROR`], with the sign of the volume.
pub fn rough_eas(points: &[Point], tets: &[[VertexId; 4]]) -> Vec<f32> {
    let mut out = vec![0.0; tets.len()];
    Arch::new().dispatch(All { points, tets, out: &mut out });
    out
}

struct All<'a> {
    points: &'a [Point],
    tets: &'a [[VertexId; 4]],
    out: &'a mut [f32],
}

/// The largest number of tets processed at a time on any machine.
const MAX_LANES: usize = 8;

impl WithSimd for All<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { points, tets, out } = self;
        for (tets, out) in tets.chunks(S::F64_LANES).zip(out.chunks_mut(S::F64_LANES)) {
            let rough = match tets.len() == S::F64_LANES {
                true => some(simd, points, tets),
                false => [f64::NAN; MAX_LANES],
            };
            for l in 0..tets.len() {
                // Over- and underflow end up here, and flat tets.
                let is_sound = rough[l].is_finite() && rough[l] != 0.0;
                out[l] = if is_sound { rough[l] as f32 } else { slowly(points, tets[l]) };
            }
        }
    }
}

#[cold]
fn slowly(points: &[Point], [a, b, c, d]: [VertexId; 4]) -> f32 {
    eas([points[a.index()], points[b.index()], points[c.index()], points[d.index()]]) as f32
}

/// The rough EAS of as many tets as the machine has lanes.
#[inline(always)]
fn some<S: Simd>(simd: S, points: &[Point], tets: &[[VertexId; 4]]) -> [f64; MAX_LANES] {
    let mut gathered = [[[0.0; MAX_LANES]; 3]; 4];
    for (l, tet) in tets.iter().enumerate() {
        for i in 0..4 {
            let point = points[tet[i].index()];
            for axis in 0..3 {
                gathered[i][axis][l] = point[axis];
            }
        }
    }
    let mut corners = [[Lanes::splat(simd, 0.0); 3]; 4];
    for i in 0..4 {
        for axis in 0..3 {
            corners[i][axis] = Lanes::load(simd, &gathered[i][axis]);
        }
    }
    rough(simd, corners).stored()
}

/// A star of tets to be judged repeatedly with its vertex at different places: EAS of each to within
/// [`ROUGH_EAS_ERROR`].
#[derive(Clone, Debug, Default)]
pub struct RoughStar {
    /// For each group of tets, the coordinates of the other three vertices.
    others: Vec<[[[f64; MAX_LANES]; 3]; 3]>,
    n_tets: usize,
}

impl RoughStar {
    /// Sets the tets of the star, each by its corners and the number of the corner that is the vertex.
    pub fn set(&mut self, tets: impl Iterator<Item = ([Point; 4], usize)>) {
        /// Even permutations that begin with each corner.
        const FROM: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [3, 0, 1], [2, 1, 0]];
        self.others.clear();
        self.n_tets = 0;
        for (corners, vertex) in tets {
            let lane = self.n_tets % MAX_LANES;
            if lane == 0 {
                // Lanes that remain zero hold no tet.
                self.others.push([[[0.0; MAX_LANES]; 3]; 3]);
            }
            let group = self.others.len() - 1;
            for (i, &corner) in FROM[vertex].iter().enumerate() {
                for (numbers, x) in self.others[group][i].iter_mut().zip(corners[corner]) {
                    numbers[lane] = x;
                }
            }
            self.n_tets += 1;
        }
    }

    /// Computes the EAS of each tet with the vertex at `place`; `out` is cleared first.
    pub fn judge(&self, place: Point, out: &mut Vec<f64>) {
        out.clear();
        Arch::new().dispatch(At { star: self, place, out });
    }
}

struct At<'a> {
    star: &'a RoughStar,
    place: Point,
    out: &'a mut Vec<f64>,
}

impl WithSimd for At<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { star, place, out } = self;
        let mut corners = [[Lanes::splat(simd, 0.0); 3]; 4];
        for axis in 0..3 {
            corners[0][axis] = Lanes::splat(simd, place[axis]);
        }
        for (g, others) in star.others.iter().enumerate() {
            let n = (star.n_tets - g * MAX_LANES).min(MAX_LANES);
            for start in (0..n).step_by(S::F64_LANES) {
                for i in 0..3 {
                    for axis in 0..3 {
                        corners[i + 1][axis] = Lanes::load(simd, &others[i][axis][start..]);
                    }
                }
                let some = rough(simd, corners).stored();
                for (lane, &rough) in (start..n).zip(&some[..S::F64_LANES]) {
                    let is_sound = rough.is_finite() && rough != 0.0;
                    out.push(if is_sound { rough } else { exactly(others, place, lane) });
                }
            }
        }
    }
}

#[cold]
fn exactly(others: &[[[f64; MAX_LANES]; 3]; 3], place: Point, lane: usize) -> f64 {
    let other = |i: usize| [0, 1, 2].map(|axis| others[i][axis][lane]);
    eas([place, other(0), other(1), other(2)])
}

/// Squared lengths outside these limits are not trusted.
const LOW: f64 = 1e-60;
const HIGH: f64 = 1e60;

#[inline(always)]
fn rough<S: Simd>(simd: S, [a, b, c, d]: [Vector<S>; 4]) -> Lanes<S> {
    let edges = [sub(b, a), sub(c, a), sub(d, a), sub(c, b), sub(d, b), sub(d, c)];
    let mut lengths = [Lanes::splat(simd, 0.0); 6];
    for e in 0..6 {
        lengths[e] = dot(edges[e], edges[e]);
    }
    let normals = [
        cross(edges[3], edges[4]),
        cross(edges[2], edges[1]),
        cross(edges[0], edges[2]),
        cross(edges[1], edges[0]),
    ];
    // The triple product in the form of `volume_6`, so that the sign is the same.
    let volume = dot(cross(edges[0], edges[1]), edges[2]);
    let mut low = Lanes::splat(simd, f64::INFINITY);
    let mut high = Lanes::splat(simd, f64::NEG_INFINITY);
    let mut shortest = low;
    let mut longest = high;
    for e in 0..6 {
        let [i, j] = EDGES[5 - e];
        let square = -signed_square(dot(normals[i], normals[j])) / lengths[e];
        low = low.min(square);
        high = high.max(square);
        shortest = shortest.min(lengths[e]);
        longest = longest.max(lengths[e]);
    }
    let size = volume.abs();
    let dihedral = skew(low.signed_root() / size, high.signed_root() / size, REGULAR);
    let (low, high) = facet_extremes(simd, &edges, &normals);
    let facet = skew(low.signed_root(), high.signed_root(), FRAC_PI_3);
    let one = Lanes::splat(simd, 1.0);
    let quality = one - dihedral.max(facet);
    let zero = Lanes::splat(simd, 0.0);
    let quality = volume.if_below(zero, -quality, quality);
    let nothing = Lanes::splat(simd, f64::NAN);
    let quality = shortest.if_below(Lanes::splat(simd, LOW), nothing, quality);
    let quality = Lanes::splat(simd, HIGH).if_below(longest, nothing, quality);
    size.if_below(Lanes::splat(simd, f64::MIN_POSITIVE), nothing, quality)
}

/// The extremes of `cot |cot|` of the angles of the facets.
#[inline(always)]
fn facet_extremes<S: Simd>(
    simd: S,
    edges: &[Vector<S>; 6],
    normals: &[Vector<S>; 4],
) -> (Lanes<S>, Lanes<S>) {
    let mut low = Lanes::splat(simd, f64::INFINITY);
    let mut high = Lanes::splat(simd, f64::NEG_INFINITY);
    // For each facet, the edges x = pq, y = pr, z = qr: the angles at p, q, r are those of (x, y), (-x, z),
    // (y, z).
    const SIDES: [[usize; 3]; 4] = [[3, 4, 5], [1, 2, 5], [0, 2, 4], [0, 1, 3]];
    for f in 0..4 {
        let [x, y, z] = SIDES[f];
        let sine_squared = dot(normals[f], normals[f]);
        let cosines = [dot(edges[x], edges[y]), -dot(edges[x], edges[z]), dot(edges[y], edges[z])];
        let smallest = cosines[0].min(cosines[1]).min(cosines[2]);
        let largest = cosines[0].max(cosines[1]).max(cosines[2]);
        low = low.min(signed_square(smallest) / sine_squared);
        high = high.max(signed_square(largest) / sine_squared);
    }
    (low, high)
}

/// The worse of the skews of the smallest and the largest cotangent.
#[inline(always)]
fn skew<S: Simd>(low: Lanes<S>, high: Lanes<S>, regular: f64) -> Lanes<S> {
    let (largest, smallest) = (rough_angle(low), rough_angle(high));
    let regular_lanes = Lanes::splat(low.0, regular);
    let above = (largest - regular_lanes) * Lanes::splat(low.0, 1.0 / (PI - regular));
    let below = (regular_lanes - smallest) * Lanes::splat(low.0, 1.0 / regular);
    above.max(below)
}

/// Approximate angles, as in [`equiangle_skew`](super::equiangle_skew()).
#[inline(always)]
fn rough_angle<S: Simd>(cotangent: Lanes<S>) -> Lanes<S> {
    let simd = cotangent.0;
    let one = Lanes::splat(simd, 1.0);
    let size = cotangent.abs();
    let inner = one.if_below(size, one / cotangent, cotangent);
    let arc = inner * (Lanes::splat(simd, FRAC_PI_4) + Lanes::splat(simd, 0.273) * (one - inner.abs()));
    let zero = Lanes::splat(simd, 0.0);
    let of_negative = cotangent.if_below(zero, Lanes::splat(simd, PI), zero);
    one.if_below(size, of_negative + arc, Lanes::splat(simd, FRAC_PI_2) - arc)
}

#[inline(always)]
fn signed_square<S: Simd>(x: Lanes<S>) -> Lanes<S> {
    x * x.abs()
}

/// One number for each of several tets.
#[derive(Clone, Copy)]
struct Lanes<S: Simd>(S, S::f64s);

type Vector<S> = [Lanes<S>; 3];

lanewise! {
    Add add add_f64s;
    Sub sub sub_f64s;
    Mul mul mul_f64s;
    Div div div_f64s;
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0, self.0.neg_f64s(self.1))
    }
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    fn splat(simd: S, x: f64) -> Self {
        Self(simd, simd.splat_f64s(x))
    }

    #[inline(always)]
    fn load(simd: S, numbers: &[f64]) -> Self {
        Self(simd, S::as_simd_f64s(numbers).0[0])
    }

    #[inline(always)]
    fn stored(self) -> [f64; MAX_LANES] {
        let mut numbers = [0.0; MAX_LANES];
        S::as_mut_simd_f64s(&mut numbers).0[0] = self.1;
        numbers
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // `abs_f64s` is not always inlined, which costs more than all the rest.
        let all_but_sign = self.0.splat_f64s(f64::from_bits(u64::MAX >> 1));
        Self(self.0, self.0.and_f64s(self.1, all_but_sign))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0, self.0.min_f64s(self.1, other.1))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0, self.0.max_f64s(self.1, other.1))
    }

    /// Selects `yes` where this is below `limit`, `no` elsewhere.
    #[inline(always)]
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self {
        let mask = self.0.less_than_f64s(self.1, limit.1);
        Self(self.0, self.0.select_f64s(mask, yes.1, no.1))
    }

    /// The square root of the absolute value, with the sign.
    #[inline(always)]
    fn signed_root(self) -> Self {
        let root = Self(self.0, self.0.sqrt_f64s(self.abs().1));
        let zero = Self::splat(self.0, 0.0);
        self.if_below(zero, -root, root)
    }
}

#[inline(always)]
fn sub<S: Simd>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<S: Simd>(a: Vector<S>, b: Vector<S>) -> Lanes<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<S: Simd>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        prop::array::uniform3(prop_oneof![-1.0f64..1.0, Just(0.0), Just(0.5), -1e-9f64..1e-9])
    }

    proptest! {
        /// A star in which the vertex is a different corner of each tet, moved to another place.
        #[test]
        fn a_rough_star_is_near(tets in prop::collection::vec((prop::array::uniform4(point()), 0..4usize), 1..21), place in point()) {
            let mut star = RoughStar::default();
            let mut found = vec![0.0; 3];
            for _ in 0..2 {
                // Buffers are reused.
                star.set(tets.iter().copied());
                star.judge(place, &mut found);
            }
            prop_assert_eq!(found.len(), tets.len());
            for (&(mut tet, corner), rough) in tets.iter().zip(found) {
                tet[corner] = place;
                let exact = eas(tet);
                prop_assert!((rough - exact).abs() <= ROUGH_EAS_ERROR, "{rough} {exact}");
            }
        }

        /// Tets of all kinds: random, flat, inverted, tiny and huge.
        #[test]
        fn rough_is_near(tets in prop::collection::vec(prop::array::uniform4(point()), 1..13), size in prop_oneof![Just(1.0), Just(1e-40), Just(1e80)]) {
            let points: Vec<Point> = tets.as_flattened().iter().map(|p| p.map(|x| x * size)).collect();
            let ids: Vec<[VertexId; 4]> = (0..tets.len()).map(|t| [0, 1, 2, 3].map(|i| VertexId::new(4 * t + i))).collect();
            for (t, rough) in rough_eas(&points, &ids).into_iter().enumerate() {
                let exact = eas([0, 1, 2, 3].map(|i| points[4 * t + i]));
                prop_assert!((f64::from(rough) - exact).abs() <= ROUGH_EAS_ERROR, "{rough} {exact}");
                prop_assert!(rough == 0.0 || exact == 0.0 || (rough > 0.0) == (exact > 0.0));
            }
        }
    }
}
