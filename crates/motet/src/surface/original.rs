//! The surface as it was given: what is near, and which way it faces.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::{area, area_vector, centroid, longest_side};
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};
use crate::spatial::{Closest, NearestTriangle};

/// The cosine of the largest angle between a new triangle and the given surface near it: 45 degrees.
const MIN_COSINE: f64 = 0.707;

/// Walls are opposite to each other if both are this near to a right angle to the way between them: cosine of
/// 14 degrees.
const OPPOSITE: f64 = 0.97;

/// The given surface, label by label.
pub(super) struct Original {
    of_label: Vec<OfLabel>,
    /// How far a new surface may stray from it.
    pub(super) distance: f64,
}

struct OfLabel {
    tree: NearestTriangle,
    /// The unit normal of each triangle; where a triangle is thinner than the distance, that of its
    /// surroundings; zero where these have none.
    normals: Vec<Point>,
    /// The vertices of the triangles.
    corners: Vec<[VertexId; 3]>,
    /// The ids of the triangles in the given surface.
    ids: Vec<usize>,
}

impl Original {
    /// The triangles by label, with trees to search them; the new surface may stray by up to `distance`.
    pub(super) fn new(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        labels: &[u32],
        distance: f64,
        threads: &Threads,
    ) -> Self {
        let n_labels = labels.iter().max().map_or(0, |&most| most as usize + 1);
        let mut by_label = vec![Vec::new(); n_labels];
        for (id, &label) in labels.iter().enumerate() {
            by_label[label as usize].push(id);
        }
        let of = |ids: Vec<usize>| {
            let corners: Vec<[VertexId; 3]> = ids.iter().map(|&id| triangles[id]).collect();
            OfLabel {
                tree: NearestTriangle::new(points, &corners, threads),
                normals: normals(points, &corners, distance),
                corners,
                ids,
            }
        };
        Self { of_label: by_label.into_iter().map(of).collect(), distance }
    }

    /// The nearest point of a label's triangles, if it is within `reach`.
    pub(super) fn near(&self, label: u32, p: Point, reach: f64) -> Option<Closest> {
        self.of_label[label as usize].tree.closest_within(p, reach)
    }

    /// The given triangle on which [`Self::near`] found a point.
    pub(super) fn id(&self, label: u32, found: &Closest) -> usize {
        self.of_label[label as usize].ids[found.triangle]
    }

    /// The value at a point found by [`Self::near`], of values at vertices.
    pub(super) fn value(&self, label: u32, found: &Closest, of_vertices: &[f64]) -> f64 {
        let corners = self.of_label[label as usize].corners[found.triangle];
        corners.iter().zip(found.weights).map(|(v, weight)| weight * of_vertices[v.index()]).sum()
    }

    /// Whether a place of a label is near. `last` is the label and triangle that the last place was near to,
    /// which as a rule is near to this one as well.
    pub(super) fn is_near(&self, label: u32, p: Point, last: &mut Option<(u32, usize)>) -> bool {
        let tree = &self.of_label[label as usize].tree;
        let reach = self.distance * self.distance;
        if last.is_some_and(|(of, t)| of == label && tree.distance_squared(t, p) <= reach) {
            return true;
        }
        let found = tree.closest_within(p, self.distance);
        *last = found.map(|found| (label, found.triangle));
        found.is_some()
    }

    /// The distance of the nearest wall beyond the room on one side of a place with this normal; `None` if
    /// there is none within `reach`, or it is nearer than the surface itself may stray.
    pub(super) fn opposite(&self, p: Point, normal: Point, reach: f64) -> Option<f64> {
        let of = |of: &OfLabel| {
            let is_opposite = |t: u32, found: &Closest| {
                let way = sub(found.point, p);
                let least = OPPOSITE * norm(way);
                least > 2.0 * OPPOSITE * self.distance
                    && dot(way, normal).abs() > least
                    && dot(way, of.normals[t as usize]) > least
            };
            of.tree.closest_where(p, reach, is_opposite).map(|found| found.distance_squared.sqrt())
        };
        self.of_label.iter().filter_map(of).min_by(f64::total_cmp)
    }

    /// Whether the centroid of a triangle is near a place of its label that faces the same way.
    pub(super) fn faces(&self, label: u32, triangle: [Point; 3]) -> bool {
        let of = &self.of_label[label as usize];
        let normal = area_vector(triangle);
        let length = norm(normal);
        let faces = |t: u32, _: &Closest| {
            let facing = of.normals[t as usize];
            facing == [0.0; 3] || dot(normal, facing) > MIN_COSINE * length
        };
        length > 0.0 && of.tree.closest_where(centroid(triangle), self.distance, faces).is_some()
    }
}

/// Whether a triangle is so low that its normal says nothing.
pub(super) fn is_thin(corners: [Point; 3], least_height: f64) -> bool {
    2.0 * area(corners) < least_height * longest_side(corners)
}

fn normals(points: &[Point], triangles: &[[VertexId; 3]], least_height: f64) -> Vec<Point> {
    let corners = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let mut at_vertices = vec![[0.0; 3]; points.len()];
    for t in triangles {
        let area = area_vector(corners(t));
        t.iter().for_each(|v| at_vertices[v.index()] = add(at_vertices[v.index()], area));
    }
    let of = |t: &[VertexId; 3]| {
        let own = area_vector(corners(t));
        if !is_thin(corners(t), least_height) {
            return unit(own).unwrap_or_default();
        }
        let around = t.iter().fold([0.0; 3], |sum, v| add(sum, at_vertices[v.index()]));
        // Each corner's sum has the triangle's own area in it.
        unit(sub(around, scale(own, 2.0))).unwrap_or_default()
    };
    triangles.iter().map(of).collect()
}
