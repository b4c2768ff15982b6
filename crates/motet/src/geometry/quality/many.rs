//! Qualities of many tets, four at a time, one in each lane: they have the bits of those of single tets.
//!
//! Loops instead of closures: a closure that is not inlined has no instructions for four numbers at once.

use std::f64::consts::FRAC_PI_3;

use pulp::NullaryFnOnce;

use crate::base::four::{FourLanes, FourVectors, Plain, cross, dot, sub};
#[cfg(target_arch = "x86_64")]
use crate::base::four::{Wide, wide_machine};
use crate::base::{Point, VertexId};
use crate::geometry::quality::angles::angles;
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::quality::eas;
use crate::geometry::quality::equiangle_skew::{ABOVE, BELOW, signed_root, signed_square};
use crate::geometry::quality::mean_ratio::{from_parts, mean_ratio};
use crate::geometry::tet::EDGES;

/// The number of tets processed at a time.
const LANES: usize = 4;

/// EAS of each tet.
pub fn eas_of_each(points: &[Point], tets: &[[VertexId; 4]]) -> Vec<f64> {
    let mut of_each = Vec::with_capacity(tets.len());
    judge_tets(points, tets, |judged| of_each.push(judged.eas));
    of_each
}

/// EAS and mean ratio of each tet.
pub fn eas_and_mean_ratio_of_each(points: &[Point], tets: &[[VertexId; 4]]) -> Vec<[f64; 2]> {
    let mut of_each = Vec::with_capacity(tets.len());
    judge_tets(points, tets, |judged| of_each.push([judged.eas, judged.mean_ratio()]));
    of_each
}

fn judge_tets(points: &[Point], tets: &[[VertexId; 4]], take: impl FnMut(Judged)) {
    #[cfg(target_arch = "x86_64")]
    if let Some(machine) = wide_machine() {
        return machine.vectorize(Tets::<Wide, _> { machine, points, tets, take });
    }
    Tets::<Plain, _> { machine: (), points, tets, take }.call();
}

/// A star of tets to be judged repeatedly with its vertex at different places.
#[derive(Clone, Debug, Default)]
pub struct EasStar {
    /// For each group of tets, the coordinates of the other three vertices.
    others: Vec<[[[f64; LANES]; 3]; 3]>,
    n_tets: usize,
}

impl EasStar {
    /// Sets the tets of the star, each by its corners and the number of the corner that is the vertex.
    pub fn set(&mut self, tets: impl Iterator<Item = ([Point; 4], usize)>) {
        /// Even permutations that begin with each corner.
        const FROM: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [3, 0, 1], [2, 1, 0]];
        self.others.clear();
        self.n_tets = 0;
        for (corners, vertex) in tets {
            let lane = self.n_tets % LANES;
            if lane == 0 {
                // Lanes that remain zero hold no tet.
                self.others.push([[[0.0; LANES]; 3]; 3]);
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

    /// Computes the EAS of each tet with the vertex at `place`; `out` is cleared first. It can differ from
    /// that of the tet by rounding, since the vertex counts as its first corner.
    pub fn judge(&self, place: Point, out: &mut Vec<f64>) {
        out.clear();
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = wide_machine() {
            return machine.vectorize(At::<Wide> { machine, star: self, place, out });
        }
        At::<Plain> { machine: (), star: self, place, out }.call();
    }
}

/// The measures of a tet.
struct Judged {
    eas: f64,
    volume_6: f64,
    /// The sum of the squared lengths of the edges.
    squares: f64,
    corners: [Point; 4],
    /// Whether the tet is of a size at which nothing over- or underflows.
    is_sound: bool,
}

impl Judged {
    #[inline(always)]
    fn mean_ratio(&self) -> f64 {
        match self.is_sound {
            true => from_parts(self.volume_6, self.squares),
            false => mean_ratio(self.corners),
        }
    }
}

struct Tets<'a, F: FourLanes, T> {
    machine: F::Machine,
    points: &'a [Point],
    tets: &'a [[VertexId; 4]],
    take: T,
}

impl<F: FourLanes, T: FnMut(Judged)> NullaryFnOnce for Tets<'_, F, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { machine, points, tets, mut take } = self;
        for some in tets.chunks(LANES) {
            // Lanes beyond the last tet hold the first of the group.
            let mut corners = [[[0.0; 3]; 4]; LANES];
            for lane in 0..LANES {
                let tet = if lane < some.len() { some[lane] } else { some[0] };
                for i in 0..4 {
                    corners[lane][i] = points[tet[i].index()];
                }
            }
            let mut in_lanes = [[F::splat(machine, 0.0); 3]; 4];
            for i in 0..4 {
                for axis in 0..3 {
                    let mut numbers = [0.0; LANES];
                    for lane in 0..LANES {
                        numbers[lane] = corners[lane][i][axis];
                    }
                    in_lanes[i][axis] = F::load(machine, &numbers);
                }
            }
            let judged = judge::<F>(machine, in_lanes);
            let (all_eas, volumes, squares) =
                (judged.eas.stored(), judged.volume_6.stored(), judged.squares.stored());
            for lane in 0..some.len() {
                let is_sound = !all_eas[lane].is_nan();
                let eas = if is_sound { all_eas[lane] } else { slowly(corners[lane]) };
                let (volume_6, squares) = (volumes[lane], squares[lane]);
                take(Judged { eas, volume_6, squares, corners: corners[lane], is_sound });
            }
        }
    }
}

