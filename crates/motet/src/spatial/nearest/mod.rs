//! Finds the triangle nearest to a point, by a tree of boxes over a surface.

mod eights;
mod lanes;
mod nearby;
mod node;
mod oriented;
mod packed;
mod pairs;
mod search;

use pulp::{Arch, Simd, WithSimd};

use crate::base::{MaybeId, Point, Threads, TriangleId, VertexId};
use crate::geometry::triangle;
use nearby::Nearby;
use packed::Packed;
use pairs::{PairSearch, Reach};
use search::{Admit, All, Filtered, Search};

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The triangle, by its index in the list that the tree was built from.
    pub triangle: usize,
    /// Weights of its vertices that give the closest point: each in [0, 1], with sum 1.
    pub weights: [f64; 3],
    /// The closest point.
    pub point: Point,
    /// The squared distance of the closest point from the query point.
    pub distance_squared: f64,
}

/// Finds the point of a surface closest to a given point.
///
/// No tolerance is used, so it works alike in metres and in millimetres: every result is, to the bit, that of
/// an exhaustive search with [`triangle::closest`](crate::geometry::triangle::closest). Triangles
/// without area count as segments or points; triangles with a corner that is not finite are left out. Among
/// equally near triangles, the first one is found.
///
/// For a surface that moves, build once and [`refit`](Self::refit).
#[derive(Clone, Debug)]
pub struct NearestTriangle {
    tree: Packed,
}

/// Queries done one after the other, each with the previous answer as its guess.
const RUN: usize = 256;

/// Groups of eight leaves whose pairs one thread examines at a time.
const EIGHTS_PER_TASK: usize = 16;

