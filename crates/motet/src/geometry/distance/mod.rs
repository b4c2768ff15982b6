//! How far points, segments and triangles are apart: the distance, the closest points, the feature each lies on, the derivative.
//!
//! One pair of primitives a file; every one has `closest`, which gives a [`Closest`].
//!
//! **How good it is.** The closest points are points of the primitives, given by weights in [0, 1]; the distance is that of these
//! points, so it is never too small by more than rounding. It is too large by at most some 1e-15 of the *extent*, the size of
//! both primitives together, whatever their shape: needles, parallel edges, segments and triangles that are points. (Of 20,000 hard
//! pairs of each kind the worst was off by 3.4e-16 of it; `tests/distance.rs` prints it.)
//! There is no tolerance in units of length. Coordinates are taken relative to one of the points and in units of
//! a power of two near the extent, so nothing depends on the unit of length, nor on where the origin lies; sizes from 1e-150 to
//! 1e150 will do. Coordinates must be finite.
//!
//! **Why needles and parallel edges do no harm.** The point within a face is found as [`triangle::closest`](super::triangle::closest)
//! finds it, and the pair of points within two edges in the same way: by projecting on one direction and on what is at right
//! angles to it, projected twice (the Gram-Schmidt process; Giraud,
//! Langou and Rozloznik 2005). Rounding may then shift the weights by much, but only along directions in which the
//! points hardly move: the *place* in the plane of both directions is right to some roundings of the extent. If the weights
//! fall outside although the true ones do not, then on the way from the true place to the computed one a border is crossed; so
//! there is a point of the border that close to the true place, and the borders are always looked at as well.

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
    /// The distance, squared.
    pub distance_squared: f64,
    /// Weights of the vertices of the first primitive that give its closest point: each in [0, 1], their sum 1 up to rounding.
    pub on_a: [f64; A],
    /// The same for the second.
    pub on_b: [f64; B],
    /// From the closest point of the first to that of the second.
    pub offset: Point,
}

/// The least part of a primitive that holds a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// The vertex with this local number.
    Vertex(u8),
    /// The inside of an edge: of a triangle the one opposite this vertex, of a segment edge 0.
    Edge(u8),
    /// The inside of the triangle.
    Face,
}

/// What the distance gains by the motion of each vertex: its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<const A: usize, const B: usize> {
    /// By the vertices of the first primitive.
    pub by_a: [Point; A],
    /// By the vertices of the second.
    pub by_b: [Point; B],
}

impl<const A: usize, const B: usize> Closest<A, B> {
    /// The distance.
    pub fn distance(&self) -> f64 {
        self.distance_squared.sqrt()
    }

    /// Which features of the first and of the second primitive hold the closest points: those whose vertices have weights
    /// other than 0.
    pub fn features(&self) -> [Feature; 2] {
        [Feature::of(&self.on_a), Feature::of(&self.on_b)]
    }

    /// The unit vector from the first closest point to the second; `None` at distance 0.
    ///
    /// It is as good as the distance: where that is within rounding of 0, the direction is rounding too.
    pub fn direction(&self) -> Option<Point> {
        let largest = self.offset.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        // Divided, not multiplied by the inverse: that of the smallest numbers is infinite.
        let offset = self.offset.map(|x| x / largest);
        (self.distance_squared > 0.0 && largest > 0.0)
            .then(|| scale(offset, 1.0 / dot(offset, offset).sqrt()))
    }

    /// The derivative of the distance by every vertex: with the unit vector `n` from the first closest point to the
    /// second, `-w n` for a vertex of the first with weight `w`, and `w n` for one of the second. (The weights change
    /// too when a vertex moves, but at a smallest distance that is of second order.)
    ///
    /// `None` at distance 0, where the distance has no derivative: it grows in whichever way touching primitives part, and stays 0 while crossing
    /// ones move. Where several pairs of points are equally close (parallel edges), this is the derivative for
    /// the pair that was found; the distance then grows no faster than it says, to first order.
    pub fn gradient(&self) -> Option<Gradient<A, B>> {
        let n = self.direction()?;
        Some(Gradient { by_a: self.on_a.map(|w| scale(n, -w)), by_b: self.on_b.map(|w| scale(n, w)) })
    }

    /// The same with first and second exchanged.
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
    /// The feature of a segment or triangle that holds the inside point with these weights: a vertex, an edge or the face.
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
