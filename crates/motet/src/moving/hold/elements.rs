//! Triangles and nodes of a wall that gives way, and how near each may come.

use super::obstacle::Obstacle;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::distance::triangle_triangle::closest_below;
use crate::geometry::vector::largest_coordinate;
use crate::spatial::{BoxTree, bounding_box, expanded};

/// Anything nearer than this fraction of the largest coordinate touches.
const TOUCHES: f64 = 1e-13;

/// All elements of a wall that is kept away from others.
#[derive(Clone, Debug)]
pub(super) struct Elements {
    pub(super) all: Vec<Element>,
}

/// A triangle or a node; a node is stored as three equal corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub(super) corners: [VertexId; 3],
    /// The distance to keep: no more than at first, or walls that are joined would be torn apart.
    pub(super) least: f64,
}

impl Elements {
    /// The elements of a wall: its triangles between these nodes (in rising order), and single nodes, namely
    /// those without such a triangle or with one nearer than the distance at first. Elements that touch the
    /// obstacle at first are left out.
    pub(super) fn new(
        triangles: &[[VertexId; 3]],
        nodes: &[VertexId],
        distance: f64,
        places: &[Point],
        obstacle: &mut Obstacle,
        threads: &Threads,
    ) -> Self {
        let of_node = obstacle.distances(nodes, places, threads);
        let boxes: Vec<_> =
            obstacle.triangles.iter().map(|t| bounding_box(t.map(|v| places[v.index()]))).collect();
        let tree = BoxTree::new(&boxes);
        let touches = TOUCHES * largest_coordinate(places);
        let place = |v: &VertexId| nodes.binary_search(v).ok();
        let free: Vec<[VertexId; 3]> =
            triangles.iter().copied().filter(|t| t.iter().all(|v| place(v).is_some())).collect();
        let least = threads.map(free.len(), |i| {
            let corners = free[i].map(|v| places[v.index()]);
            let known = free[i].iter().filter_map(place).map(|k| of_node[k]).fold(distance, f64::min);
            let mut found = Vec::new();
            tree.touching(expanded(bounding_box(corners), known), &mut found);
            found.iter().fold(known, |least, &t| {
                let other = obstacle.triangles[t as usize].map(|v| places[v.index()]);
                closest_below(corners, other, least * least).map_or(least, |closest| closest.distance())
            })
        });
        let mut all: Vec<Element> =
            free.iter().zip(least).map(|(&corners, least)| Element { corners, least }).collect();
        // A single node may have to stay farther away than the triangles at it.
        let mut of_triangles = vec![(distance, 0u32); nodes.len()];
        for element in &all {
            element.corners.iter().filter_map(place).for_each(|k| {
                of_triangles[k] = (of_triangles[k].0.min(element.least), of_triangles[k].1 + 1);
            });
        }
        let alone = nodes.iter().zip(&of_node).zip(of_triangles).filter_map(|((&v, &own), (least, n))| {
            (n == 0 || least < distance).then_some(Element { corners: [v; 3], least: own.min(distance) })
        });
        all.extend(alone);
        all.retain(|element| element.least > touches);
        Self { all }
    }
}
