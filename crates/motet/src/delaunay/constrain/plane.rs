//! The Delaunay triangulation of an input triangle whose edges carry points: a convex polygon with vertices in line.
//!
//! Circles in the plane are spheres through a point beside it, whichever: so signs and ties are those of space, and what comes out are
//! the facets that the tets would have if they saw no others.

use super::sites::Sites;
use crate::base::{Point, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::predicates::spot::{Spot, insphere_perturbed_of, orient3d_of};

/// The plane of a triangle.
pub(super) struct Plane<'a> {
    sites: &'a Sites,
    /// A point beside it, in front.
    beside: Point,
}

impl<'a> Plane<'a> {
    /// The plane of three given vertices that are not in line.
    pub(super) fn new(sites: &'a Sites, corners: [VertexId; 3]) -> Self {
        let [a, b, c] = corners.map(|v| sites.near(v));
        let step = |axis: usize, sign: f64| {
            let mut p = a;
            p[axis] = a[axis] + sign * (a[axis].abs() + b[axis].abs() + 1.0);
            p
        };
        let mut tries = (0..3).flat_map(|axis| [step(axis, 1.0), step(axis, -1.0)]);
        let beside = tries.find(|&p| orient3d(a, b, c, p) > 0).unwrap_or(a);
        Self { sites, beside }
    }

    /// 1 where three vertices of the plane turn as the triangle does.
    fn turn(&self, v: [VertexId; 3]) -> i8 {
        let [a, b, c] = v.map(|v| self.sites.spot(v));
        orient3d_of([a, b, c, Spot::Given(self.beside)])
    }

    /// Whether `query` lies in the circle of three vertices that turn as the triangle does.
    fn is_in_circle(&self, [a, b, c]: [VertexId; 3], query: VertexId) -> bool {
        let spot = |v: VertexId| self.sites.spot(v);
        let spots = [spot(a), spot(b), spot(c), Spot::Given(self.beside), spot(query)];
        let rank = |v: VertexId| self.sites.rank(v);
        // The point beside is raised by the least: that moves no circle.
        insphere_perturbed_of(spots, [rank(a), rank(b), rank(c), 0, rank(query)]) > 0
    }

    /// Triangles of a convex polygon, turned as it is; its vertices may lie in line. None where all do.
    pub(super) fn triangulate(&self, polygon: &[VertexId]) -> Vec<[VertexId; 3]> {
        let mut triangles = Vec::new();
        let mut chains = vec![(0, polygon.len() - 1)];
        // The vertices of a chain lie to the left of the way from its last vertex to its first, the edge where they are yet to be joined.
        while let Some((from, to)) = chains.pop() {
            let [last, first] = [polygon[to], polygon[from]];
            let mut apex: Option<usize> = None;
            for k in from + 1..to {
                let is_better = apex.is_none_or(|a| self.is_in_circle([last, first, polygon[a]], polygon[k]));
                if is_better && self.turn([last, first, polygon[k]]) > 0 {
                    apex = Some(k);
                }
            }
            if let Some(k) = apex {
                triangles.push([last, first, polygon[k]]);
                chains.extend([(from, k), (k, to)]);
            }
        }
        triangles
    }
}
