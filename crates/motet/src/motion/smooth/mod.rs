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
use crate::geometry::quality::eas_of_each;
use crate::geometry::vector::{add, norm, scale};
use crate::mesh::BAD_EAS;
use crate::motion::corners::CornerTets;
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
    may_move: Vec<bool>,
}

/// Tets per run.
const CHUNK: usize = 1 << 13;

impl Smoother {
    /// Only those vertices of `follows` may move that are corners of nothing but tets.
    pub(crate) fn new(corners: &CornerTets, follows: &[VertexId], n_points: usize, sweeps: usize) -> Self {
        let mut may_move = vec![false; n_points];
        follows.iter().for_each(|v| may_move[v.index()] = true);
        for (tet, _) in corners.tets.iter().zip(&corners.is_cell).filter(|(_, is_cell)| !**is_cell) {
            tet.iter().for_each(|v| may_move[v.index()] = false);
        }
        Self { sweeps, may_move }
    }

    /// Moves vertices of bad tets, where `tets` are all corner tets of the mesh; returns how many.
    pub(crate) fn apply(&self, tets: &[[VertexId; 4]], points: &mut [Point], threads: &Threads) -> usize {
        let listed = self.vertices_to_move(tets, points, threads);
        if listed.is_empty() {
            return 0;
        }
        let first: Vec<Point> = listed.iter().map(|to_move| points[to_move.vertex.index()]).collect();
        let stars = Stars { tets, of_listed: self.stars(tets, &listed, threads) };
        self.sweep(&listed, &stars, points);
        let moved =
            listed.iter().zip(first).filter(|(to_move, first)| points[to_move.vertex.index()] != *first);
        moved.count()
    }

    fn sweep(&self, listed: &[ToMove], stars: &Stars<'_>, points: &mut [Point]) {
        let sweeps = self.sweeps;
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = pulp::x86::V3::try_new() {
            return machine.vectorize(Sweeps::<Wide> { machine, sweeps, listed, stars, points });
        }
        Sweeps::<Plain> { machine: (), sweeps, listed, stars, points }.call();
    }

    /// The vertices to move, in rising order.
    fn vertices_to_move(&self, tets: &[[VertexId; 4]], points: &[Point], threads: &Threads) -> Vec<ToMove> {
        let mut listed = threads.in_runs(tets.len(), CHUNK, |_: &mut (), run| {
            let mut found = Vec::new();
            for (tet, eas) in tets[run.clone()].iter().zip(eas_of_each(points, &tets[run])) {
                if eas < FADE_EAS {
                    let freedom = ((FADE_EAS - eas) / (FADE_EAS - BAD_EAS)).clamp(0.0, 1.0);
                    let may_move = tet.iter().filter(|v| self.may_move[v.index()]);
                    found.extend(may_move.map(|&vertex| ToMove { vertex, freedom }));
                }
            }
            found
        });
        listed.sort_unstable_by(|x, y| x.vertex.cmp(&y.vertex).then(y.freedom.total_cmp(&x.freedom)));
        listed.dedup_by_key(|x| x.vertex);
        listed
    }

    /// The tets of each listed vertex, in rising order.
    fn stars(&self, tets: &[[VertexId; 4]], listed: &[ToMove], threads: &Threads) -> Csr<u32> {
        let mut is_listed = vec![false; self.may_move.len()];
        listed.iter().for_each(|to_move| is_listed[to_move.vertex.index()] = true);
        let uses = threads.in_runs(tets.len(), CHUNK, |_: &mut (), run| {
            let mut found = Vec::new();
            for (t, tet) in (run.start as u32..).zip(&tets[run]) {
                found.extend(tet.iter().filter(|v| is_listed[v.index()]).map(|v| (*v, t)));
            }
            found
        });
        let place = |v: VertexId| listed.partition_point(|to_move| to_move.vertex < v);
        Csr::from_pairs(listed.len(), || uses.iter().map(|&(v, t)| (place(v), t)))
    }
}

/// A vertex to move.
#[derive(Clone, Copy, Debug)]
struct ToMove {
    vertex: VertexId,
    /// How freely it may move: 1 beside a bad tet.
    freedom: f64,
}

/// The tets of the vertices of a list.
struct Stars<'a> {
    tets: &'a [[VertexId; 4]],
    of_listed: Csr<u32>,
}

/// Sweeps over the vertices of a list.
struct Sweeps<'a, F: FourLanes> {
    machine: F::Machine,
    sweeps: usize,
    listed: &'a [ToMove],
    stars: &'a Stars<'a>,
    points: &'a mut [Point],
}

impl<F: FourLanes> NullaryFnOnce for Sweeps<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mut star = Star::default();
        for _ in 0..self.sweeps {
            for (&ToMove { vertex: v, freedom }, tets) in self.listed.iter().zip(self.stars.of_listed.iter())
            {
                star.clear();
                for &t in tets {
                    star.push(opposite(self.stars.tets[t as usize], v, self.points));
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
