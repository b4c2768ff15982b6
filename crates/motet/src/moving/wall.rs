//! The walls as they came: what the caller's displacements are about, however the walls are divided by now.

use crate::base::{Point, Result, Threads, VertexId};
use crate::mesh::{Mesh, Surface};
use crate::motion::{FacetSet, SurfaceCarrier};
use crate::moving::options::Motion;

/// Stands for no node: a vertex that came later.
pub(super) const NO_NODE: u32 = u32::MAX;

/// The driven vertices of the first mesh, the *nodes*, and the triangles between them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wall {
    /// Where each node was at first.
    pub(super) places: Vec<Point>,
    /// By number of node.
    pub(super) triangles: Vec<[VertexId; 3]>,
}

impl Wall {
    /// `driven` are the vertices of the first mesh that the caller moves, rising.
    pub(super) fn of(mesh: &Mesh, driven: &[VertexId], motion: &Motion) -> Self {
        let mut triangles = Surface::boundary_of(mesh).triangles;
        for &label in &motion.inside {
            triangles.extend(FacetSet::of_patch(mesh, label).triangles());
        }
        let node = |v: VertexId| driven.binary_search(&v).ok().map(VertexId::new);
        let nodes = |t: &[VertexId; 3]| Some([node(t[0])?, node(t[1])?, node(t[2])?]);
        Self {
            places: driven.iter().map(|v| mesh.points[v.index()]).collect(),
            triangles: triangles.iter().filter_map(nodes).collect(),
        }
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
