//! Which of several ways to fill a cavity is best.

use crate::base::{TetId, VertexId};
use crate::kernel::Complex;

/// Costs of tets to come, and of several together; the lowest is best.
pub trait Objective {
    /// What no tet costs.
    const NOTHING: f64;

    /// Looks at the tets that are to go, of which so many are to come in place; the limit that the cost of these has to be below.
    fn limit(&mut self, complex: &Complex, cavity: &[TetId], n_fill: usize) -> f64;

    /// The cost of a tet with these vertices, of this quality; infinite where none such may come.
    fn cost(&self, vertices: [VertexId; 4], quality: f64) -> f64;

    /// The cost of two sets of tets together.
    fn both(&self, a: f64, b: f64) -> f64;
}

/// The worst tet is to be as good as it can, and better than this quality.
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
