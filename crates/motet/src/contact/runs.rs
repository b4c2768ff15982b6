//! Many things done in runs: the answers come in order, whatever the number of threads.

use std::ops::Range;

use rayon::prelude::*;

use crate::base::{Point, Threads, VertexId};
use crate::geometry::vector::is_finite;
use crate::spatial::{self, Bounds};

/// Things that a thread does in one go: a few microseconds each, so that sharing out costs nothing beside.
const RUN: usize = 128;

/// What `run` says of each run of the numbers below `n`, joined. It works on a state that is kept for the next run.
pub(super) fn in_runs<S: Default, T: Send>(
    n: usize,
    threads: &Threads,
    run: impl Fn(&mut S, Range<usize>) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    match threads.pool() {
        None => run(&mut S::default(), 0..n),
        Some(pool) => pool.install(|| {
            let runs = (0..n.div_ceil(RUN)).into_par_iter().map(|k| k * RUN..n.min((k + 1) * RUN));
            let parts: Vec<Vec<T>> = runs.map_init(S::default, run).collect();
            parts.into_iter().flatten().collect()
        }),
    }
}

/// The corners of a triangle.
pub(super) fn corners(points: &[Point], triangle: [VertexId; 3]) -> [Point; 3] {
    triangle.map(|v| points[v.index()])
}

/// The box around points; one that touches nothing where one of them is not finite.
pub(super) fn around(points: &[Point]) -> Bounds {
    if !points.iter().all(|&p| is_finite(p)) {
        return [[f64::NAN; 3]; 2];
    }
    spatial::around(points.iter().copied())
}
