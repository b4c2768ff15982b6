//! Objectives: which of several ways to fill a cavity is best.

use crate::base::{TetId, VertexId};
use crate::kernel::Complex;

/// The cost of a new tet, and of several together; the lowest cost is best.
pub trait Objective {
    /// The cost of no tets.
    const NOTHING: f64;

    /// Prepares for filling `cavity` with `n_fill` tets; returns the limit that their cost has to stay below.
    fn limit(&mut self, complex: &Complex, cavity: &[TetId], n_fill: usize) -> f64;

    /// The cost of a tet with these vertices and this quality; infinite if it is not acceptable.
    fn cost(&self, vertices: [VertexId; 4], quality: f64) -> f64;

    /// The cost of two sets of tets together.
    fn both(&self, a: f64, b: f64) -> f64;
}

/// Maximizes the worst quality, which has to exceed this one.
#[derive(Clone, Copy, Debug)]
pub struct WorstAbove(pub f64);

impl Objective for WorstAbove {
    const NOTHING: f64 = f64::NEG_INFINITY;

    #[inline]
    fn limit(&mut self, _: &Complex, _: &[TetId], _: usize) -> f64 {
        -self.0
    }

    #[inline]
    fn cost(&self, _: [VertexId; 4], quality: f64) -> f64 {
        -quality
    }

    #[inline]
    fn both(&self, a: f64, b: f64) -> f64 {
        a.max(b)
    }
}
