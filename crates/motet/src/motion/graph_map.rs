//! A step by the graph alone: weighted sums for all vertices, after the points that the graph added have been
//! placed.

use crate::base::{Point, Result, Threads};
use crate::motion::update::{Displacements, WeightTable};
use crate::motion::walls::AddedPoints;

/// How vertices depend on the nodes of the graph.
#[derive(Debug, Default)]
pub(crate) struct GraphMap {
    /// The weights of each vertex; the nodes are followed by the points that the graph added.
    pub(crate) table: WeightTable,
    pub(crate) added: Option<Box<AddedPoints>>,
}

impl GraphMap {
    /// Moves all vertices from their positions `from`; returns the number of iterations.
    ///
    /// # Errors
    /// When the system of the added points cannot be solved to its tolerance.
    pub(crate) fn apply(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let Some(added) = &self.added else {
            self.table.apply(from, displacements, out, threads);
            return Ok(0);
        };
        let (all, iterations) = added.with_added(displacements, threads)?;
        self.table.apply(from, &all, out, threads);
        Ok(iterations)
    }
}
