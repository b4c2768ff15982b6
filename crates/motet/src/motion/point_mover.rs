//! Points that follow nodes, without a mesh: for solvers whose processes each have a part of the mesh.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::in_range;
use crate::motion::graph::{embed, triangulate};
use crate::motion::update::{Displacements, WeightTable};

/// Moves arbitrary points by the Delaunay graph of some nodes: a weighted sum of four displacements each.
///
/// It does what [`Mover`](crate::motion::Mover) does with
/// [`Method::Delaunay`](crate::motion::Method::Delaunay), but without the mesh: cells are not known, so
/// nothing is checked or certified. Processes that each have a part of a mesh pass all nodes of the boundary,
/// and their own points. Nodes are taken in the order of their coordinates, one for each position, so that
/// the graph does not depend on the order in which they are given. A point that lies on a facet of the graph
/// is found in either tet, depending on the points before it: processes that share a point may place it
/// differently in the last digits.
#[derive(Debug)]
pub struct PointMover {
    reference: Vec<Point>,
    n_nodes: usize,
    /// The given node that stands for each node of the graph.
    representatives: Vec<u32>,
    table: WeightTable,
    n_outside: usize,
}

impl PointMover {
    /// Sets up `points` to follow `nodes`.
    ///
    /// # Errors
    /// When the nodes do not span space, a coordinate is not finite, or there are more points than ids.
    pub fn new(nodes: &[Point], points: &[Point], threads: &Threads) -> Result<Self> {
        check_finite(nodes, "node")?;
        check_finite(points, "point")?;
        if nodes.len().max(points.len()) > VertexId::MAX_COUNT {
            return Err(Error::input(format!("{} points exceed the number of vertex ids", points.len())));
        }
        let mut representatives: Vec<u32> = (0..nodes.len() as u32).collect();
        // -0.0 counts as 0.0.
        let place = |&i: &u32| nodes[i as usize].map(|x| x + 0.0);
        representatives.sort_by(|a, b| {
            let (p, q) = (place(a), place(b));
            p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])).then(p[2].total_cmp(&q[2])).then(a.cmp(b))
        });
        representatives.dedup_by(|b, a| place(a) == place(b));
        let graph: Vec<Point> = representatives.iter().map(place).collect();
        let triangulation = triangulate(&graph, threads)?;
        let found = embed(&triangulation, points, threads);
        let mut table = WeightTable::fixed(graph.len() as u32, points.len());
        for (i, (&tet, w)) in found.tet.iter().zip(&found.weights).enumerate() {
            table.set(VertexId::new(i), found.tets[tet as usize], *w);
        }
        Ok(Self {
            reference: points.to_vec(),
            n_nodes: nodes.len(),
            representatives,
            table,
            n_outside: found.outside.len(),
        })
    }

    /// How many nodes were given.
    pub fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// The points as they were given.
    pub fn reference(&self) -> &[Point] {
        &self.reference
    }

    /// How many points lie outside the graph; they follow the nearest place in it.
    pub fn n_outside(&self) -> usize {
        self.n_outside
    }

    /// Moves the points from where they were given: `displacement` has an entry for each node as given, and
    /// of several nodes at one position the first counts; `out` receives the positions.
    ///
    /// # Errors
    /// When a length does not fit, or a displacement is not finite.
    pub fn step(&self, displacement: &[Point], out: &mut [Point], threads: &Threads) -> Result<()> {
        for (given, expected, what) in [
            (displacement.len(), self.n_nodes, "displacements of nodes"),
            (out.len(), self.reference.len(), "places for points"),
        ] {
            if given != expected {
                return Err(Error::input(format!("{given} {what} are given, expected {expected}")));
            }
        }
        check_finite(displacement, "displacement")?;
        let driven: Vec<Point> = self.representatives.iter().map(|&i| displacement[i as usize]).collect();
        self.table.apply(&self.reference, &Displacements::Driven(&driven), out, threads);
        Ok(())
    }
}

fn check_finite(points: &[Point], what: &str) -> Result<()> {
    match points.iter().position(|&p| !in_range(p)) {
        None => Ok(()),
        Some(i) => Err(Error::input(format!("{:?} is not finite", points[i])).at(format!("{what} {i}"))),
    }
}
