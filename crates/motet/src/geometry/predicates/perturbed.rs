//! Ties broken symbolically: every point is lifted by an infinitesimal of its own.
//!
//! With all points lifted onto a paraboloid in four dimensions, the in-sphere test determines on which side
//! of a hyperplane a point lies. If the point of rank k is lifted further by an infinitesimal like e^(1/k),
//! the one of highest rank by the most, no five points are cospherical any more, and answers stay consistent
//! from call to call (Devillers and Teillaud 2011, *Perturbations for Delaunay and weighted Delaunay 3D
//! triangulations*). No orientation changes, so no flat tet becomes solid, and none arises.

use super::{insphere, orient3d};
use crate::base::Point;

/// [`insphere`] with ties broken by `ranks`, so that the result is never 0: whether point 4 lies inside (1)
/// or outside (-1) the sphere through the *positively oriented* tet of points 0 to 3.
///
/// Both points and ranks must be distinct; the result depends only on the order of the ranks.
pub fn insphere_perturbed(points: [Point; 5], ranks: [u32; 5]) -> i8 {
    let [a, b, c, d, e] = points;
    match insphere(a, b, c, d, e) {
        0 => break_tie(points, ranks),
        sign => sign,
    }
}

/// The result for five points known to be cospherical.
pub(crate) fn break_tie(points: [Point; 5], ranks: [u32; 5]) -> i8 {
    break_tie_of(points, ranks, |[a, b, c, d]| orient3d(a, b, c, d))
}

/// [`break_tie`] for points of any kind. Raising the query puts it outside; raising vertex v puts the query
/// inside when it lies on the same side of v's facet as v.
pub(crate) fn break_tie_of<P: Copy>(points: [P; 5], ranks: [u32; 5], orient3d: impl Fn([P; 4]) -> i8) -> i8 {
    let mut by_rank = [0, 1, 2, 3, 4];
    by_rank.sort_unstable_by_key(|&i| std::cmp::Reverse(ranks[i]));
    for i in by_rank {
        if i == 4 {
            return -1;
        }
        let mut tet = [points[0], points[1], points[2], points[3]];
        tet[i] = points[4];
        let sign = orient3d(tet);
        if sign != 0 {
            return sign;
        }
    }
    -1
}
