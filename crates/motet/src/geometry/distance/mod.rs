//! Distances between points, segments and triangles: the distance, the closest points, the feature on which
//! each lies, the derivative.
//!
//! Each pair of primitives has a file with a function `closest`, which returns a [`Closest`].
//!
//! **Accuracy.** The closest points are points of the primitives, given by weights in [0, 1]; the distance is
//! that of these points, so it is too small by no more than rounding. It is too large by at most about 1e-15
//! of the *extent*, the size of both primitives together, whatever their shape: needles, parallel edges,
//! segments and triangles that are points. (Of 20,000 hard pairs of each kind the worst was off by 3.4e-16 of
//! it; `tests/geometry/distance.rs` prints it.)
//! There is no tolerance in units of length. Coordinates are taken relative to one of the points and in units
//! of a power of two near the extent, so results do not depend on the unit of length or on the origin; sizes
//! from 1e-150 to 1e150 are supported. Coordinates must be finite.
//!
//! **Why needles and parallel edges do no harm.** The point within a face is found as in
//! [`triangle::closest`](super::triangle::closest), and the pair of points within two edges in the same way:
//! by projecting on one direction and on another at right angles to it, which is made orthogonal twice (the
//! Gram-Schmidt process; Giraud, Langou and Rozloznik 2005). Rounding may then change the weights
//! considerably, but only along directions in which the points hardly move: the *place* in the plane of both
//! directions is accurate to a few roundings of the extent. If the computed weights fall outside although the
//! true ones do not, the way from the true place to the computed one crosses a border; so a point of that
//! border is just as close to the true place, and the borders are always examined as well.

mod frame;
pub mod point_segment;
pub mod point_triangle;
pub mod segment_segment;
pub mod segment_triangle;
pub mod triangle_triangle;

use crate::base::Point;
use crate::geometry::vector::{dot, scale, sub};

/// The closest points of two primitives with `A` and `B` vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest<const A: usize, const B: usize> {
    /// The squared distance.
    pub distance_squared: f64,
    /// Weights of the vertices of the first primitive that give its closest point: each in [0, 1], their sum
    /// 1 up to rounding.
    pub on_a: [f64; A],
    /// Weights of the vertices of the second primitive that give its closest point: each in [0, 1], their sum
    /// 1 up to rounding.
    pub on_b: [f64; B],
    /// The vector from the closest point of the first primitive to that of the second.
    pub offset: Point,
}

/// The smallest part of a primitive that contains a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// The vertex with this local number.
    Vertex(u8),
    /// The interior of an edge: for a triangle the edge opposite this vertex, for a segment edge 0.
    Edge(u8),
    /// The interior of the triangle.
    Face,
}

/// The derivative of the distance with respect to the position of each vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<const A: usize, const B: usize> {
    /// The derivatives with respect to the vertices of the first primitive.
    pub by_a: [Point; A],
    /// The derivatives with respect to the vertices of the second primitive.
    pub by_b: [Point; B],
}

impl<const A: usize, const B: usize> Closest<A, B> {
    /// The distance.
    pub fn distance(&self) -> f64 {
        self.distance_squared.sqrt()
    }

    /// The features of the first and of the second primitive that contain the closest points: those whose
    /// vertices have nonzero weights.
    pub fn features(&self) -> [Feature; 2] {
        [Feature::of(&self.on_a), Feature::of(&self.on_b)]
    }

    /// The unit vector from the first closest point to the second; `None` at distance 0.
    ///
    /// It is as accurate as the distance: where that is within rounding of 0, the direction is meaningless.
    pub fn direction(&self) -> Option<Point> {
        let largest = self.offset.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        // Divided, not multiplied by the inverse: the inverse of the smallest numbers is infinite.
        let offset = self.offset.map(|x| x / largest);
        (self.distance_squared > 0.0 && largest > 0.0)
            .then(|| scale(offset, 1.0 / dot(offset, offset).sqrt()))
    }

    /// The derivative of the distance with respect to every vertex: with the unit vector `n` from the first
    /// closest point to the second, `-w n` for a vertex of the first primitive with weight `w`, and `w n` for
    /// one of the second. (The weights change too when a vertex moves, but at a minimum of the distance that
    /// effect is of second order.)
    ///
    /// `None` at distance 0, where the distance has no derivative: it grows however touching primitives
    /// separate, and stays 0 while crossing ones move. Where several pairs of points are equally close
    /// (parallel edges), this is the derivative for the pair that was found; to first order, the distance
    /// then grows no faster than this.
    pub fn gradient(&self) -> Option<Gradient<A, B>> {
        let n = self.direction()?;
        Some(Gradient { by_a: self.on_a.map(|w| scale(n, -w)), by_b: self.on_b.map(|w| scale(n, w)) })
    }

    /// Exchanges the first and the second primitive.
    pub fn swapped(&self) -> Closest<B, A> {
        Closest {
            distance_squared: self.distance_squared,
            on_a: self.on_b,
            on_b: self.on_a,
            offset: sub([0.0; 3], self.offset),
        }
    }
}

impl Feature {
    /// The feature of a segment or triangle whose interior contains the point with these weights: a vertex,
    /// an edge or the face.
    pub fn of(weights: &[f64]) -> Self {
        let held = |i: &usize| weights[*i] != 0.0;
        let n_held = (0..weights.len()).filter(held).count();
        match (n_held, weights.len()) {
            (3, _) => Self::Face,
            (2, 2) => Self::Edge(0),
            (2, _) => Self::Edge((0..3).find(|i| !held(i)).unwrap_or(0) as u8),
            _ => Self::Vertex((0..weights.len()).find(held).unwrap_or(0) as u8),
        }
    }
}
