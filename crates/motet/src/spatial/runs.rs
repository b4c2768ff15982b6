//! Many triangles processed in runs: their corners, their boxes, and results in order, whatever the number of
//! threads.

use std::ops::Range;

use super::boxes::{self, Bounds};
use crate::base::{Point, Threads, VertexId};
use crate::geometry::vector::is_finite;

/// Items that a thread processes at a time: a few microseconds each, so that the cost of sharing them out is
/// negligible.
const RUN: usize = 128;

/// [`Threads::in_runs`] with runs of [`RUN`] items.
pub(crate) fn in_runs<S: Default + Send, T: Send>(
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

/// The box around points; one that touches nothing if any of them is not finite.
pub(crate) fn bounding_box(points: &[Point]) -> Bounds {
    if !points.iter().all(|&p| is_finite(p)) {
        return [[f64::NAN; 3]; 2];
    }
    boxes::bounding_box(points.iter().copied())
}
