//! Local smoothing: the vertices of bad tets, and no others, move to where their tets are better.
//!
//! Each moves downhill on the sum over its tets of `h(r)^-4`, where `r` is the mean ratio
//! `12 sqrt(3) 6V / (sum of squared edges)^1.5` as Mmg defines it (1 for the regular tet), and
//! `h(r) = (r + sqrt(r^2 + delta^2)) / 2`, which stays positive for inverted tets (Escobar, Rodriguez,
//! Montenegro, Montero, Gonzalez-Yuste 2003). Smoothing always starts from where the method put the vertices:
//! the result depends on the boundary alone. How far a vertex may move fades out as its worst tet becomes
//! good, so that none jumps when it enters or leaves the list.

mod star;

use pulp::NullaryFnOnce;

#[cfg(target_arch = "x86_64")]
use crate::base::four::Wide;
use crate::base::four::{FourLanes, Plain};
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::quality::{ROUGH_EAS_ERROR, eas, rough_eas};
use crate::geometry::vector::{add, norm, scale};
use crate::motion::certificate::BAD_EAS;
use crate::motion::check::Check;
use crate::motion::smooth::star::Star;

/// Vertices move where the EAS of their worst tet is below this, and freely where it is below [`BAD_EAS`].
const FADE_EAS: f64 = 0.225;
/// A sweep moves a vertex by no more than this fraction of the mean edge at it.
const MAX_STEP: f64 = 0.3;
/// Number of shorter steps that are tried where the whole one does not help, each [`BACKTRACK_FACTOR`] times
/// the one before.
const BACKTRACKS: usize = 3;
const BACKTRACK_FACTOR: f64 = 0.4;

/// What smoothing needs of the mesh.
#[derive(Debug, Default)]
pub(crate) struct Smoother {
    sweeps: usize,
    tets: Vec<[VertexId; 4]>,
    /// The tets of each vertex that may move; empty for all others.
    tets_of: Csr<u32>,
}

/// Tets per run.
const CHUNK: usize = 1 << 13;

impl Smoother {
    /// Only those vertices of `follows` may move that are corners of nothing but tets.
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

    /// Moves vertices of bad tets; returns how many.
    pub(crate) fn apply(&self, points: &mut [Point], threads: &Threads) -> usize {
        let mut listed = self.vertices_to_move(points, threads);
        let first: Vec<Point> = listed.iter().map(|(v, _)| points[v.index()]).collect();
        self.sweep(&listed, points);
        let mut first = first.into_iter();
        listed.retain(|(v, _)| first.next() != Some(points[v.index()]));
        listed.len()
    }

    fn sweep(&self, listed: &[(VertexId, f64)], points: &mut [Point]) {
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = pulp::x86::V3::try_new() {
            return machine.vectorize(Sweeps::<Wide> { machine, smoother: self, listed, points });
        }
        Sweeps::<Plain> { machine: (), smoother: self, listed, points }.call();
    }

    /// The vertices to move, in rising order, and how freely each may: 1 beside a bad tet.
    fn vertices_to_move(&self, points: &[Point], threads: &Threads) -> Vec<(VertexId, f64)> {
        let of_tets = threads.in_runs(self.tets.len(), CHUNK, |_: &mut (), run| {
            let mut found = Vec::new();
            for (tet, rough) in self.tets[run.clone()].iter().zip(rough_eas(points, &self.tets[run])) {
                if f64::from(rough) < FADE_EAS + ROUGH_EAS_ERROR {
                    let corners = tet.map(|v| points[v.index()]);
                    let freedom = ((FADE_EAS - eas(corners)) / (FADE_EAS - BAD_EAS)).clamp(0.0, 1.0);
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
}

/// Sweeps over the vertices of a list.
struct Sweeps<'a, F: FourLanes> {
    machine: F::Machine,
    smoother: &'a Smoother,
    listed: &'a [(VertexId, f64)],
    points: &'a mut [Point],
}

impl<F: FourLanes> NullaryFnOnce for Sweeps<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mut star = Star::default();
        for _ in 0..self.smoother.sweeps {
            for &(v, freedom) in self.listed {
                star.clear();
                for &t in self.smoother.tets_of.list(v.index()) {
                    star.push(opposite(self.smoother.tets[t as usize], v, self.points));
                }
                self.points[v.index()] =
                    newton_step::<F>(self.machine, &star, self.points[v.index()], freedom);
            }
        }
    }
}

/// One step of Newton, shortened until it makes the sum smaller.
#[inline(always)]
fn newton_step<F: FourLanes>(machine: F::Machine, star: &Star, from: Point, freedom: f64) -> Point {
    let (before, step) = star.value_and_newton_step::<F>(machine, from);
    let length = norm(step);
    if length == 0.0 || !length.is_finite() {
        return from;
    }
    let max_step = MAX_STEP * star.mean_edge::<F>(machine, from);
    let mut part = freedom * (max_step / length).min(1.0);
    for _ in 0..=BACKTRACKS {
        let to = add(from, scale(step, part));
        let now = star.value::<F>(machine, to);
        // Upright tets stay upright.
        if now.sum < before.sum && (now.worst > 0.0 || before.worst <= 0.0) {
            return to;
        }
        part *= BACKTRACK_FACTOR;
    }
    from
}

/// The other three corners of a tet, in the order that keeps the sign of its volume when `v` comes first.
#[inline(always)]
fn opposite(tet: [VertexId; 4], v: VertexId, points: &[Point]) -> [Point; 3] {
    let [a, b, c, d] = tet;
    let other = match () {
        () if v == a => [b, c, d],
        () if v == b => [a, d, c],
        () if v == c => [a, b, d],
        () => [a, c, b],
    };
    [points[other[0].index()], points[other[1].index()], points[other[2].index()]]
}