impl NearestTriangle {
    /// Builds the tree, in `O(n log n)`.
    ///
    /// Panics when a triangle names a point beyond `points`.
    pub fn new(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Self {
        Self { tree: Packed::new(points, triangles, threads) }
    }

    /// Takes over points that moved, of the same triangles, in a fraction of the time of [`new`](Self::new).
    /// Answers stay exact however far points move; a motion that leaves no neighbours together makes searches
    /// slow.
    ///
    /// Panics when a triangle names a point beyond `points`.
    pub fn refit(&mut self, points: &[Point], threads: &Threads) {
        self.tree.fit(points, threads);
    }

    /// Bytes that the tree takes.
    pub fn memory(&self) -> usize {
        self.tree.memory()
    }

    /// The point of the surface closest to `p`; `None` if there is no triangle, `p` is not finite or the
    /// distance has no finite square.
    pub fn closest(&self, p: Point) -> Option<Closest> {
        self.closest_within(p, f64::INFINITY)
    }

    /// The point of the surface closest to `p`, if it is no farther than `distance`; `None` if everything is
    /// beyond.
    pub fn closest_within(&self, p: Point, distance: f64) -> Option<Closest> {
        Arch::new().dispatch(SingleSearch { tree: &self.tree, p, reach: distance * distance, admit: All })
    }

    /// The squared distance of a point from one of the triangles.
    ///
    /// Panics if there is no such triangle.
    pub fn distance_squared(&self, id: usize, p: Point) -> f64 {
        triangle::distance_squared(self.tree.corners(self.tree.id_to_place[id] as usize), p)
    }

    /// The closest of those triangles within `distance` that `admit` admits. `admit` receives the index of a
    /// triangle and the result that a search for it alone would give.
    ///
    /// It is called only for triangles better than all admitted before (nearer, or as near and of a smaller
    /// index), and never twice for one. A search that refuses many triangles examines everything nearer than
    /// its answer.
    pub fn closest_where(
        &self,
        p: Point,
        distance: f64,
        admit: impl FnMut(u32, &Closest) -> bool,
    ) -> Option<Closest> {
        let admit = Filtered(admit);
        Arch::new().dispatch(SingleSearch { tree: &self.tree, p, reach: distance * distance, admit })
    }

    /// The points of the surface closest to each of many points, as by [`closest`](Self::closest).
    ///
    /// `guesses` are triangles near the points, one for each, ideally from the previous answers. No answer
    /// depends on them, nor on the number of threads. Where there is none, or no such triangle, the last
    /// answer is the guess for the next point. Points are processed in an order in which
    /// neighbours follow each other, so that what a search reads is still cached.
    ///
    /// Panics when there are guesses, but not one for each point.
    pub fn closest_all(
        &self,
        points: &[Point],
        guesses: Option<&[MaybeId<TriangleId>]>,
        threads: &Threads,
    ) -> Vec<Option<Closest>> {
        let order = match guesses {
            None => packed::hilbert_order(points, threads),
            Some(guesses) => {
                assert_eq!(points.len(), guesses.len(), "a guess for each point");
                self.tree.order_by_place(guesses)
            }
        };
        let runs = order.chunks(RUN).map(|order| SearchRun { tree: &self.tree, points, guesses, order });
        let arch = Arch::new();
        if threads.count() == 1 {
            // Each run is stored at once, so that the next one reuses its memory.
            let mut found = vec![None; points.len()];
            for run in runs {
                let answers = arch.dispatch(run);
                run.order.iter().zip(answers).for_each(|(&i, answer)| found[i as usize] = answer);
            }
            return found;
        }
        let answers = threads.each(runs.collect(), |run| arch.dispatch(run));
        let mut place = vec![0u32; points.len()];
        order.iter().zip(0..).for_each(|(&i, k)| place[i as usize] = k);
        threads.map(points.len(), |i| answers[place[i] as usize / RUN][place[i] as usize % RUN])
    }

    /// The nearest pair of a triangle of this surface and one of another: the squared distance and the two
    /// triangles. Among equally near pairs, the first one is found. `None` if no pair is within the square
    /// root of `start`.
    ///
    /// `pair(state, i, j, bound)` returns the squared distance of triangle `i` of this surface from triangle
    /// `j` of the other, or `None` if that is above `bound`. It is called only for pairs whose boxes are near
    /// enough, with a state of its own on each thread. A good `start`, such as the squared distance of any
    /// pair of points of the two surfaces, avoids most of the calls.
    pub fn closest_pair<T: Default + Send>(
        &self,
        other: &Self,
        start: f64,
        threads: &Threads,
        pair: impl Fn(&mut T, u32, u32, f64) -> Option<f64> + Sync,
    ) -> Option<(f64, u32, u32)> {
        let (reach, arch, n) = (Reach::new(start), Arch::new(), self.tree.oriented.len());
        let run = |state: &mut T, eights| {
            let pair = |i: u32, j: u32, bound: f64| pair(state, i, j, bound);
            let search = PairSearch { from: &self.tree, to: &other.tree, eights, reach: &reach, pair };
            Vec::from_iter(arch.dispatch(search))
        };
        let nearer = |x: (f64, u32, u32), y| if y < x { y } else { x };
        threads.in_runs(n, EIGHTS_PER_TASK, run).into_iter().reduce(nearer)
    }
}

/// One search, compiled for the instruction set of the machine, as is [`SearchRun`] for many.
struct SingleSearch<'a, A> {
    tree: &'a Packed,
    p: Point,
    reach: f64,
    admit: A,
}

impl<A: Admit> WithSimd for SingleSearch<'_, A> {
    type Output = Option<Closest>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let mut search = Search::new(self.tree, simd, self.p, self.reach, self.admit)?;
        search.descend();
        search.finish()
    }
}

#[derive(Clone, Copy)]
struct SearchRun<'a> {
    tree: &'a Packed,
    points: &'a [Point],
    guesses: Option<&'a [MaybeId<TriangleId>]>,
    /// Indices of the points to search from.
    order: &'a [u32],
}

impl WithSimd for SearchRun<'_> {
    type Output = Vec<Option<Closest>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let (mut last, mut nearby) = (None, Nearby::new());
        let mut found = Vec::with_capacity(self.order.len());
        for &i in self.order {
            let given = self.guesses.and_then(|guesses| guesses[i as usize].get());
            let guess = given.filter(|guess| self.tree.has_triangle(*guess)).or(last);
            let p = self.points[i as usize];
            let mut closest = None;
            if let Some(mut search) = Search::new(self.tree, simd, p, f64::INFINITY, All) {
                if let Some(guess) = guess {
                    search.try_first(guess);
                }
                search.descend_nearby(&mut nearby);
                closest = search.finish();
            }
            last = closest.map(|closest| TriangleId(closest.triangle as u32)).or(last);
            found.push(closest);
        }
        found
    }
}
