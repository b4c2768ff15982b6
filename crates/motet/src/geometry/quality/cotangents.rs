//! Cotangents of the angles of a tet: in [0, pi] they fall as the angle rises, so the extreme angles are
//! found among them before any arctangent is taken.

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{cross, dot, sub};

/// The angle in [0, pi] with this cotangent.
#[inline]
pub(super) fn angle(cotangent: f64) -> f64 {
    1f64.atan2(cotangent)
}

/// The smallest and the largest of some cotangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extremes {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Extremes {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    /// Includes `x`, which must be a number: plain comparisons save the handling of NaN in `f64::min`.
    #[inline(always)]
    fn add(&mut self, x: f64) {
        self.low = if x < self.low { x } else { self.low };
        self.high = if x > self.high { x } else { self.high };
    }
}

/// Cotangent from cosine and sine, both up to one positive factor. 0/0, an angle at something without extent,
/// counts as angle 0.
#[inline(always)]
fn ratio(cosine: f64, sine: f64) -> f64 {
    let cotangent = cosine / sine;
    if cotangent.is_nan() { f64::INFINITY } else { cotangent }
}

/// `x |x|`: has the order of x, and saves square roots until the extremes are known.
#[inline(always)]
fn signed_square(x: f64) -> f64 {
    x * x.abs()
}

#[inline(always)]
fn signed_root(x: f64) -> f64 {
    x.abs().sqrt().copysign(x)
}

/// The measured parts of a tet: the squared lengths of its edges, twice the area vector of each facet
/// (outward for a positive tet), and six times the absolute volume.
///
/// Loops instead of closures over arrays, always inlined: this halves the number of instructions.
pub(super) struct Parts {
    /// Squared lengths of the edges, in the order of [`EDGES`].
    lengths_squared: [f64; 6],
    normals: [Point; 4],
    volume_6: f64,
}

impl Parts {
    #[inline(always)]
    pub(super) fn of(tet: &Scaled) -> Self {
        let [a, b, c, d] = tet.points;
        let edges = [sub(b, a), sub(c, a), sub(d, a), sub(c, b), sub(d, b), sub(d, c)];
        let mut lengths_squared = [0.0; 6];
        for e in 0..6 {
            lengths_squared[e] = dot(edges[e], edges[e]);
        }
        // Facet i as in `FACETS`: (b, c, d), (a, d, c), (a, b, d), (a, c, b).
        let normals = [
            cross(edges[3], edges[4]),
            cross(edges[2], edges[1]),
            cross(edges[0], edges[2]),
            cross(edges[1], edges[0]),
        ];
        Self { lengths_squared, normals, volume_6: tet.volume_6().abs() }
    }

    /// Returns `-m.n` at the edge e between facets with normals m and n, to which the cosine of the dihedral
    /// angle is proportional. The sine is proportional to `|m x n|`, and `m x n` is e times six volumes: this
    /// is accurate where m and n are nearly parallel and the cosine carries no information.
    #[inline(always)]
    fn dihedral_cosine(&self, e: usize) -> f64 {
        let [i, j] = EDGES[5 - e];
        -dot(self.normals[i], self.normals[j])
    }

    /// Cotangents of the dihedral angles at the six edges, in the order of [`EDGES`]. An inverted tet has
    /// those of its mirror image.
    pub(super) fn dihedral(&self) -> [f64; 6] {
        [0, 1, 2, 3, 4, 5]
            .map(|e| ratio(self.dihedral_cosine(e), self.volume_6 * self.lengths_squared[e].sqrt()))
    }

    /// The smallest and the largest of [`Self::dihedral`].
    #[inline(always)]
    pub(super) fn dihedral_extremes(&self) -> Extremes {
        let mut extremes = Extremes::NONE;
        if self.volume_6 == 0.0 {
            self.dihedral().into_iter().for_each(|cotangent| extremes.add(cotangent));
            return extremes;
        }
        for e in 0..6 {
            extremes.add(ratio(signed_square(self.dihedral_cosine(e)), self.lengths_squared[e]));
        }
        Extremes {
            low: signed_root(extremes.low) / self.volume_6,
            high: signed_root(extremes.high) / self.volume_6,
        }
    }
}
