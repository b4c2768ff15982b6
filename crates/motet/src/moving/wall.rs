//! The walls as given: displacements refer to them, however the walls are divided by now.

use std::collections::HashMap;

use crate::base::{Error, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::vector::norm;
use crate::mesh::{Mesh, Surface, bounds, largest_extent};
use crate::motion::{FacetSet, Mover, SurfaceCarrier};
use crate::moving::options::Options;

/// Walls are at rest if no node has moved by more than this fraction of their extent.
const AT_REST: f64 = 1e-9;

/// Marks a vertex that is not a node: one that was inserted later.
pub(super) const NO_NODE: u32 = u32::MAX;

/// Marks a triangle of none of the watched patches.
pub(super) const NO_BODY: u32 = u32::MAX;

/// The driven vertices of the first mesh, the *nodes*, and the triangles between them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wall {
    /// The position of each node at first.
    pub(super) places: Vec<Point>,
    /// Triangles, by node numbers.
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// If walls are kept apart: the index of the watched patch of each triangle, or [`NO_BODY`]; otherwise
    /// empty.
    pub(super) body: Vec<u32>,
}

impl Wall {
    /// The walls of the first mesh, which a mover moves.
    ///
    /// # Errors
    /// If a patch that is to be kept apart does not exist, or is not driven.
    pub(super) fn of(mesh: &Mesh, mover: &Mover, options: &Options) -> Result<Self> {
        let driven = mover.boundary();
        let node = |v: VertexId| driven.binary_search(&v).ok().map(VertexId::new);
        let nodes = |t: &[VertexId; 3]| Some([node(t[0])?, node(t[1])?, node(t[2])?]);
        let triangles: Vec<_> = wall_triangles(mesh, mover, options).iter().filter_map(nodes).collect();
        let held = options.watch.as_ref().filter(|watch| watch.hold.is_some());
        let mut body = vec![NO_BODY; if held.is_some() { triangles.len() } else { 0 }];
        let place: HashMap<_, _> = triangles.iter().map(|t| sorted_ids(*t)).zip(0..).collect();
        for (k, held) in (0..).zip(held.map_or(Ok(Vec::new()), |watch| watch.bodies(mesh))?) {
            for triangle in &held.triangles {
                let place = nodes(triangle).and_then(|t| place.get(&sorted_ids(t)).copied());
                body[place.ok_or_else(|| not_driven(&held.name))?] = k;
            }
        }
        let places = driven.iter().map(|v| mesh.points[v.index()]).collect();
        Ok(Self { places, triangles, body })
    }

    /// Whether displacements leave the walls at their first position, to rounding.
    pub(super) fn is_at_rest(&self, displacement: &[Point]) -> bool {
        let near = AT_REST * bounds(&self.places).map_or(0.0, largest_extent);
        displacement.iter().all(|d| norm(*d) <= near)
    }

    /// The triangles of watched patch `k`.
    pub(super) fn body(&self, k: u32) -> Vec<[VertexId; 3]> {
        let of = self.triangles.iter().zip(&self.body).filter(|(_, body)| **body == k);
        of.map(|(t, _)| *t).collect()
    }

    /// How the driven vertices of a later mesh take their displacements; `first` and `node` have an entry for
    /// each of its vertices.
    pub(super) fn drive(
        &self,
        driven: &[VertexId],
        first: &[Point],
        node: &[u32],
        threads: &Threads,
    ) -> Result<Drive> {
        let not_nodes = driven.iter().filter(|v| node[v.index()] == NO_NODE);
        let places: Vec<Point> = not_nodes.map(|v| first[v.index()]).collect();
        let carrier = match places.is_empty() {
            true => None,
            false => Some(SurfaceCarrier::new(&self.places, &self.triangles, &places, threads)?),
        };
        Ok(Drive { node: driven.iter().map(|v| node[v.index()]).collect(), carrier })
    }
}

/// The triangles of the boundary of a mesh, which a mover moves, and of those patches inside that move and
/// that the mesh has.
pub(super) fn wall_triangles(mesh: &Mesh, mover: &Mover, options: &Options) -> Vec<[VertexId; 3]> {
    let mut triangles = Surface::of_boundary(mesh, mover.connectivity().boundary.clone()).triangles;
    let inside = options.motion.inside.iter().filter_map(|patch| FacetSet::find(mesh, patch).ok());
    inside.for_each(|patch| triangles.extend(patch.triangles()));
    triangles
}

fn not_driven(name: &str) -> Error {
    Error::input(format!("the patch {name} is to be kept apart from others, but its vertices are not driven"))
        .remedy("list it among the moving patches inside, or keep apart patches of the boundary only")
}

/// How the driven vertices of a mesh take their displacements from those of the nodes.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    /// The node of each driven vertex, or [`NO_NODE`].
    node: Vec<u32>,
    /// Carries displacements to driven vertices that are not nodes, if there are any.
    carrier: Option<SurfaceCarrier>,
}

impl Drive {
    /// The displacement of each driven vertex.
    pub(super) fn carry(&self, displacement: &[Point]) -> Vec<Point> {
        let carried = self.carrier.as_ref().map(|carrier| carrier.carry(displacement));
        let mut carried = carried.unwrap_or_default().into_iter();
        let of = |&node: &u32| match node {
            NO_NODE => carried.next().unwrap_or_default(),
            node => displacement[node as usize],
        };
        self.node.iter().map(of).collect()
    }
}
