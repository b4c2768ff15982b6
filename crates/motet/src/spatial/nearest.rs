//! The triangle nearest to a point, by a tree of boxes over a surface.

use super::boxes::{Tree, around};
use crate::base::{Point, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::{add, dot, scale, sub};

/// The answer to a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The triangle, by its place in the list that the tree was built from.
    pub triangle: usize,
    /// Weights of its vertices that give the closest point: each in [0, 1], 1 in sum.
    pub weights: [f64; 3],
    /// The closest point.
    pub point: Point,
    /// Its squared distance from where the search started.
    pub distance_squared: f64,
}

/// Finds the point of a surface closest to any other.
///
/// No tolerance anywhere, so it works alike in metres and in millimetres.
/// Triangles without area count as segments or points; those with a corner that
/// is not finite are left out. Of triangles equally near the first one is found.
#[derive(Clone, Debug)]
pub struct NearestTriangle {
    tree: Tree,
    /// Corners in the order of the leaves.
    corners: Vec<[Point; 3]>,
}

impl NearestTriangle {
    /// Builds the tree. `n log n`.
    ///
    /// Panics when a triangle names a point beyond `points`.
    pub fn new(points: &[Point], triangles: &[[VertexId; 3]]) -> Self {
        let mut items: Vec<(Point, u32)> = Vec::with_capacity(triangles.len());
        let corners_of = |id: u32| triangles[id as usize].map(|v| points[v.index()]);
        for id in 0..triangles.len() as u32 {
            let corners = corners_of(id);
            if corners.as_flattened().iter().all(|x| x.is_finite()) {
                // Before the sum, which might be too large.
                let [a, b, c] = corners.map(|p| scale(p, 1.0 / 3.0));
                items.push((add(add(a, b), c), id));
            }
        }
        let tree = Tree::new(items, &|id| around(corners_of(id)));
        let corners = tree.ids.iter().map(|&id| corners_of(id)).collect();
        Self { tree, corners }
    }

    /// The point of the surface closest to `p`; `None` when there is no
    /// triangle, `p` is not finite or the distance has no finite square.
    pub fn closest(&self, p: Point) -> Option<Closest> {
        self.closest_within(p, f64::INFINITY)
    }

    /// The same, looking no farther than `distance`: `None` when everything is beyond.
    pub fn closest_within(&self, p: Point, distance: f64) -> Option<Closest> {
        let found = self.tree.nearest(p, distance * distance, |i| {
            let weights = triangle::closest(self.corners[i], p);
            let point = triangle::at(self.corners[i], weights);
            let offset = sub(point, p);
            Some((dot(offset, offset), (weights, point)))
        });
        let (distance_squared, id, (weights, point)) = found.filter(|f| f.0.is_finite())?;
        Some(Closest { triangle: id as usize, weights, point, distance_squared })
    }
}
