//! Inverse-distance weighting with rotations (Luke, Collins, Blades 2012, *A fast mesh deformation method
//! using explicit interpolation*).
//!
//! Each boundary vertex moves all of space rigidly, by its displacement and its rotation. An interior vertex
//! gets the mean of these motions, weighted by `area ((L / r)^3 + (L / (4 r))^5)`, where `r` is its distance
//! and `L` the extent of the mesh. Every vertex sums over all nodes; programs that rely on this method sum
//! over trees.

use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot, norm, scale, sub};
use crate::mesh::bounds;
use crate::motion::methods::{Follower, Prepare, Prepared, Reference, Scene};
use crate::motion::options::FacetSet;
use crate::motion::polar::{IDENTITY, Quaternion, rotation_change};
use crate::motion::rotation::Wall;
use crate::motion::setup::Setup;
use crate::motion::update::{Displacements, Padded};

/// The boundary, whose facets have areas and rotations.
#[derive(Debug)]
pub(crate) struct InverseDistance {
    facets: FacetSet,
}

impl InverseDistance {
    pub(crate) fn new(reference: &Reference<'_>) -> Self {
        Self { facets: FacetSet::of_boundary(reference.boundary, "boundary", |_| true) }
    }
}

impl Prepare for InverseDistance {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], _: &Threads) -> Result<Prepared> {
        let (free, staying) = scene.used();
        let follower = InverseDistanceFollower::new(&self.facets, &scene.nodes.vertices, free, points);
        Ok(Prepared { follower, staying, graph_tets: Vec::new(), setup: Setup::default() }.boxed())
    }
}

/// The corners of the boundary, set up for one position of the mesh.
#[derive(Debug)]
struct InverseDistanceFollower {
    wall: Wall,
    /// The node and the position of each corner, and a third of the area of its facets.
    corners: Vec<Corner>,
    /// All nodes; they move exactly by their displacements.
    nodes: Vec<VertexId>,
    free: Vec<VertexId>,
    extent: f64,
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    node: u32,
    place: Point,
    area: f64,
}

/// The near part of the weight begins at this fraction of the extent.
const NEAR: f64 = 0.25;

impl InverseDistanceFollower {
    fn new(facets: &FacetSet, nodes: &[VertexId], free: Vec<VertexId>, points: &[Point]) -> Self {
        let mut node_of = vec![None; points.len()];
        (0u32..).zip(nodes).for_each(|(i, v)| node_of[v.index()] = Some(i));
        let mut vertices: Vec<VertexId> = facets.rings.items().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.retain(|v| node_of[v.index()].is_some());
        let local = |v: VertexId| vertices.binary_search(&v).ok().map(|i| i as u32);
        let of_nodes = |t: [VertexId; 3]| Some([local(t[0])?, local(t[1])?, local(t[2])?]);
        let triangles: Vec<[u32; 3]> = facets.triangles().filter_map(of_nodes).collect();
        let places: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
        let mut areas = vec![0.0; places.len()];
        for t in &triangles {
            let area = norm(area_vector(t.map(|v| places[v as usize])));
            t.iter().for_each(|v| areas[*v as usize] += area / 3.0);
        }
        let corner = |(v, (&place, area)): (&VertexId, (&Point, f64))| {
            node_of[v.index()].map(|node| Corner { node, place, area })
        };
        let extent = bounds(&places).map_or(1.0, |[low, high]| norm(sub(high, low)));
        Self {
            corners: vertices.iter().zip(places.iter().zip(areas)).filter_map(corner).collect(),
            wall: Wall::new(&places, &triangles, |_| true),
            nodes: nodes.to_vec(),
            free,
            extent,
        }
    }
}

impl Follower for InverseDistanceFollower {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let table = displacements.table();
        let moved: Vec<Padded> = self.corners.iter().map(|c| table[c.node as usize]).collect();
        let rotations = self.wall.rotations(&moved, threads);
        let rotation = |i: usize| rotations.of(i).copied().unwrap_or(IDENTITY);
        let rotations: Vec<Quaternion> = (0..moved.len()).map(rotation).collect();
        let places = threads.map(self.free.len(), |i| {
            let p = from[self.free[i].index()];
            let (mut sum, mut weights) = ([0.0; 3], 0.0);
            for ((corner, d), &q) in self.corners.iter().zip(&moved).zip(&rotations) {
                let arm = sub(p, corner.place);
                let near = self.extent * self.extent / dot(arm, arm);
                let cubed = near * near.sqrt();
                let weight = corner.area * (cubed + NEAR.powi(5) * cubed * near);
                sum = add(sum, scale(add(d.point(), rotation_change(q, arm)), weight));
                weights += weight;
            }
            if weights > 0.0 && weights.is_finite() { add(p, scale(sum, 1.0 / weights)) } else { p }
        });
        out.copy_from_slice(from);
        self.free.iter().zip(places).for_each(|(v, p)| out[v.index()] = p);
        for (v, d) in self.nodes.iter().zip(&*table) {
            out[v.index()] = add(from[v.index()], d.point());
        }
        Ok(0)
    }
}
