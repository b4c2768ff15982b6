//! Two surfaces divided where they meet, so that the line where they do is made of edges of both.
//!
//! What is nearer than a share of the extent counts as one place ([`NEAR`]): coordinates that were meant to be equal as a rule are not.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::distance;
use crate::mesh::bounds;
use crate::preflight::cut::{self, Rule};

/// What is nearer than this part of the largest extent of the first surface is one place.
const NEAR: f64 = 1e-11;

/// Two surfaces over one list of points, divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Cut {
    /// The points as they were given, then new ones.
    pub(super) points: Vec<Point>,
    /// The pieces of each surface, turned as it is, and the triangle that each is or is a part of; in the order of those.
    pub(super) pieces: [Vec<([VertexId; 3], u32)>; 2],
    /// The vertex that each given point is now.
    pub(super) names: Vec<VertexId>,
}

impl Cut {
    /// Divides `surfaces`, neither of which crosses itself. A vertex of the first that lies on one of the second becomes that, which has the smaller id.
    ///
    /// # Errors
    /// When they come so close to each other that what comes of it would cross itself.
    pub(super) fn new(points: &[Point], surfaces: [&[[VertexId; 3]]; 2], threads: &Threads) -> Result<Self> {
        let used: Vec<Point> = surfaces[0].as_flattened().iter().map(|v| points[v.index()]).collect();
        let near = bounds(&used).map_or(0.0, |[low, high]| distance(low, high) * NEAR);
        let n_first = surfaces[0].len();
        let group_of: Vec<u32> = (0..n_first + surfaces[1].len()).map(|t| u32::from(t >= n_first)).collect();
        let rule = Rule { group_of: &group_of, admits: &|g, h| g != h, near, crossings: true };
        let cut = cut::Cut::new(points, &surfaces.concat(), &rule, threads).ok_or_else(|| {
            Error::input("surfaces come so close to each other, or cross at so small an angle, that they cannot be divided")
                .remedy("move the device a little")
        })?;
        let (first, second): (Vec<_>, Vec<_>) =
            cut.pieces.into_iter().partition(|piece| (piece.1 as usize) < n_first);
        let second = second.into_iter().map(|(piece, t)| (piece, t - n_first as u32)).collect();
        Ok(Self { points: cut.points, pieces: [first, second], names: cut.names })
    }
}
