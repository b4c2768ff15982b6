//! The results: gaps at each vertex and of each pair of bodies.

use serde::Serialize;

use crate::base::{BodyId, MaybeId, Point, TriangleId, VertexId};
use crate::geometry::distance::{Closest, Feature};

/// The gaps of all bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaps {
    /// The gaps of each body, in the order of the bodies.
    pub bodies: Vec<BodyGaps>,
    /// Every pair that was measured, a body with itself included where requested, ordered by the first body.
    pub pairs: Vec<PairGap>,
}

/// The gap at each vertex of a body. All lists have one entry per vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyGaps {
    /// The vertices, in ascending order.
    pub vertices: Vec<VertexId>,
    /// The distance to the nearest other surface. For a vertex that is where it must not be, inside a closed
    /// body or outside a room, it is minus the distance from the surface of that body. Infinite if nothing is
    /// near enough.
    pub gap: Vec<f64>,
    /// The unit vector along which the vertex would move to reduce the gap; where it touches, the normal of
    /// the surface that it touches, pointing away from the free side. Zero if there is no gap.
    pub normal: Vec<Point>,
    /// The nearest body, if any.
    pub closest_body: Vec<MaybeId<BodyId>>,
    /// The nearest triangle of that body, if any.
    pub closest_triangle: Vec<MaybeId<TriangleId>>,
    /// The closest point on it; the vertex itself if there is none.
    pub closest_point: Vec<Point>,
    /// Whether a triangle at the vertex is nearer to another surface than the warning distance, or the gap is
    /// negative.
    pub warning: Vec<bool>,
}

/// The gap between two bodies, or of one with itself.
#[derive(Clone, Debug, PartialEq)]
pub struct PairGap {
    /// The two bodies.
    pub bodies: [BodyId; 2],
    /// Where they are nearest; `None` if nothing is within reach.
    pub nearest: Option<Nearest>,
    /// Pairs of triangles, one of the first body and one of the second, that meet; in ascending order.
    pub crossings: Vec<[u32; 2]>,
    /// How many vertices of the first body are where the second does not allow them, and the other way
    /// around.
    pub n_wrong: [usize; 2],
    /// The distance of the deepest of these from the surface; 0 if there are none.
    pub depth: f64,
    /// How many triangles of each body are nearer to the other than the warning distance.
    pub n_warned: [usize; 2],
}

/// The nearest points of two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Their distance; 0 where the surfaces meet.
    pub distance: f64,
    /// A triangle of each.
    pub triangles: [u32; 2],
    /// The vertices of both.
    pub vertices: [[VertexId; 3]; 2],
    /// The point on each.
    pub points: [Point; 2],
    /// The smallest feature of each triangle that contains its point.
    pub features: [Feature; 2],
    /// The weights of the points; it also gives the derivative of the distance by each of the six vertices.
    pub closest: Closest<3, 3>,
}

/// A group of connected vertices with a warning.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Warned {
    /// The body of the vertices, and the body that the nearest of them is near to, if any.
    pub bodies: (BodyId, MaybeId<BodyId>),
    /// How many vertices.
    pub n_vertices: usize,
    /// The smallest gap among them.
    pub gap: f64,
    /// The vertex with this gap.
    pub vertex: VertexId,
    /// The coordinates of that vertex.
    pub place: Point,
}

impl Gaps {
    /// The smallest gap of any pair: 0 where bodies meet; infinite if nothing is within reach.
    pub fn least(&self) -> f64 {
        let all = self.pairs.iter().filter_map(|pair| pair.nearest);
        all.map(|nearest| nearest.distance).fold(f64::INFINITY, f64::min)
    }

    /// The gap at each of `n_points` points, the smallest if several bodies share it; infinite where there is
    /// none.
    ///
    /// Panics when a body has a vertex beyond `n_points`.
    pub fn at_points(&self, n_points: usize) -> Vec<f64> {
        let mut all = vec![f64::INFINITY; n_points];
        for body in &self.bodies {
            for (v, &gap) in body.vertices.iter().zip(&body.gap) {
                all[v.index()] = all[v.index()].min(gap);
            }
        }
        all
    }

    /// Whether there is any warning.
    pub fn is_warned(&self) -> bool {
        self.bodies.iter().any(|body| body.warning.contains(&true))
    }
}

impl BodyGaps {
    pub(super) fn new(vertices: &[VertexId], points: &[Point]) -> Self {
        let n = vertices.len();
        Self {
            vertices: vertices.to_vec(),
            gap: vec![f64::INFINITY; n],
            normal: vec![[0.0; 3]; n],
            closest_body: vec![MaybeId::NONE; n],
            closest_triangle: vec![MaybeId::NONE; n],
            closest_point: vertices.iter().map(|v| points[v.index()]).collect(),
            warning: vec![false; n],
        }
    }
}

impl PairGap {
    /// Whether the surfaces cross, or a vertex of one is where the other does not allow it.
    pub fn is_penetrated(&self) -> bool {
        !self.crossings.is_empty() || self.n_wrong != [0, 0]
    }
}
