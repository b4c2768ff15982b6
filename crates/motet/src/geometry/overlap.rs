//! The volume shared by two tets, accurate to the last digits of the smaller one, including slivers and
//! shared facets.
//!
//! The smaller tet is cut by the four planes of the larger one. No coordinates are computed: each vertex is
//! represented by four *values*, the determinants that give its distance inside each plane. They are linear
//! in space, so a cut interpolates them; the volumes of the pieces follow from where the edges are cut, as
//! products of positive numbers. So nothing cancels, and nothing becomes negative or NaN.
//!
//! ```text
//!   1 inside: a tet       2 inside: a prism        3 inside: a prism, (a b c) below (a' b' c')
//!      a                  between the triangles
//!     /|\                 a and b, each with the   A prism (p0 p1 p2) to (q0 q1 q2) is the tets
//!    x x x                two cuts of its edges    p0 p1 p2 q0, p1 p2 q0 q1 and p2 q0 q1 q2.
//! ```
//!
//! Accuracy: the values are accurate to a few roundings of the largest of the four at a plane (recomputed in
//! pairs, or without rounding, where `f64` cannot decide). A value that is off by a fraction `e` of the
//! largest moves at most a fraction `3 e` of the tet's volume across the plane, however thin either tet is.

use crate::base::Point;
use crate::geometry::predicates::{exact, orient, orient3d};
use crate::geometry::tet::FACETS;
use crate::geometry::vector::is_finite;

/// Determinants are accurate enough when their error bound is below this fraction of the largest; the error
/// itself is about a tenth of the bound. Between two Delaunay meshes of random points 99 planes in 100 pass
/// in `f64`; at 1e-15 hardly any did, which took three times as long.
const GOOD: f64 = 1e-14;

/// A tet prepared for computing overlaps: its corners, and its volume, accurate to the last digits.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    corners: [Point; 4],
    volume_6: f64,
}

impl Solid {
    /// Makes a solid of the tet with these corners, in either orientation. A tet with a corner that is not
    /// finite counts as empty.
    pub fn new(corners: [Point; 4]) -> Self {
        let finite = corners.iter().all(|p| is_finite(*p));
        Self { corners, volume_6: if finite { accurate_volume_6(corners) } else { 0.0 } }
    }

    /// The corners.
    pub fn corners(&self) -> [Point; 4] {
        self.corners
    }

    /// The volume, never negative; 0 exactly where the corners are coplanar.
    pub fn volume(&self) -> f64 {
        self.volume_6.abs() / 6.0
    }

    /// Whether the orientation is positive. The answer is exact.
    pub fn is_positive(&self) -> bool {
        self.volume_6 > 0.0
    }

    /// The volume that both solids have in common, in `[0, smaller volume]`. The error stays below `1e-14` of
    /// the smaller volume (typically a tenth of that), for sizes from 1e-80 to 1e60.
    pub fn overlap(&self, other: &Self) -> f64 {
        let (small, large) = if self.volume() <= other.volume() { (self, other) } else { (other, self) };
        if small.volume_6 == 0.0 {
            return 0.0;
        }
        let mut values = [[0.0; 4]; 4];
        match cutting_planes(small.corners, large, &mut values) {
            Some(n) => part_inside(1.0, &values[..n]).min(1.0) * small.volume(),
            None => 0.0,
        }
    }

    /// Returns [`Self::overlap`]; `None` where it is no more than rounding, as for tets that touch.
    pub fn real_overlap(&self, other: &Self) -> Option<f64> {
        let overlap = self.overlap(other);
        (overlap > TOUCH * self.volume().min(other.volume())).then_some(overlap)
    }
}

/// An overlap below this fraction of the smaller tet is rounding: the tets only touch.
const TOUCH: f64 = 1e-14;

/// The volume that two tets have in common; see [`Solid::overlap`].
pub fn overlap(a: [Point; 4], b: [Point; 4]) -> f64 {
    Solid::new(a).overlap(&Solid::new(b))
}

/// Six times the signed volume, accurate to the last digits where it is more than 1e-30 of the tet's box; the
/// sign is exact.
fn accurate_volume_6(tet: [Point; 4]) -> f64 {
    let (value, error) = orient::with_bound(tet);
    if error <= GOOD * value.abs() {
        return value;
    }
    let (value, error) = orient::in_pairs_with_bound(tet);
    if error < value.abs() {
        return value;
    }
    let [a, b, c, d] = tet;
    let size = if value.is_finite() { value.abs().max(f64::MIN_POSITIVE) } else { 0.0 };
    f64::from(orient3d(a, b, c, d)) * size
}

/// Computes, for each plane of `large` that leaves out some of the points, how far inside it each point lies;
/// these are written to `values`, and their number is returned. `None` when all points lie on or beyond one
/// of the planes.
fn cutting_planes(points: [Point; 4], large: &Solid, values: &mut [[f64; 4]; 4]) -> Option<usize> {
    let inward = -large.volume_6.signum();
    let mut n = 0;
    for [i, j, k] in FACETS {
        let facet = [large.corners[i], large.corners[j], large.corners[k]];
        let [a, b, c, d] = determinants(facet, points);
        let found = [inward * a, inward * b, inward * c, inward * d];
        // The negation also stops at NaN, from points so far apart that no determinant is finite.
        if !found.iter().any(|&v| v > 0.0) {
            return None;
        }
        values[n] = found;
        n += usize::from(found.iter().any(|&v| v < 0.0));
    }
    Some(n)
}

