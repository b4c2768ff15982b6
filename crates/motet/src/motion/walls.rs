//! Walls that the graph does not cross: its tets are those of the constrained Delaunay triangulation of the
//! boundary, so each vertex follows nodes of its own lumen.
//!
//! Where triangles of the boundary cannot all be facets without more points (Schoenhardt 1928), the
//! triangulation has some inside. They move by linear elements on the graph for a Laplace equation: so an
//! affine motion of the boundary still moves every vertex by the same affine map.

use std::collections::HashSet;

use crate::algebra::{Tolerance, conjugate_gradients};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::tet;
use crate::geometry::vector::{add, dot, scale, sub};
use crate::mesh::{Boundary, Mesh};
use crate::motion::graph::{Embedding, Graph};
use crate::motion::nodes::Nodes;
use crate::motion::options::FacetSet;
use crate::motion::slide::key;
use crate::motion::solve::{Numbering, System, gradients, laplacian};
use crate::motion::update::{Displacements, Padded};
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

/// Points that the graph added: they follow the others.
#[derive(Debug)]
pub(crate) struct AddedPoints {
    /// For each given node of the graph, its index among all nodes.
    given: Vec<u32>,
    n: usize,
    system: System<f64>,
}

/// A tolerance far below what affects cells.
const STEP_TOLERANCE: Tolerance = Tolerance { residual: 1e-12, iterations: 10_000 };

impl AddedPoints {
    /// Sets up the added points of a graph; `None` where all its nodes are given.
    ///
    /// # Errors
    /// When an added point has only flat tets.
    pub(crate) fn new(graph: &Graph, given: &[u32]) -> Result<Option<Self>> {
        let n = graph.places.len() - given.len();
        if n == 0 {
            return Ok(None);
        }
        let ids = |range: std::ops::Range<usize>| range.map(VertexId::new).collect::<Vec<_>>();
        let numbering =
            Numbering::new(graph.places.len(), &ids(given.len()..graph.places.len()), &ids(0..given.len()));
        let tets: Vec<[VertexId; 4]> = graph.tets.iter().map(|t| t.map(VertexId)).collect();
        let tets = numbering.of_tets(&tets);
        let mut system = System::<f64>::with_pattern(&numbering, &tets.numbers);
        system.fill(&tets.numbers, |t| {
            let found = gradients(tets.vertices[t].map(|v| graph.places[v.index()]));
            found.map_or([[0.0; 4]; 4], |(g, volume)| laplacian(&g, volume))
        })?;
        Ok(Some(Self { given: given.to_vec(), n, system }))
    }

    pub(crate) fn len(&self) -> usize {
        self.n
    }

    /// Displacements of all nodes, followed by those of the added points; and the number of iterations.
    ///
    /// # Errors
    /// When the system cannot be solved to the tolerance.
    pub(crate) fn with_added(
        &self,
        displacements: &Displacements<'_>,
        threads: &Threads,
    ) -> Result<(Displacements<'static>, usize)> {
        let table = displacements.table();
        let given: Vec<Point> = self.given.iter().map(|&n| table[n as usize].point()).collect();
        let mut right = self.system.coupling.times(&given, threads);
        right.iter_mut().for_each(|f| *f = f.map(|x| -x));
        let mut added = vec![[0.0; 3]; self.n];
        let System { inner, sweeps, .. } = &self.system;
        let solved = conjugate_gradients(inner, sweeps, &right, &mut added, STEP_TOLERANCE, threads)?;
        let (nodes, never) = table.split_at(table.len() - 1);
        let all =
            nodes.iter().copied().chain(added.into_iter().map(Padded::new)).chain(never.iter().copied());
        Ok((Displacements::All(all.collect()), solved.iterations))
    }
}
