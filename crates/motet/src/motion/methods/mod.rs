//! The methods of motion, side by side: how the vertices that nothing else moves follow the nodes.
//!
//! A method [prepares](Prepare) a [`Follower`] for a [`Scene`] with its vertices at some position; the
//! follower moves the vertices from there. A new method is a folder or file here with the two traits, its
//! line in [`of`], a variant of [`Method`] and its name in `motion/words.rs`.

mod bodies;
mod delaunay;
mod guided;
mod inverse_distance;
#[cfg(feature = "elasticity")]
mod linear;
mod radial;

use std::fmt::Debug;

#[cfg(not(feature = "elasticity"))]
use crate::base::Error;
use crate::base::{Point, Result, Threads, VertexId};
use crate::mesh::{Boundary, Mesh};
use crate::motion::graph::Walls;
use crate::motion::nodes::Nodes;
use crate::motion::options::{Method, Options};
use crate::motion::setup::Setup;
use crate::motion::update::{Displacements, WeightTable};

/// The method of the options, with what it takes from the mesh as it was given.
///
/// # Errors
/// When the options of the method do not fit the mesh.
pub(crate) fn of(reference: &mut Reference<'_>) -> Result<Box<dyn Prepare>> {
    Ok(match &reference.options.method {
        Method::Delaunay => Box::new(delaunay::Delaunay::new(reference)),
        Method::Bodies(sets) => Box::new(bodies::Bodies::new(sets, reference)?),
        Method::Guided => Box::new(guided::Guided::new(reference)),
        #[cfg(feature = "elasticity")]
        Method::Elastic(law) => Box::new(*law),
        #[cfg(feature = "elasticity")]
        Method::Laplace(law) => Box::new(linear::LaplaceEquation::new(law, reference)),
        #[cfg(not(feature = "elasticity"))]
        Method::Elastic(_) | Method::Laplace(_) => {
            return Err(Error::options("motet was built without the methods `elastic` and `laplace`")
                .remedy("build it with the feature `elasticity`, or choose another method"));
        }
        Method::InverseDistance => Box::new(inverse_distance::InverseDistance::new(reference)),
        Method::Radial => Box::new(radial::Radial),
    })
}

/// A method of motion on a mesh, for any position of its vertices.
pub(crate) trait Prepare: Debug + Send + Sync {
    /// Sets up a follower for the mesh with its vertices at `points`.
    ///
    /// # Errors
    /// When the nodes do not span space, or a system cannot be set up.
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared>;
}

/// A method of motion, set up for one position of the mesh.
pub(crate) trait Follower: Debug + Send + Sync {
    /// Moves all vertices from their positions `from`, given the displacements of the nodes, to `out`;
    /// returns the number of iterations (of centres, for radial basis functions).
    ///
    /// # Errors
    /// When a system cannot be solved to the tolerance.
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize>;

    /// The nodes that vertices follow, and their weights; `None` where vertices follow anything else.
    fn weights(&self) -> Option<&WeightTable> {
        None
    }
}

/// The mesh as it was given, from which a method takes what it needs once.
pub(crate) struct Reference<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) boundary: &'a Boundary,
    pub(crate) options: &'a Options,
    /// The corners of the cells as tets.
    pub(crate) corners: &'a [[VertexId; 4]],
    /// Vertices that are to follow, in rising order.
    pub(crate) free: &'a [VertexId],
    pub(crate) nodes: &'a mut Nodes,
}

/// What moves and what follows, wherever the vertices are.
pub(crate) struct Scene<'a> {
    pub(crate) nodes: &'a Nodes,
    /// Vertices that are to follow, in rising order.
    pub(crate) free: &'a [VertexId],
    /// The corners of the cells as tets.
    pub(crate) corners: &'a [[VertexId; 4]],
    /// Whether a volume cell uses each vertex. Where given, vertices of no cell that cannot follow stay;
    /// without it, all of `free` follow.
    pub(crate) is_used: Option<&'a [bool]>,
}

impl Reference<'_> {
    /// The walls that the graph stays within, where the options say so.
    fn walls(&mut self) -> Option<Walls> {
        self.options.within_walls.then(|| Walls::new(self.mesh, self.boundary, self.nodes))
    }
}

impl Scene<'_> {
    /// The free vertices without those that stay, which are given by their indices in rising order.
    fn following(&self, staying: &[u32]) -> Vec<VertexId> {
        let follows = |(i, _): &(u32, &VertexId)| staying.binary_search(i).is_err();
        (0..).zip(self.free).filter(follows).map(|(_, v)| *v).collect()
    }

    /// The free vertices that a cell uses, and the indices of the others in [`Self::free`].
    fn used(&self) -> (Vec<VertexId>, Vec<u32>) {
        let stays = |v: VertexId| self.is_used.is_some_and(|is_used| !is_used[v.index()]);
        let staying = (0..).zip(self.free).filter(|(_, v)| stays(**v)).map(|(i, _)| i).collect();
        (self.free.iter().copied().filter(|v| !stays(*v)).collect(), staying)
    }
}

/// A follower, and what setting it up found.
pub(crate) struct Prepared<F = Box<dyn Follower>> {
    pub(crate) follower: F,
    /// The indices in [`Scene::free`] of vertices that do not follow, in rising order.
    pub(crate) staying: Vec<u32>,
    /// The tets of the graph that contain a vertex, where all their nodes are vertices.
    pub(crate) graph_tets: Vec<[VertexId; 4]>,
    /// The counts and seconds of the method; the rest is left at 0.
    pub(crate) setup: Setup,
}

impl<F: Follower + 'static> Prepared<F> {
    fn boxed(self) -> Prepared {
        let Self { follower, staying, graph_tets, setup } = self;
        Prepared { follower: Box::new(follower), staying, graph_tets, setup }
    }
}
