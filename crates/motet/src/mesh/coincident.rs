//! Points at exactly the same place.

use crate::base::{Point, VertexId};

/// For each point, the point of smallest id with exactly the same coordinates: itself if there is no other. A
/// point with a NaN coordinate matches no other. Takes `n log n` time.
pub fn firsts_at_place(points: &[Point]) -> Vec<VertexId> {
    let mut firsts: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    let mut order = firsts.clone();
    // Adding 0 turns -0 into +0, so that both sort alike.
    let key = |v: &VertexId| points[v.index()].map(|x| total_order(x + 0.0));
    order.sort_unstable_by_key(|v| (key(v), *v));
    for same in order.chunk_by(|a, b| points[a.index()] == points[b.index()]) {
        same.iter().for_each(|v| firsts[v.index()] = same[0]);
    }
    firsts
}

/// An integer that sorts in the same order as `x`.
fn total_order(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}
