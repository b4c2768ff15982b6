//! A step by the graph alone: weighted sums for all vertices, after what the graph's own points do.

use crate::base::{Point, Result, Threads};
use crate::motion::update::{Displacements, Update};
use crate::motion::walls::Added;

/// On what each vertex hangs.
#[derive(Debug, Default)]
pub(crate) struct Spread {
    /// In nodes, behind them the points that the graph added.
    pub(crate) update: Update,
    pub(crate) added: Option<Box<Added>>,
}

impl Spread {
    /// Iterations that it took.
    ///
    /// # Errors
    /// When the system of the added points is not solved to its tolerance.
    pub(crate) fn apply(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let Some(added) = &self.added else {
            self.update.apply(from, displacements, out, threads);
            return Ok(0);
        };
        let (all, iterations) = added.extended(displacements, threads)?;
        self.update.apply(from, &all, out, threads);
        Ok(iterations)
    }
}
