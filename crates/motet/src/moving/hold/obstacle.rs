//! The walls that another one gives way to, and where it is when it is carried along with them.

use super::nodes_of;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::rigid::Rigid;
use crate::geometry::vector::{add, scale, sub};
use crate::spatial::NearestTriangle;

/// Walls that others give way to.
#[derive(Clone, Debug)]
pub(super) struct Obstacle {
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// For each triangle, the index of its wall among these.
    wall: Vec<u32>,
    /// The nodes of each wall, in rising order.
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

    /// Whether all nodes of these walls stay where they are.
    pub(super) fn is_still(&self, from: &[Point], to: &[Point]) -> bool {
        self.nodes.iter().flatten().all(|v| from[v.index()] == to[v.index()])
    }

    /// The distance of each of these nodes from the nearest point of the walls, with all nodes at `at`.
    pub(super) fn distances(&mut self, nodes: &[VertexId], at: &[Point], threads: &Threads) -> Vec<f64> {
        self.tree.refit(at, threads);
        let places: Vec<Point> = nodes.iter().map(|v| at[v.index()]).collect();
        let found = self.tree.closest_all(&places, None, threads);
        found
            .into_iter()
            .map(|found| found.map_or(f64::INFINITY, |found| found.distance_squared.sqrt()))
            .collect()
    }

    /// The positions of nodes that are carried along: each follows the best rigid fit to the motion of the
    /// wall nearest to it, plus the deviation from that fit at the nearest point.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle around a place, facing z.
    fn triangle([x, y, z]: Point) -> [Point; 3] {
        [[x - 1.0, y - 1.0, z], [x + 1.0, y - 1.0, z], [x, y + 1.0, z]]
    }

    #[test]
    fn nodes_go_along_with_the_wall_nearest_to_them_wherever_it_was_before() {
        let at = |low: f64, high: f64| {
            [triangle([0.0, 0.0, low]), triangle([0.0, 0.0, high]), [[0.0; 3]; 3]].concat()
        };
        let walls: Vec<Vec<[VertexId; 3]>> =
            vec![vec![[0, 1, 2].map(VertexId)], vec![[3, 4, 5].map(VertexId)]];
        let threads = Threads::single();
        let place = |node: Point, low: f64, high: f64| {
            let mut all = at(low, high);
            all[6] = node;
            all
        };
        let node = [0.0, 0.0, 1.0];
        let mut obstacle = Obstacle::new(&at(0.0, 10.0), &walls, &threads);
        // The first wall is the nearer one; then the two swap places.
        assert_eq!(obstacle.distances(&[VertexId(6)], &place(node, 0.0, 10.0), &threads), [1.0]);
        let (from, to) = (place(node, 10.0, 0.0), place(node, 10.5, 2.0));
        assert_eq!(obstacle.carry(&[VertexId(6)], &from, &to, &threads), [[0.0, 0.0, 3.0]]);
        assert_eq!(obstacle.distances(&[VertexId(6)], &from, &threads), [1.0]);
        assert!(!obstacle.is_still(&from, &to) && obstacle.is_still(&from, &from));
    }
}
