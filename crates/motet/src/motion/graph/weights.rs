//! Four weights with which a point moves with its graph tet.
//!
//! A Delaunay graph of boundary vertices is full of slivers: four vertices on a sphere, or on a wall, are
//! nearly or exactly coplanar. In a sliver of height `h` and length `l` a weight that is computed from
//! rounded volumes is off by `eps l / h`, which may be anything. So the volumes of flat tets are computed
//! exactly. Where that does not decide either (no volume at all, or a point outside), the point gets the
//! weights of the nearest place on the tet's surface.
//!
//! Other tets use rounded volumes that share their products, checked by where they put the point: the weights
//! of 139,000 vertices of a sphere in a box take 65 ms in this way, and 94 ms by [`geometry::weights`] alone.

use crate::base::Point;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::geometry::{self, tet, triangle};

/// Below this fraction of `length^3` a volume from rounded products is not trusted: its error, some 1e-15 of
/// `length^3`, would show in the weights as 1e-9.
const MIN_RELATIVE_VOLUME: f64 = 1e-6;

/// How far from the point, relative to the tet's length, the weights may put it.
const MAX_OFFSET: f64 = 2e-15;

/// Weights in [0, 1] whose sum is 1 and for which `sum w_i x_i` is `p`, for a point `p` of the tet `x`.
///
/// For a point outside the tet, they are those of the nearest point on its surface.
pub(crate) fn weights(p: Point, x: [Point; 4]) -> [f64; 4] {
    let e = x.map(|x| sub(x, p));
    let length = e.iter().map(|&e| norm(e)).fold(0.0, f64::max);
    if length == 0.0 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let good = |w: &[f64; 4]| norm(combine(*w, e)) <= MAX_OFFSET * length;
    let volumes = rounded_volumes(e);
    let sum: f64 = volumes.iter().sum();
    if sum > MIN_RELATIVE_VOLUME * length * length * length
        && let Some(w) = shares(volumes).filter(good)
    {
        return w;
    }
    geometry::weights(x, p).map(sum_to_one).filter(good).unwrap_or_else(|| nearest_on_surface(e))
}

/// `sum w_i e_i`
fn combine(w: [f64; 4], e: [Point; 4]) -> Point {
    (0..4).fold([0.0; 3], |s, i| add(s, scale(e[i], w[i])))
}

/// Six times the volumes of the four tets between `p`, the origin of `e`, and the facets.
fn rounded_volumes(e: [Point; 4]) -> [f64; 4] {
    let (ab, cd) = (cross(e[0], e[1]), cross(e[2], e[3]));
    [dot(e[1], cd), -dot(e[0], cd), dot(e[3], ab), -dot(e[2], ab)]
}

/// Volumes as fractions of their sum; small negative ones, due to rounding, count as 0.
fn shares(volumes: [f64; 4]) -> Option<[f64; 4]> {
    let volumes = volumes.map(|v| v.max(0.0));
    let sum: f64 = volumes.iter().sum();
    (sum > 0.0 && sum.is_finite()).then(|| sum_to_one(volumes.map(|v| v / sum)))
}

/// Makes the first weight 1 less the other three, so that three need to be stored; it must not fall below 0
/// by rounding.
fn sum_to_one(mut w: [f64; 4]) -> [f64; 4] {
    let rest = |w: &[f64; 4]| 1.0 - w[1] - w[2] - w[3];
    while rest(&w) < 0.0 {
        let largest = (1..4).fold(1, |i, j| if w[j] > w[i] { j } else { i });
        w[largest] = (w[largest] + rest(&w)).min(w[largest].next_down()).max(0.0);
    }
    w[0] = rest(&w);
    w
}

/// Weights of the point nearest to the origin on any facet of the tet `e`.
fn nearest_on_surface(e: [Point; 4]) -> [f64; 4] {
    let on_facets = tet::FACETS.map(|facet| {
        let on_facet = triangle::closest(facet.map(|i| e[i]), [0.0; 3]);
        let mut w = [0.0; 4];
        facet.iter().zip(on_facet).for_each(|(&i, part)| w[i] = part);
        sum_to_one(w)
    });
    let distance = |w: &[f64; 4]| norm(combine(*w, e));
    on_facets
        .into_iter()
        .fold([1.0, 0.0, 0.0, 0.0], |best, w| if distance(&w) < distance(&best) { w } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::distance;
    use proptest::prelude::*;

    const REGULAR: [Point; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn holds(p: Point, x: [Point; 4], off: f64) {
        let w = weights(p, x);
        assert!(w.iter().all(|w| (0.0..=1.0).contains(w)), "{w:?}");
        assert_eq!(1.0 - w[1] - w[2] - w[3], w[0]);
        assert!((w.iter().sum::<f64>() - 1.0).abs() <= 4.0 * f64::EPSILON, "{w:?}");
        assert!(distance(combine(w, x), p) <= off, "{w:?} {:?} {p:?}", combine(w, x));
    }

    #[test]
    fn a_corner_has_its_own_weight_alone() {
        for (i, &corner) in REGULAR.iter().enumerate() {
            assert_eq!(weights(corner, REGULAR), [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
        }
    }

    #[test]
    fn weights_of_a_flat_tet_and_of_a_point_tet_hold() {
        let kite = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        holds([0.3, 0.6, 0.0], kite, 1e-15);
        holds([0.5, 0.5, 0.0], kite, 1e-15);
        let line = [[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [5.0, 5.0, 5.0]];
        holds([1.7, 1.7, 1.7], line, 1e-15);
        holds([2.0, 2.0, 2.0], [[2.0, 2.0, 2.0]; 4], 0.0);
    }

    #[test]
    fn a_point_outside_takes_the_nearest_place_of_the_tet() {
        assert_eq!(weights([0.25, 0.25, -1.0], REGULAR), [0.5, 0.25, 0.25, 0.0]);
        assert_eq!(weights([-1.0, -1.0, -1.0], REGULAR), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(weights([0.5, -1.0, -3.0], REGULAR), [0.5, 0.5, 0.0, 0.0]);
    }

    #[test]
    fn doubled_volumes_tell_what_rounded_ones_cannot() {
        // A kite of height 1e-13: the crossing of its diagonals lies half a height above one of them.
        let h = 1e-13;
        let kite = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, h], [1.0, 0.0, h]];
        let w = weights([0.5, 0.5, 0.25 * h], kite);
        for (w, expected) in w.iter().zip([0.375, 0.375, 0.125, 0.125]) {
            assert!((w - expected).abs() < 1e-12, "{w} {expected}");
        }
    }

    fn point() -> impl Strategy<Value = Point> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0f64].prop_map(|p: [f64; 3]| p)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn weights_reproduce_the_point_however_flat_the_tet(
            x in [point(), point(), point(), point()],
            parts in [0.0..1.0f64, 0.0..1.0, 0.0..1.0, 0.0..1.0],
            flat in 0..20i32,
            shift in -1e3..1e3f64,
        ) {
            let h = 10f64.powi(-flat);
            let mut x = x.map(|p| [p[0] + shift, p[1] - shift, p[2] * h + p[0] + p[1]]);
            if dot(cross(sub(x[1], x[0]), sub(x[2], x[0])), sub(x[3], x[0])) < 0.0 {
                x.swap(2, 3);
            }
            let total: f64 = parts.iter().sum();
            prop_assume!(total > 0.1);
            let p = combine(parts.map(|w| w / total), x);
            // The point itself is rounded to the last place of its coordinates.
            holds(p, x, 1e-15 * (4.0 + shift.abs()) + 1e-14);
        }
    }
}
