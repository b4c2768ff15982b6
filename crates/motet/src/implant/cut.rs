//! Divides two surfaces where they meet, so that the line along which they meet consists of edges of both.
//!
//! Points nearer to each other than a fraction of the extent count as one ([`NEAR`]): coordinates that were
//! meant to be equal often are not.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::distance;
use crate::mesh::bounds;
use crate::preflight::cut::{self, Rule};

/// Points nearer to each other than this fraction of the largest extent of the first surface count as one.
const NEAR: f64 = 1e-11;

/// Two surfaces over one list of points, divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Cut {
    /// The given points, then new ones.
    pub(super) points: Vec<Point>,
    /// The pieces of each surface, oriented as it is, with the triangle that each is, or is a part of; in the
    /// order of those.
    pub(super) pieces: [Vec<([VertexId; 3], u32)>; 2],
    /// For each given point, the vertex that it is now.
    pub(super) names: Vec<VertexId>,
}

impl Cut {
    /// Divides `surfaces`, neither of which crosses itself. A vertex of the first that lies on one of the
    /// second becomes that one, which has the smaller id.
    ///
    /// # Errors
    /// When they come so close to each other that the result would cross itself.
    pub(super) fn new(points: &[Point], surfaces: [&[[VertexId; 3]]; 2], threads: &Threads) -> Result<Self> {
        let used: Vec<Point> = surfaces[0].as_flattened().iter().map(|v| points[v.index()]).collect();
        let near = bounds(&used).map_or(0.0, |[low, high]| distance(low, high) * NEAR);
        let n_first = surfaces[0].len();
        let group_of: Vec<u32> = (0..n_first + surfaces[1].len()).map(|t| u32::from(t >= n_first)).collect();
        let rule = Rule { group_of: &group_of, admits: &|g, h| g != h, near, crossings: true };
        let cut = cut::Cut::new(points, &surfaces.concat(), &rule, threads).ok_or_else(|| {
            Error::input(
                "surfaces come so close to each other, or cross at so small an angle, that they cannot be \
                 divided",
            )
            .remedy("move the device a little")
        })?;
        let (first, second): (Vec<_>, Vec<_>) =
            cut.pieces.into_iter().partition(|piece| (piece.1 as usize) < n_first);
        let second = second.into_iter().map(|(piece, t)| (piece, t - n_first as u32)).collect();
        Ok(Self { points: cut.points, pieces: [first, second], names: cut.vertex_to_kept })
    }
}
