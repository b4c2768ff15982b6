//! Local smoothing: the vertices of bad tets, and no others, go where their tets are better.
//!
//! Each goes downhill on the sum over its tets of `h(r)^-4`, where `r` is the mean ratio `12 sqrt(3) 6V / (sum of squared edges)^1.5` as Mmg has it (1 for the regular tet), and
//! `h(r) = (r + sqrt(r^2 + delta^2)) / 2`, which stays positive for inverted tets (Escobar, Rodriguez, Montenegro, Montero, Gonzalez-Yuste 2003). It starts
//! from where the method put the vertices, every time: the result depends on the boundary alone. How far a vertex may go fades out where its worst tet gets good, so that
//! none jumps when it enters or leaves the list.

use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::motion::certificate::BAD_EAS;
use crate::motion::check::Check;

/// `12 sqrt(3)`: makes the mean ratio of the regular tet 1.
const REGULAR: f64 = 20.784_609_690_826_528;
/// Where `h` begins to bend.
const DELTA: f64 = 0.02;
/// From this EAS of their worst tet down vertices move, and freely below [`BAD_EAS`].
const FADES: f64 = 0.25;
/// No tet with a larger mean ratio has an EAS below [`FADES`], as a test sees on random ones: so only below it EAS is asked for.
const SUSPECT: f64 = 0.5;
/// A sweep moves a vertex by no more than this part of the mean edge at it.
const FARTHEST: f64 = 0.3;
/// Shorter steps that are tried where the whole one does not help, each so much shorter.
const BACKTRACKS: usize = 3;
const SHORTER: f64 = 0.4;

/// What smoothing has to know of the mesh.
#[derive(Debug, Default)]
pub(crate) struct Smoother {
    sweeps: usize,
    tets: Vec<[VertexId; 4]>,
    /// The tets of each vertex that may move; none of the others.
    tets_of: Csr<u32>,
}

/// Vertices that are looked at in one go.
const CHUNK: usize = 1 << 13;

impl Smoother {
    /// Only the corners of tets count that follow, and are corners of nothing but tets.
    pub(crate) fn new(check: &Check, follows: &[VertexId], n_points: usize, sweeps: usize) -> Self {
        let corners = &check.corners;
        let mut may_move = vec![false; n_points];
        follows.iter().for_each(|v| may_move[v.index()] = true);
        for (tet, _) in corners.tets.iter().zip(&corners.is_cell).filter(|(_, is_cell)| !**is_cell) {
            tet.iter().for_each(|v| may_move[v.index()] = false);
        }
        let uses = || {
            let uses = (0u32..).zip(&corners.tets).flat_map(|(t, tet)| tet.map(|v| (v.index(), t)));
            uses.filter(|(v, _)| may_move[*v])
        };
        Self { sweeps, tets_of: Csr::from_pairs(n_points, uses), tets: corners.tets.clone() }
    }

    /// Moves vertices of bad tets; how many.
    pub(crate) fn apply(&self, points: &mut [Point], threads: &Threads) -> usize {
        let mut listed = self.listed(points, threads);
        let first: Vec<Point> = listed.iter().map(|(v, _)| points[v.index()]).collect();
        for _ in 0..self.sweeps {
            for &(v, freedom) in &listed {
                self.improve(v, freedom, points);
            }
        }
        let mut first = first.into_iter();
        listed.retain(|(v, _)| first.next() != Some(points[v.index()]));
        listed.len()
    }

    /// The vertices to move, in rising order, and how freely each may: 1 beside a bad tet.
    fn listed(&self, points: &[Point], threads: &Threads) -> Vec<(VertexId, f64)> {
        let of_tets = threads.in_runs(self.tets.len(), CHUNK, |_: &mut (), run| {
            let mut found = Vec::new();
            for tet in &self.tets[run] {
                let corners = tet.map(|v| points[v.index()]);
                if mean_ratio(corners) < SUSPECT {
                    let freedom = ((FADES - eas(corners)) / (FADES - BAD_EAS)).clamp(0.0, 1.0);
                    found.extend(tet.iter().filter(|_| freedom > 0.0).map(|v| (*v, freedom)));
                }
            }
            found
        });
        let mut listed: Vec<(VertexId, f64)> =
            of_tets.into_iter().filter(|(v, _)| !self.tets_of.list(v.index()).is_empty()).collect();
        listed.sort_unstable_by(|x, y| x.0.cmp(&y.0).then(y.1.total_cmp(&x.1)));
        listed.dedup_by_key(|x| x.0);
        listed
    }

