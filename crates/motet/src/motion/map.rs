//! Maps that carry the displacements of the nodes to all vertices.

use crate::base::{Point, Result, Threads};
use crate::motion::bodies::Bodies;
use crate::motion::distance::{Inverse, Radial};
use crate::motion::guided::Guided;
use crate::motion::solve::Solve;
use crate::motion::spread::Spread;
use crate::motion::update::Displacements;

/// One of the methods, set up for one position of the mesh.
#[derive(Debug)]
pub(crate) enum Map {
    /// A weighted sum for each vertex.
    Graph(Spread),
    /// Shares in the motion of rigid bodies, and weighted sums for the rest.
    Bodies(Box<Bodies>),
    /// The graph whose nodes rotate.
    Guided(Box<Guided>),
    /// Means of rigid motions, by distance.
    Inverse(Box<Inverse>),
    /// Radial basis functions.
    Radial(Box<Radial>),
    /// A linear system.
    Solve(Box<Solve>),
}

impl Map {
    /// Moves all vertices from their positions `from`; returns the number of iterations (of centres, for
    /// radial basis functions).
    ///
    /// # Errors
    /// When a system cannot be solved to the tolerance.
    pub(crate) fn apply(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        match self {
            Self::Graph(spread) => spread.apply(from, displacements, out, threads),
            Self::Bodies(bodies) => bodies.apply(from, displacements, out, threads),
            Self::Guided(guided) => guided.apply(from, displacements, out, threads),
            Self::Inverse(inverse) => {
                inverse.apply(from, displacements, out, threads);
                Ok(0)
            }
            Self::Radial(radial) => Ok(radial.apply(from, displacements, out, threads)),
            Self::Solve(solve) => Ok(solve.apply(from, displacements, out, threads)?.iterations),
        }
    }
}
