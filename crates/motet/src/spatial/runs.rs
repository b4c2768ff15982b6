//! Many triangles looked at in runs: their corners, their boxes, and answers that come in order, whatever the number of threads.

use std::ops::Range;

use super::boxes::{self, Bounds};
use crate::base::{Point, Threads, VertexId};
use crate::geometry::vector::is_finite;

/// Things that a thread does in one go: a few microseconds each, so that sharing out costs nothing beside.
const RUN: usize = 128;

/// [`Threads::in_runs`] of so many.
pub(crate) fn in_runs<S: Default, T: Send>(
    n: usize,
    threads: &Threads,
    run: impl Fn(&mut S, Range<usize>) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    threads.in_runs(n, RUN, run)
}

/// The corners of a triangle.
pub(crate) fn corners(points: &[Point], triangle: [VertexId; 3]) -> [Point; 3] {
    triangle.map(|v| points[v.index()])
}

/// The box around points; one that touches nothing where one of them is not finite.
pub(crate) fn around(points: &[Point]) -> Bounds {
    if !points.iter().all(|&p| is_finite(p)) {
        return [[f64::NAN; 3]; 2];
    }
    boxes::around(points.iter().copied())
}
