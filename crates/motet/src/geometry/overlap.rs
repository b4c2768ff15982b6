//! The volume that two tets share, right to the last digits of the smaller one, slivers and shared facets included.
//!
//! The smaller tet is cut by the four planes of the larger one. No coordinates are cut: of each vertex only the four
//! *values* are kept, the determinants that say how far inside each plane it lies. They are linear in space, so a cut
//! interpolates them; the volumes of the pieces follow from where the edges are cut, as products of positive
//! numbers. So nothing cancels, and nothing becomes negative or NaN.
//!
//! ```text
//!   1 inside: a tet       2 inside: a prism        3 inside: a prism, (a b c) below (a' b' c')
//!      a                  between the triangles
//!     /|\                 a and b, each with the   A prism (p0 p1 p2) to (q0 q1 q2) is the tets
//!    x x x                two cuts of its edges    p0 p1 p2 q0, p1 p2 q0 q1 and p2 q0 q1 q2.
//! ```
//!
//! How good it is: the values are right to some roundings of the largest of the four at a plane (computed again
//! in pairs, or without rounding, where `f64` cannot say). A value that is off by a part `e` of the
//! largest moves at most a part `3 e` of the tet's volume across the plane, however thin either tet is.

use crate::base::Point;
use crate::geometry::predicates::{exact, orient, orient3d};
use crate::geometry::vector::is_finite;

/// Determinants are good enough when their error is below this part of the largest.
const GOOD: f64 = 1e-15;

/// A tet whose overlaps with others are asked for: its corners, and its volume right to the last digits.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    corners: [Point; 4],
    volume_6: f64,
}

impl Solid {
    /// The tet with these corners, in either orientation. One with a corner that is not finite counts as empty.
    pub fn new(corners: [Point; 4]) -> Self {
        let finite = corners.iter().all(|p| is_finite(*p));
        Self { corners, volume_6: if finite { accurate_volume_6(corners) } else { 0.0 } }
    }

    /// The corners.
    pub fn corners(&self) -> [Point; 4] {
        self.corners
    }

    /// The volume, never negative; 0 exactly where the corners lie in one plane.
    pub fn volume(&self) -> f64 {
        self.volume_6.abs() / 6.0
    }

    /// Whether the orientation is positive; exact.
    pub fn is_positive(&self) -> bool {
        self.volume_6 > 0.0
    }

    /// The volume that both have in common, in `[0, smaller volume]`. The error stays below `1e-14` of the smaller
    /// volume (typically a tenth of that), for sizes from 1e-80 to 1e60.
    pub fn overlap(&self, other: &Self) -> f64 {
        let (small, large) = if self.volume() <= other.volume() { (self, other) } else { (other, self) };
        if small.volume_6 == 0.0 {
            return 0.0;
        }
        match values(small.corners, large) {
            Some(values) => part_inside(&Piece { part: 1.0, values }, 0).min(1.0) * small.volume(),
            None => 0.0,
        }
    }
}

/// The volume that two tets have in common; see [`Solid::overlap`].
pub fn overlap(a: [Point; 4], b: [Point; 4]) -> f64 {
    Solid::new(a).overlap(&Solid::new(b))
}

/// Six times the signed volume, right to the last digits where it is more than 1e-30 of the tet's box; the sign is exact.
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

/// For each plane of `large` how far inside it each of the points lies, the farthest being 1 away; `None` when all
/// lie on or beyond one of the planes.
fn values(points: [Point; 4], large: &Solid) -> Option<[[f64; 4]; 4]> {
    let mut values = [[0.0; 4]; 4];
    for (plane, values) in values.iter_mut().enumerate() {
        let towards = points.map(|p| {
            let mut tet = large.corners;
            tet[plane] = p;
            tet
        });
        let determinants = determinants(towards);
        let largest = determinants.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        *values = determinants.map(|v| v / (largest * large.volume_6.signum()));
        // The negation also stops at NaN, from points so far apart that no determinant is finite.
        if !values.iter().any(|&v| v > 0.0) {
            return None;
        }
    }
    Some(values)
}

/// Determinants of four tets up to a common factor, right to [`GOOD`] of the largest.
fn determinants(tets: [[Point; 4]; 4]) -> [f64; 4] {
    for stage in [orient::with_bound, orient::in_pairs_with_bound] {
        let found = tets.map(stage);
        let largest = found.iter().fold(0.0, |m: f64, v| m.max(v.0.abs()));
        if found.iter().all(|v| v.1 <= GOOD * largest) {
            return found.map(|v| v.0);
        }
    }
    exact::orient3d_ratios(tets)
}

/// A tet cut out of the smaller one.
struct Piece {
    /// Its part of the smaller tet's volume.
    part: f64,
    /// For each plane how far inside it each corner lies.
    values: [[f64; 4]; 4],
}

/// A corner of a piece within another: the point with `weights` on the edge `ends`.
#[derive(Clone, Copy)]
struct Corner {
    ends: [usize; 2],
    weights: [f64; 2],
}

/// The part of `piece` that lies inside `plane` and all that follow.
fn part_inside(piece: &Piece, plane: usize) -> f64 {
    let Some(values) = piece.values.get(plane) else { return piece.part };
    if values.iter().all(|&v| v >= 0.0) {
        return part_inside(piece, plane + 1);
    }
    let (mut inside, mut outside) = ([0; 4], [0; 4]);
    let (mut n_inside, mut n_outside) = (0, 0);
    for (i, &value) in values.iter().enumerate() {
        let (list, n) =
            if value > 0.0 { (&mut inside, &mut n_inside) } else { (&mut outside, &mut n_outside) };
        list[*n] = i;
        *n += 1;
    }
    let cut = |i: usize, j: usize| {
        let length = values[i] - values[j];
        Corner { ends: [i, j], weights: [-values[j] / length, values[i] / length] }
    };
    let below = |part: f64, corners: [Corner; 4]| {
        if part == 0.0 { 0.0 } else { part_inside(&piece.sub(part, corners), plane + 1) }
    };
    match n_inside {
        0 => 0.0,
        1 => {
            let a = inside[0];
            let [x, y, z] = [0, 1, 2].map(|k| cut(a, outside[k]));
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

/// A corner that stays.
fn whole(i: usize) -> Corner {
    Corner { ends: [i, i], weights: [1.0, 0.0] }
}

impl Piece {
    /// The tet between `corners`, which makes up `part` of this one.
    fn sub(&self, part: f64, corners: [Corner; 4]) -> Self {
        let at = |values: [f64; 4]| {
            corners.map(|c| values[c.ends[0]] * c.weights[0] + values[c.ends[1]] * c.weights[1])
        };
        Self { part: self.part * part, values: self.values.map(at) }
    }
}
