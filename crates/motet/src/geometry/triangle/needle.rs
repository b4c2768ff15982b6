//! The closest point of a triangle that is long and thin, has no area, or has a size whose powers leave the
//! range of `f64`.
//!
//! **Why needles do no harm.** The foot of the perpendicular is found by projecting on an edge and on a
//! direction at right angles to it, which is made orthogonal twice (the Gram-Schmidt process; Giraud, Langou
//! and Rozloznik 2005). Rounding may then change the weights considerably, but only along directions in which
//! the points hardly move: the *place* in the plane is accurate to a few roundings of the extent. If the
//! computed weights fall outside although the true ones do not, the way from the true place to the computed
//! one crosses an edge; so a point of that edge is just as close to the true place, and the edges are always
//! examined as well.

use crate::base::Point;
use crate::geometry::unit::unit_of;
use crate::geometry::vector::{across, add, dot, scale, sub};
use crate::geometry::{segment, triangle};

/// Returns the weights of the vertices that give the point of the triangle closest to `p`: the nearest among
/// the closest points of the edges and, where it lies inside, the foot of the perpendicular.
#[inline(never)]
pub(super) fn closest(triangle: [Point; 3], p: Point) -> [f64; 3] {
    let from_p = triangle.map(|x| sub(x, p));
    let (_, per_unit) = unit_of(from_p.as_flattened().iter());
    let local = from_p.map(|x| scale(x, per_unit));
    let on_edge = |i: usize, j: usize| {
        let t = segment::closest([local[i], local[j]], [0.0; 3]);
        let mut weights = [0.0; 3];
        (weights[i], weights[j]) = (1.0 - t, t);
        weights
    };
    let distance_squared = |weights: [f64; 3]| {
        let point = triangle::at(local, weights);
        dot(point, point)
    };
    let mut best = on_edge(0, 1);
    let mut least = distance_squared(best);
    for weights in [Some(on_edge(1, 2)), Some(on_edge(2, 0)), foot(local)].into_iter().flatten() {
        let found = distance_squared(weights);
        if found < least {
            (best, least) = (weights, found);
        }
    }
    best
}

/// Weights of the foot of the perpendicular from the origin, whose place is accurate to the last digits;
/// `None` when it lies outside or on an edge, or is undefined.
fn foot([a, b, c]: [Point; 3]) -> Option<[f64; 3]> {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let height = across(ac, ab);
    let of_c = -dot(a, height) / dot(height, height);
    let of_b = -dot(add(a, scale(ac, of_c)), ab) / dot(ab, ab);
    let weights = [1.0 - of_b - of_c, of_b, of_c];
    weights.iter().all(|w| (f64::MIN_POSITIVE..1.0).contains(w)).then_some(weights)
}