    /// One step of Newton for one vertex, as far as that makes the sum smaller.
    fn improve(&self, v: VertexId, freedom: f64, points: &mut [Point]) {
        let star = self.tets_of.list(v.index());
        let from = points[v.index()];
        let (mut sum, mut lowest, mut edges) = (Sum::default(), f64::INFINITY, 0.0);
        for &t in star {
            let opposite = opposite(self.tets[t as usize], v, points);
            lowest = lowest.min(sum.add(from, opposite));
            edges += opposite.iter().map(|p| norm(sub(*p, from))).sum::<f64>();
        }
        let farthest = FARTHEST * edges / (3 * star.len()) as f64;
        let way = sum.downhill();
        let length = norm(way);
        if length == 0.0 || !length.is_finite() {
            return;
        }
        let mut part = freedom * (farthest / length).min(1.0);
        for _ in 0..=BACKTRACKS {
            let to = add(from, scale(way, part));
            let (mut value, mut worst) = (0.0, f64::INFINITY);
            for &t in star {
                let [p, q, r] = opposite(self.tets[t as usize], v, points);
                let ratio = mean_ratio([to, p, q, r]);
                value += barrier(ratio).0;
                worst = worst.min(ratio);
            }
            // What stands upright stays so.
            if value < sum.value && (worst > 0.0 || lowest <= 0.0) {
                points[v.index()] = to;
                return;
            }
            part *= SHORTER;
        }
    }
}

/// The other three corners of a tet, in the order that leaves its volume with its sign when `v` comes first.
fn opposite(tet: [VertexId; 4], v: VertexId, points: &[Point]) -> [Point; 3] {
    let [a, b, c, d] = tet;
    let other = match () {
        () if v == a => [b, c, d],
        () if v == b => [a, d, c],
        () if v == c => [a, b, d],
        () => [a, c, b],
    };
    other.map(|v| points[v.index()])
}

fn mean_ratio([x, p, q, r]: [Point; 4]) -> f64 {
    let (a, b, c) = (sub(p, x), sub(q, x), sub(r, x));
    let far = [sub(q, p), sub(r, q), sub(p, r)];
    let squares = dot(a, a) + dot(b, b) + dot(c, c) + far.iter().map(|e| dot(*e, *e)).sum::<f64>();
    REGULAR * dot(a, cross(b, c)) / (squares * squares.sqrt())
}

/// `h(r)^-4` and its first two derivatives.
fn barrier(r: f64) -> (f64, f64, f64) {
    let root = (r * r + DELTA * DELTA).sqrt();
    // For inverted tets the sum would cancel.
    let h = if r > 0.0 { 0.5 * (r + root) } else { 0.5 * DELTA * DELTA / (root - r) };
    let (slope, bend) = (h / root, 0.5 * DELTA * DELTA / (root * root * root));
    let h4 = h.powi(-4);
    (h4, -4.0 * h4 / h * slope, 20.0 * h4 / (h * h) * slope * slope - 4.0 * h4 / h * bend)
}

/// The sum over the tets of a vertex, with its first and second derivatives by the vertex's place.
#[derive(Default)]
struct Sum {
    value: f64,
    slope: Point,
    bend: [[f64; 3]; 3],
}

