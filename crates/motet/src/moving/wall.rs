//! The walls as they came: what the caller's displacements are about, however the walls are divided by now.

use std::collections::HashMap;

use crate::base::{Error, Point, Result, Threads, VertexId, rising};
use crate::geometry::vector::norm;
use crate::mesh::{Mesh, Surface, bounds, largest_extent};
use crate::motion::{FacetSet, SurfaceCarrier};
use crate::moving::options::Options;

/// Walls that are so near to where they were at first, as a part of their extent, are at rest.
const AT_REST: f64 = 1e-9;

/// Stands for no node: a vertex that came later.
pub(super) const NO_NODE: u32 = u32::MAX;

/// Stands for none of the watched patches.
pub(super) const NO_BODY: u32 = u32::MAX;

/// The driven vertices of the first mesh, the *nodes*, and the triangles between them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wall {
    /// Where each node was at first.
    pub(super) places: Vec<Point>,
    /// By number of node.
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// Where walls are kept apart, which of the watched patches each triangle is of, or [`NO_BODY`]; else empty.
    pub(super) body: Vec<u32>,
}

impl Wall {
    /// `driven` are the vertices of the first mesh that the caller moves, rising.
    ///
    /// # Errors
    /// When a patch that is to be kept apart is not there, or is not driven.
    pub(super) fn of(mesh: &Mesh, driven: &[VertexId], options: &Options) -> Result<Self> {
        let node = |v: VertexId| driven.binary_search(&v).ok().map(VertexId::new);
        let nodes = |t: &[VertexId; 3]| Some([node(t[0])?, node(t[1])?, node(t[2])?]);
        let triangles: Vec<_> = wall_triangles(mesh, options).iter().filter_map(nodes).collect();
        let held = options.watch.as_ref().filter(|watch| watch.hold.is_some());
        let mut body = vec![NO_BODY; if held.is_some() { triangles.len() } else { 0 }];
        let place: HashMap<_, _> = triangles.iter().map(|t| rising(*t)).zip(0..).collect();
        for (k, held) in (0..).zip(held.map_or(Ok(Vec::new()), |watch| watch.bodies(mesh))?) {
            for triangle in &held.triangles {
                let place = nodes(triangle).and_then(|t| place.get(&rising(t)).copied());
                body[place.ok_or_else(|| not_driven(&held.name))?] = k;
            }
        }
        let places = driven.iter().map(|v| mesh.points[v.index()]).collect();
        Ok(Self { places, triangles, body })
    }

    /// Whether displacements leave the walls where they were at first, to rounding.
    pub(super) fn is_at_rest(&self, displacement: &[Point]) -> bool {
        let near = AT_REST * bounds(&self.places).map_or(0.0, largest_extent);
        displacement.iter().all(|d| norm(*d) <= near)
    }

    /// The triangles of a watched patch.
    pub(super) fn body(&self, k: u32) -> Vec<[VertexId; 3]> {
        let of = self.triangles.iter().zip(&self.body).filter(|(_, body)| **body == k);
        of.map(|(t, _)| *t).collect()
    }

    /// How the driven vertices of a later mesh take their displacements; `first` and `node` are about all of its vertices.
    pub(super) fn drive(
        &self,
        driven: &[VertexId],
        first: &[Point],
        node: &[u32],
        threads: &Threads,
    ) -> Result<Drive> {
        let came = driven.iter().filter(|v| node[v.index()] == NO_NODE);
        let places: Vec<Point> = came.map(|v| first[v.index()]).collect();
        let carrier = match places.is_empty() {
            true => None,
            false => Some(SurfaceCarrier::new(&self.places, &self.triangles, &places, threads)?),
        };
        Ok(Drive { node: driven.iter().map(|v| node[v.index()]).collect(), carrier })
    }
}

/// The triangles of the boundary, and of the patches inside that move.
pub(super) fn wall_triangles(mesh: &Mesh, options: &Options) -> Vec<[VertexId; 3]> {
    let mut triangles = Surface::boundary_of(mesh).triangles;
    for &label in &options.motion.inside {
        triangles.extend(FacetSet::of_patch(mesh, label).triangles());
    }
    triangles
}

fn not_driven(name: &str) -> Error {
    Error::input(format!("the patch {name} is to be kept apart from others, but is not driven"))
        .remedy("name it as one inside that moves, or keep patches of the boundary apart")
}

/// How the driven vertices of a mesh take their displacements from those of the nodes.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    /// The node that each is.
    node: Vec<u32>,
    /// For those that are none.
    carrier: Option<SurfaceCarrier>,
}

impl Drive {
    /// The displacement of each driven vertex.
    pub(super) fn carry(&self, displacement: &[Point]) -> Vec<Point> {
        let carried = self.carrier.as_ref().map(|carrier| carrier.carry(displacement));
        let mut came = carried.unwrap_or_default().into_iter();
        let of = |&node: &u32| match node {
            NO_NODE => came.next().unwrap_or_default(),
            node => displacement[node as usize],
        };
        self.node.iter().map(of).collect()
    }
}
