//! Maps that carry the displacements of the nodes to all vertices.

use crate::base::{Point, Result, Threads};
use crate::motion::bodies::RigidBodies;
use crate::motion::distance::{InverseDistance, Radial};
use crate::motion::graph_map::GraphMap;
use crate::motion::guided::Guided;
use crate::motion::solve::LinearMethod;
use crate::motion::update::Displacements;

/// One of the methods, set up for one position of the mesh.
#[derive(Debug)]
pub(crate) enum Map {
    /// A weighted sum for each vertex.
    Graph(GraphMap),
    /// Shares in the motion of rigid bodies, and weighted sums for the rest.
    Bodies(Box<RigidBodies>),
    /// The graph whose nodes rotate.
    Guided(Box<Guided>),
    /// Means of rigid motions, by distance.
    Inverse(Box<InverseDistance>),
    /// Radial basis functions.
    Radial(Box<Radial>),
    /// A linear system.
    Linear(Box<LinearMethod>),
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
            Self::Graph(graph_map) => graph_map.apply(from, displacements, out, threads),
            Self::Bodies(bodies) => bodies.apply(from, displacements, out, threads),
            Self::Guided(guided) => guided.apply(from, displacements, out, threads),
            Self::Inverse(inverse) => {
                inverse.apply(from, displacements, out, threads);
                Ok(0)
            }
            Self::Radial(radial) => Ok(radial.apply(from, displacements, out, threads)),
            Self::Linear(linear) => Ok(linear.apply(from, displacements, out, threads)?.iterations),
        }
    }
}