/// The signed distance of each point from a facet's plane, up to a common factor: accurate to [`GOOD`] of the
/// largest. What may be 0 is 0.
fn determinants(facet: [Point; 3], [a, b, c, d]: [Point; 4]) -> [f64; 4] {
    let plane = orient::Plane::new(facet);
    let found = [plane.with_bound(a), plane.with_bound(b), plane.with_bound(c), plane.with_bound(d)];
    good(found).unwrap_or_else(|| accurate_determinants(facet, [a, b, c, d]))
}

/// [`determinants`] where `f64` cannot decide.
#[cold]
#[inline(never)]
fn accurate_determinants([a, b, c]: [Point; 3], points: [Point; 4]) -> [f64; 4] {
    let tets = points.map(|p| [a, b, c, p]);
    good(tets.map(orient::in_pairs_with_bound)).unwrap_or_else(|| exact::orient3d_ratios(tets))
}

/// The determinants, if their error bounds show that they are accurate enough.
#[inline(always)]
fn good(found: [(f64, f64); 4]) -> Option<[f64; 4]> {
    let (mut largest, mut bound) = (0.0, 0.0);
    let mut values = [0.0; 4];
    for (value, (determinant, error)) in values.iter_mut().zip(found) {
        largest = determinant.abs().max(largest);
        bound = error.max(bound);
        *value = if determinant.abs() > error { determinant } else { 0.0 };
    }
    (bound <= GOOD * largest && largest < f64::INFINITY).then_some(values)
}

/// A corner of a piece of a tet: the point with `weights` on the edge `ends`.
#[derive(Clone, Copy)]
struct Corner {
    ends: [usize; 2],
    weights: [f64; 2],
}

/// Corner `i` of the tet itself.
fn whole(i: usize) -> Corner {
    Corner { ends: [i, i], weights: [1.0, 0.0] }
}

/// The volume inside all planes, if the whole tet counts as `part`; `planes` holds for each plane how far
/// inside it each corner lies.
fn part_inside(part: f64, planes: &[[f64; 4]]) -> f64 {
    let Some((values, others)) = planes.split_first() else { return part };
    let (mut inside, mut outside) = ([0; 4], [0; 4]);
    let (mut n_inside, mut n_outside) = (0, 0);
    for (i, &value) in values.iter().enumerate() {
        // Written to both, counted in one: which one is unpredictable.
        (inside[n_inside], outside[n_outside]) = (i, i);
        n_inside += usize::from(value > 0.0);
        n_outside += usize::from(value <= 0.0);
    }
    if values.iter().all(|&v| v >= 0.0) {
        return part_inside(part, others);
    }
    let cut = |i: usize, j: usize| {
        let length = values[i] - values[j];
        Corner { ends: [i, j], weights: [-values[j] / length, values[i] / length] }
    };
    let below = |of_part: f64, corners: [Corner; 4]| piece(part * of_part, corners, others);
    match n_inside {
        0 => 0.0,
        1 => {
            let a = inside[0];
            let [x, y, z] = [cut(a, outside[0]), cut(a, outside[1]), cut(a, outside[2])];
            below(x.weights[1] * y.weights[1] * z.weights[1], [whole(a), x, y, z])
        }
        2 => {
            let [a, b, c, d] = [inside[0], inside[1], outside[0], outside[1]];
            let [p1, p2, q1, q2] = [cut(a, c), cut(a, d), cut(b, c), cut(b, d)];
            below(p1.weights[1] * p2.weights[1], [whole(a), p1, p2, whole(b)])
                + below(p1.weights[0] * p2.weights[1] * q1.weights[1], [p1, p2, whole(b), q1])
                + below(p2.weights[0] * q1.weights[1] * q2.weights[1], [p2, whole(b), q1, q2])
        }
        _ => {
            let [a, b, c, d] = [inside[0], inside[1], inside[2], outside[0]];
            let [q0, q1, q2] = [cut(a, d), cut(b, d), cut(c, d)];
            below(q0.weights[1], [whole(a), whole(b), whole(c), q0])
                + below(q0.weights[0] * q1.weights[1], [whole(b), whole(c), q0, q1])
                + below(q0.weights[0] * q1.weights[0] * q2.weights[1], [whole(c), q0, q1, q2])
        }
    }
}

/// [`part_inside`] for the tet between `corners`.
fn piece(part: f64, corners: [Corner; 4], planes: &[[f64; 4]]) -> f64 {
    if part == 0.0 || planes.is_empty() {
        return part;
    }
    let mut values = [[0.0; 4]; 3];
    for (new, old) in values.iter_mut().zip(planes) {
        let mut n_inside = 0;
        for (new, corner) in new.iter_mut().zip(&corners) {
            let ([i, j], weights) = (corner.ends, corner.weights);
            // Indices are below 4; the mask makes this known to the compiler.
            *new = old[i & 3] * weights[0] + old[j & 3] * weights[1];
            n_inside += usize::from(*new > 0.0);
        }
        if n_inside == 0 {
            return 0.0;
        }
    }
    part_inside(part, &values[..planes.len()])
}