#[cold]
fn slowly(corners: [Point; 4]) -> f64 {
    eas(corners)
}

#[cold]
fn one_slowly(place: Point, others: &[[[f64; LANES]; 3]; 3], lane: usize) -> f64 {
    let other = |i: usize| [0, 1, 2].map(|axis| others[i][axis][lane]);
    eas([place, other(0), other(1), other(2)])
}

struct At<'a, F: FourLanes> {
    machine: F::Machine,
    star: &'a EasStar,
    place: Point,
    out: &'a mut Vec<f64>,
}

impl<F: FourLanes> NullaryFnOnce for At<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { machine, star, place, out } = self;
        let mut corners = [[F::splat(machine, 0.0); 3]; 4];
        for axis in 0..3 {
            corners[0][axis] = F::splat(machine, place[axis]);
        }
        for (g, others) in star.others.iter().enumerate() {
            for i in 0..3 {
                for axis in 0..3 {
                    corners[i + 1][axis] = F::load(machine, &others[i][axis]);
                }
            }
            let some = judge::<F>(machine, corners).eas.stored();
            for (lane, eas) in some.into_iter().enumerate().take(star.n_tets - g * LANES) {
                out.push(if eas.is_nan() { one_slowly(place, others, lane) } else { eas });
            }
        }
    }
}

/// The measures of four tets; EAS is NaN where something could over- or underflow.
struct FourJudged<F> {
    eas: F,
    volume_6: F,
    squares: F,
}

/// If the squares of all edges are within these limits, nothing over- or underflows, no edge is a point, and
/// single tets are not scaled either.
const LOW: f64 = 1e-58;
const HIGH: f64 = 1e59;

#[inline(always)]
fn judge<F: FourLanes>(machine: F::Machine, [a, b, c, d]: [FourVectors<F>; 4]) -> FourJudged<F> {
    let (zero, one) = (F::splat(machine, 0.0), F::splat(machine, 1.0));
    let edges = [sub(b, a), sub(c, a), sub(d, a), sub(c, b), sub(d, b), sub(d, c)];
    let mut lengths = [zero; 6];
    for e in 0..6 {
        lengths[e] = dot(edges[e], edges[e]);
    }
    let normals = [
        cross(edges[3], edges[4]),
        cross(edges[2], edges[1]),
        cross(edges[0], edges[2]),
        cross(edges[1], edges[0]),
    ];
    // The triple product in the form of `tet::volume_6`.
    let volume_6 = dot(cross(edges[0], edges[1]), edges[2]);
    let (mut low, mut high) = (F::splat(machine, f64::INFINITY), F::splat(machine, f64::NEG_INFINITY));
    let (mut shortest, mut longest, mut squares) = (lengths[0], lengths[0], zero);
    for e in 0..6 {
        let [i, j] = EDGES[5 - e];
        let cosine = zero - dot(normals[i], normals[j]);
        let square = signed_square(cosine) / lengths[e];
        (low, high) = (low.min(square), high.max(square));
        (shortest, longest) = (shortest.min(lengths[e]), longest.max(lengths[e]));
        squares = squares + lengths[e];
    }
    let size = volume_6.abs();
    let dihedral = worse::<F>(
        machine,
        signed_root(machine, low) / size,
        signed_root(machine, high) / size,
        REGULAR,
        [ABOVE[0], BELOW[0]],
    );
    let (low, high) = facet_extremes(machine, &edges, &normals);
    let facet = worse::<F>(
        machine,
        signed_root(machine, low),
        signed_root(machine, high),
        FRAC_PI_3,
        [ABOVE[1], BELOW[1]],
    );
    let skew = dihedral.max(facet).max(zero);
    let positive = (one - skew).abs();
    let eas = volume_6.select_positive(positive, (zero - volume_6).select_positive(zero - positive, zero));
    let is_small = F::splat(machine, LOW) - shortest;
    let is_large = longest - F::splat(machine, HIGH);
    let unsound = F::splat(machine, f64::NAN);
    let eas = is_small.select_positive(unsound, is_large.select_positive(unsound, eas));
    // A volume that is not a number makes no comparison above true.
    FourJudged { eas: eas + volume_6 * zero, volume_6, squares }
}

