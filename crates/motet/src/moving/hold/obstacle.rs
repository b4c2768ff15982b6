//! The walls that another one gives way to, and where it is when it goes along with them.

use super::nodes_of;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::rigid::Rigid;
use crate::geometry::vector::{add, scale, sub};
use crate::spatial::NearestTriangle;

/// Walls that others give way to.
#[derive(Clone, Debug)]
pub(super) struct Obstacle {
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// Of each triangle, the number of its wall among these.
    wall: Vec<u32>,
    /// The nodes of each wall, rising.
    nodes: Vec<Vec<VertexId>>,
    tree: NearestTriangle,
}

impl Obstacle {
    pub(super) fn new(places: &[Point], walls: &[Vec<[VertexId; 3]>], threads: &Threads) -> Self {
        let triangles = walls.concat();
        let wall = (0..).zip(walls).flat_map(|(k, wall)| wall.iter().map(move |_| k)).collect();
        let tree = NearestTriangle::new(places, &triangles, threads);
        Self { triangles, wall, nodes: walls.iter().map(|wall| nodes_of(wall)).collect(), tree }
    }

    pub(super) fn has_node(&self, v: VertexId) -> bool {
        self.nodes.iter().any(|nodes| nodes.binary_search(&v).is_ok())
    }

    /// Whether all its nodes are where they were.
    pub(super) fn is_still(&self, from: &[Point], to: &[Point]) -> bool {
        self.nodes.iter().flatten().all(|v| from[v.index()] == to[v.index()])
    }

    /// How far each of these nodes is from the nearest place, where all are at `at`.
    pub(super) fn distances(&mut self, nodes: &[VertexId], at: &[Point], threads: &Threads) -> Vec<f64> {
        self.tree.refit(at, threads);
        let places: Vec<Point> = nodes.iter().map(|v| at[v.index()]).collect();
        let found = self.tree.closest_all(&places, None, threads);
        found
            .into_iter()
            .map(|found| found.map_or(f64::INFINITY, |found| found.distance_squared.sqrt()))
            .collect()
    }

    /// Where nodes are that go along: each with the rigid motion that fits that of the wall nearest to it best, and with what the nearest place of it goes beside that.
    pub(super) fn carry(
        &mut self,
        nodes: &[VertexId],
        from: &[Point],
        to: &[Point],
        threads: &Threads,
    ) -> Vec<Point> {
        let rigid: Vec<Rigid> = self.nodes.iter().map(|nodes| fit(nodes, from, to)).collect();
        self.tree.refit(from, threads);
        let places: Vec<Point> = nodes.iter().map(|v| from[v.index()]).collect();
        let found = self.tree.closest_all(&places, None, threads);
        let carried = |(p, found): (&Point, &Option<crate::spatial::Closest>)| {
            let Some(found) = found else { return *p };
            let rigid = &rigid[self.wall[found.triangle] as usize];
            let rest =
                self.triangles[found.triangle].map(|v| sub(to[v.index()], rigid.apply(from[v.index()])));
            let weighted = rest.into_iter().zip(found.weights).map(|(rest, w)| scale(rest, w));
            weighted.fold(rigid.apply(*p), add)
        };
        places.iter().zip(&found).map(carried).collect()
    }
}

fn fit(nodes: &[VertexId], from: &[Point], to: &[Point]) -> Rigid {
    Rigid::fit(&nodes.iter().map(|v| (from[v.index()], to[v.index()])).collect::<Vec<_>>())
}
