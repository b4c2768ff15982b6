//! What is known of gaps: for each vertex, and for each pair of bodies.

use serde::Serialize;

use crate::base::{Point, VertexId};
use crate::geometry::distance::{Closest, Feature};

/// Stands for no body and no triangle.
pub const NONE: u32 = u32::MAX;

/// The gaps of all bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaps {
    /// In the order of the bodies.
    pub bodies: Vec<BodyGaps>,
    /// Every pair that was measured, a body with itself included where that was asked for; first bodies rise.
    pub pairs: Vec<PairGap>,
}

/// The gap at each vertex of a body. All lists have one entry a vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyGaps {
    /// The vertices, rising.
    pub vertices: Vec<VertexId>,
    /// The distance to the nearest other surface; negative for a vertex that is where it must not be: inside a closed
    /// body, outside a room, by its distance from the surface of that. Infinite where nothing is near enough.
    pub gap: Vec<f64>,
    /// The unit vector along which the vertex would go to make the gap smaller; where it touches, the normal of what it
    /// touches, turned against the free side. Zero where there is no gap.
    pub normal: Vec<Point>,
    /// The body that is nearest, or [`NONE`].
    pub closest_body: Vec<u32>,
    /// The triangle of that body, or [`NONE`].
    pub closest_triangle: Vec<u32>,
    /// The place on it; the vertex itself where there is none.
    pub closest_point: Vec<Point>,
    /// Whether a triangle at the vertex is nearer to another surface than the warning distance, or the gap is negative.
    pub warning: Vec<bool>,
}

/// Two bodies, or one with itself.
#[derive(Clone, Debug, PartialEq)]
pub struct PairGap {
    /// Which.
    pub bodies: [u32; 2],
    /// Where they are nearest; `None` where nothing is within reach.
    pub nearest: Option<Nearest>,
    /// Pairs of triangles, of the first body and of the second, that meet; rising.
    pub crossings: Vec<[u32; 2]>,
    /// Vertices of the first body that are where the second does not let them be, and the other way round.
    pub n_wrong: [usize; 2],
    /// How far the deepest of these is from the surface; 0 where there is none.
    pub depth: f64,
    /// Triangles of each that are nearer to the other than the warning distance.
    pub n_warned: [usize; 2],
}

/// The nearest places of two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// How far apart: 0 where they meet.
    pub distance: f64,
    /// A triangle of each.
    pub triangles: [u32; 2],
    /// The vertices of both.
    pub vertices: [[VertexId; 3]; 2],
    /// The place on each.
    pub points: [Point; 2],
    /// The least part of each triangle that holds it.
    pub features: [Feature; 2],
    /// The weights of the places; from it also the derivative of the distance by each of the six vertices.
    pub closest: Closest<3, 3>,
}

/// A group of connected vertices that warn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Warned {
    /// The bodies: that of the vertices, and the one the nearest of them is near to.
    pub bodies: [u32; 2],
    /// How many vertices.
    pub n_vertices: usize,
    /// The least gap of them.
    pub gap: f64,
    /// The vertex that has it.
    pub vertex: VertexId,
    /// Where that is.
    pub place: Point,
}

impl Gaps {
    /// The least gap of any pair: 0 where bodies meet; infinite where nothing is within reach.
    pub fn least(&self) -> f64 {
        let all = self.pairs.iter().filter_map(|pair| pair.nearest);
        all.map(|nearest| nearest.distance).fold(f64::INFINITY, f64::min)
    }

    /// The gap at each of `n_points` points, the least where several bodies have it; infinite where there is none.
    ///
    /// Panics when a body has a vertex beyond.
    pub fn at_points(&self, n_points: usize) -> Vec<f64> {
        let mut all = vec![f64::INFINITY; n_points];
        for body in &self.bodies {
            for (v, &gap) in body.vertices.iter().zip(&body.gap) {
                all[v.index()] = all[v.index()].min(gap);
            }
        }
        all
    }

    /// Whether anything warns.
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
            closest_body: vec![NONE; n],
            closest_triangle: vec![NONE; n],
            closest_point: vertices.iter().map(|v| points[v.index()]).collect(),
            warning: vec![false; n],
        }
    }
}

impl PairGap {
    /// Whether the surfaces cross, or one is where the other does not let it be.
    pub fn is_penetrated(&self) -> bool {
        !self.crossings.is_empty() || self.n_wrong != [0, 0]
    }
}