impl Sum {
    /// Adds a tet; its mean ratio.
    fn add(&mut self, x: Point, [p, q, r]: [Point; 3]) -> f64 {
        let (a, b, c) = (sub(p, x), sub(q, x), sub(r, x));
        let (e, f, g) = (sub(q, p), sub(r, q), sub(p, r));
        // The volume is linear in x, the sum of squares is a parabola.
        let volume_6 = dot(a, cross(b, c));
        let of_volume = scale(cross(e, f), -1.0);
        let squares = dot(a, a) + dot(b, b) + dot(c, c) + dot(e, e) + dot(f, f) + dot(g, g);
        let of_squares = scale(add(add(a, b), c), -2.0);
        let power = 1.0 / (squares * squares.sqrt());
        let ratio = REGULAR * volume_6 * power;
        let (value, first, second) = barrier(ratio);
        let by_volume = REGULAR * power;
        let by_squares = -1.5 * ratio / squares;
        let slope = add(scale(of_volume, by_volume), scale(of_squares, by_squares));
        self.value += value;
        self.slope = add(self.slope, scale(slope, first));
        let mixed = -1.5 * REGULAR * power / squares;
        let twice = 3.75 * ratio / (squares * squares);
        for i in 0..3 {
            for j in 0..3 {
                let both = mixed * (of_volume[i] * of_squares[j] + of_squares[i] * of_volume[j])
                    + twice * of_squares[i] * of_squares[j]
                    + if i == j { 6.0 * by_squares } else { 0.0 };
                self.bend[i][j] += second * slope[i] * slope[j] + first * both;
            }
        }
        ratio
    }

    /// Newton's step where the sum bends upward in all directions, else each coordinate for itself.
    fn downhill(&self) -> Point {
        let newton = crate::algebra::Block::inverse(self.bend)
            .map(|inverse| scale(crate::algebra::Block::times(inverse, self.slope), -1.0));
        newton.unwrap_or_else(|| {
            std::array::from_fn(|i| {
                let bend = self.bend[i][i].abs();
                if bend > 0.0 { -self.slope[i] / bend } else { 0.0 }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tet::volume;

    const TET: [Point; 4] = [[0.1, 0.2, 0.7], [0.0, 0.0, 0.0], [0.3, 1.1, 0.1], [1.0, 0.1, 0.0]];

    #[test]
    fn the_mean_ratio_is_one_for_the_regular_tet_and_has_the_sign_of_the_volume() {
        let regular = [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]];
        assert!((mean_ratio(regular) - 1.0).abs() < 1e-12);
        for tet in [TET, [TET[1], TET[0], TET[2], TET[3]]] {
            assert_eq!(mean_ratio(tet) > 0.0, volume(tet) > 0.0);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let star =
            [[TET[1], TET[2], TET[3]], [TET[1], TET[3], [0.2, -1.0, 0.3]], [TET[3], TET[2], [0.9, 0.8, 1.2]]];
        let at = |x: Point| {
            let mut sum = Sum::default();
            star.iter().for_each(|other| {
                sum.add(x, *other);
            });
            sum
        };
        // Upright, flat and inverted tets at the vertex.
        for x in [TET[0], [0.3, 0.2, 0.01], [0.2, 0.3, -0.1]] {
            let here = at(x);
            for i in 0..3 {
                let step = 1e-6;
                let moved = |by: f64| {
                    let mut p = x;
                    p[i] += by;
                    at(p)
                };
                let (up, down) = (moved(step), moved(-step));
                let slope = (up.value - down.value) / (2.0 * step);
                let scale = here.slope.iter().fold(1.0, |m: f64, s| m.max(s.abs()));
                assert!((slope - here.slope[i]).abs() < 1e-5 * scale, "{slope} {:?}", here.slope);
                for j in 0..3 {
                    let bend = (up.slope[j] - down.slope[j]) / (2.0 * step);
                    let scale = here.bend.as_flattened().iter().fold(1.0, |m: f64, s| m.max(s.abs()));
                    assert!((bend - here.bend[i][j]).abs() < 1e-5 * scale, "{bend} {:?}", here.bend);
                }
            }
        }
    }

    #[test]
    fn no_tet_that_is_not_suspect_is_bad() {
        let mut state = 1u64;
        let mut chance = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut largest = 0.0f64;
        for _ in 0..200_000 {
            let tet: [Point; 4] = std::array::from_fn(|_| std::array::from_fn(|_| chance()));
            if eas(tet) < FADES {
                largest = largest.max(mean_ratio(tet));
            }
        }
        assert!(largest < SUSPECT && largest > 0.3, "{largest}");
    }
}
