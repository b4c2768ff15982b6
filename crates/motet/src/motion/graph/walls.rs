//! Walls that the graph does not cross: its tets are those of the constrained Delaunay triangulation of the
//! boundary, so each vertex follows nodes of its own lumen.
//!
//! Where triangles of the boundary cannot all be facets without more points (Schoenhardt 1928), the
//! triangulation has some inside.

use std::collections::HashSet;

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::tet;
use crate::geometry::vector::{add, dot, scale, sub};
use crate::mesh::{Boundary, Mesh};
use crate::motion::graph::{Embedding, Graph};
use crate::motion::nodes::Nodes;
use crate::motion::options::FacetSet;
use crate::motion::slide::key;
use crate::spatial::BoxTree;

/// Triangles that no tet of the graph crosses, over the nodes of the graph.
#[derive(Debug, Default)]
pub(crate) struct Walls {
    triangles: Vec<[VertexId; 3]>,
}

impl Walls {
    /// The triangles of the boundary, and triangles of interior patches whose corners are all nodes. Nodes in
    /// the middle of edges leave the graph: they move by their own displacements.
    pub(crate) fn new(mesh: &Mesh, boundary: &Boundary, nodes: &mut Nodes) -> Self {
        let outer = FacetSet::of_boundary(boundary, "", |_| true);
        let mut is_corner = vec![false; mesh.points.len()];
        outer.rings.items().iter().for_each(|v| is_corner[v.index()] = true);
        let mut is_middle = vec![false; mesh.points.len()];
        boundary.vertices.iter().for_each(|v| is_middle[v.index()] = !is_corner[v.index()]);
        nodes.of_graph.retain(|&n| !is_middle[nodes.vertices[n as usize].index()]);
        let mut node_of = vec![None; mesh.points.len()];
        for (i, &n) in nodes.of_graph.iter().enumerate() {
            node_of[nodes.vertices[n as usize].index()] = Some(VertexId::new(i));
        }
        let inner = FacetSet::of_cells(mesh, "", |_| true);
        let mut seen = HashSet::new();
        let of_nodes = |t: [VertexId; 3]| {
            let [a, b, c] = t.map(|v| node_of[v.index()]);
            Some([a?, b?, c?])
        };
        // A facet of four corners counts once, however its patch divides it.
        let rings: HashSet<Vec<VertexId>> = outer.rings.iter().map(key).collect();
        let mut triangles: Vec<[VertexId; 3]> = Vec::new();
        for t in outer.triangles() {
            if let Some(t) = of_nodes(t).filter(|t| seen.insert(key(t))) {
                triangles.push(t);
            }
        }
        let patches = (inner.rings.iter()).filter(|ring| ring.len() == 3 && !rings.contains(&key(ring)));
        for ring in patches {
            if let Some(t) = of_nodes([ring[0], ring[1], ring[2]]).filter(|t| seen.insert(key(t))) {
                triangles.push(t);
            }
        }
        Self { triangles }
    }

    /// The graph on nodes at these positions, and where `points` lie in it.
    ///
    /// # Errors
    /// When facets of the boundary meet in more than they share.
    pub(crate) fn graph(
        &self,
        nodes: Vec<Point>,
        points: &[Point],
        threads: &Threads,
    ) -> Result<(Graph, Embedding)> {
        let filled = constrain(&nodes, &self.triangles, EdgePoints::MoveInside, threads).map_err(|e| {
            let what = format!("the graph cannot be kept within the walls: {}", e.what());
            Error::input(what)
                .remedy("find facets that cross or touch with `motet info`, or let the graph cross walls")
        })?;
        let Constrained { points: places, tets, .. } = filled;
        let embedding = embed(&places, &tets, points, threads);
        let tets = tets.into_iter().map(|t| t.map(|v| v.0)).collect();
        Ok((Graph { places, tets }, embedding))
    }
}

/// Locates points as [`graph::embed`](crate::motion::graph::embed) does, in tets that need not fill a convex
/// space.
fn embed(nodes: &[Point], tets: &[[VertexId; 4]], points: &[Point], threads: &Threads) -> Embedding {
    let corners = |t: u32| tets[t as usize].map(|v| nodes[v.index()]);
    let boxes: Vec<[Point; 2]> = (0..tets.len() as u32)
        .map(|t| {
            let [a, b, c, d] = corners(t);
            let low = [0, 1, 2].map(|k| a[k].min(b[k]).min(c[k].min(d[k])));
            [low, [0, 1, 2].map(|k| a[k].max(b[k]).max(c[k].max(d[k])))]
        })
        .collect();
    let tree = BoxTree::new(&boxes);
    let found: Vec<(u32, bool)> = threads.in_runs(points.len(), 1 << 10, |near: &mut Vec<u32>, run| {
        run.map(|i| {
            let p = points[i];
            tree.touching([p, p], near);
            if let Some(&t) = near.iter().find(|&&t| tet::holds(corners(t), p)) {
                return (t, true);
            }
            let measure = |t: u32| {
                let (x, w) = (corners(t), tet::closest(corners(t), p));
                let foot = (0..4).fold([0.0; 3], |s, k| add(s, scale(x[k], w[k])));
                let way = sub(foot, p);
                Some((dot(way, way), ()))
            };
            (tree.nearest(p, measure).map_or(0, |(_, t, ())| t), false)
        })
        .collect()
    });
    Embedding::new(nodes, tets, &found, points, threads)
}