/// The extremes of `cot |cot|` of the angles of the facets.
#[inline(always)]
fn facet_extremes<F: FourLanes>(
    machine: F::Machine,
    edges: &[FourVectors<F>; 6],
    normals: &[FourVectors<F>; 4],
) -> (F, F) {
    /// For each facet, the edges x = pq, y = pr, z = qr: the angles at p, q, r are those of (x, y), (-x, z),
    /// (y, z).
    const SIDES: [[usize; 3]; 4] = [[3, 4, 5], [1, 2, 5], [0, 2, 4], [0, 1, 3]];
    let zero = F::splat(machine, 0.0);
    let (mut low, mut high) = (F::splat(machine, f64::INFINITY), F::splat(machine, f64::NEG_INFINITY));
    for f in 0..4 {
        let [x, y, z] = SIDES[f];
        let (x, y, z) = (edges[x], edges[y], edges[z]);
        let sine_squared = dot(normals[f], normals[f]);
        let cosines = [dot(x, y), zero - dot(x, z), dot(y, z)];
        let smallest = cosines[0].min(cosines[1]).min(cosines[2]);
        let largest = cosines[0].max(cosines[1]).max(cosines[2]);
        low = low.min(signed_square(smallest) / sine_squared);
        high = high.max(signed_square(largest) / sine_squared);
    }
    (low, high)
}

/// The worse of the skews of the smallest and the largest cotangent.
#[inline(always)]
fn worse<F: FourLanes>(machine: F::Machine, low: F, high: F, regular: f64, [above, below]: [f64; 2]) -> F {
    let regular = F::splat(machine, regular);
    let above = (angles::<F>(machine, low) - regular) * F::splat(machine, above);
    let below = (angles::<F>(machine, high) - regular) * F::splat(machine, below);
    above.max(below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        prop::array::uniform3(prop_oneof![-1.0f64..1.0, Just(0.0), Just(0.5), -1e-9f64..1e-9])
    }

    proptest! {
        /// Tets of all kinds: random, flat, inverted, tiny and huge.
        #[test]
        fn many_are_judged_as_one(
            tets in prop::collection::vec(prop::array::uniform4(point()), 1..13),
            size in prop_oneof![Just(1.0), Just(1e-40), Just(1e-29), Just(1e29), Just(1e80)],
        ) {
            let points: Vec<Point> = tets.as_flattened().iter().map(|p| p.map(|x| x * size)).collect();
            let ids: Vec<[VertexId; 4]> =
                (0..tets.len()).map(|t| [0, 1, 2, 3].map(|i| VertexId::new(4 * t + i))).collect();
            let both = eas_and_mean_ratio_of_each(&points, &ids);
            for (t, found) in eas_of_each(&points, &ids).into_iter().enumerate() {
                let corners = [0, 1, 2, 3].map(|i| points[4 * t + i]);
                prop_assert_eq!(found + 0.0, eas(corners) + 0.0);
                prop_assert_eq!(both[t].map(|x| x + 0.0), [eas(corners) + 0.0, mean_ratio(corners) + 0.0]);
            }
        }

        /// A star in which the vertex is a different corner of each tet, moved to another place.
        #[test]
        fn a_star_is_judged_as_its_tets(
            tets in prop::collection::vec((prop::array::uniform4(point()), 0..4usize), 1..21),
            place in point(),
        ) {
            let mut star = EasStar::default();
            let mut found = vec![0.0; 3];
            for _ in 0..2 {
                // Buffers are reused.
                star.set(tets.iter().copied());
                star.judge(place, &mut found);
            }
            prop_assert_eq!(found.len(), tets.len());
            for (&(mut tet, corner), found) in tets.iter().zip(found) {
                tet[corner] = place;
                let others = [[1, 2, 3], [0, 3, 2], [3, 0, 1], [2, 1, 0]][corner].map(|i| tet[i]);
                prop_assert_eq!(found + 0.0, eas([place, others[0], others[1], others[2]]) + 0.0);
            }
        }
    }

    #[test]
    fn what_is_no_number_is_judged_as_one() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, wrong, 1.0]];
            let found = eas_of_each(&points, &[[0, 1, 2, 3].map(VertexId)]);
            assert_eq!(found[0].to_bits(), eas(points).to_bits());
        }
    }
}
