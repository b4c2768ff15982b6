//! Equi-angle skew: how far the worst angle is from that of the regular tet.
//!
//! Four angles are computed at a time, which takes little more than half the time of one by one.
//!
//! ```text
//!   lane   facet    one side   another   the third
//!    0     b c d      bc         bd         cd     Sides go from the first end to the second;
//!    1     a d c      ad         ac         cd     the normal, one side cross another, points outward.
//!    2     a b d      ab         ad         bd
//!    3     a c b      ac         ab         bc
//! ```

use std::f64::consts::{FRAC_PI_3, PI};

use pulp::NullaryFnOnce;

use crate::base::Point;
use crate::base::four::{FourLanes, FourVectors, Plain, cross, dot, sub};
#[cfg(target_arch = "x86_64")]
use crate::base::four::{Wide, wide_machine};
use crate::geometry::quality::angles::angles;
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::quality::scaled::Scaled;

/// Verdict's `tet_equiangle_skew`, over the 6 dihedral and the 12 face angles: 0 for the regular tet, 1 for a
/// degenerate one, in either orientation.
///
/// `max of (Dmax - T)/(pi - T), (T - Dmin)/T, (Fmax - pi/3)/(2 pi/3), (pi/3 - Fmin)/(pi/3)`
/// with `T = acos(1/3)`.
pub fn equiangle_skew(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    skew(&tet, tet.volume_6())
}

/// The skew of a tet with this volume.
#[inline]
pub(super) fn skew(tet: &Scaled, volume_6: f64) -> f64 {
    // Then all dihedral angles are 0 or pi.
    if volume_6 == 0.0 {
        return 1.0;
    }
    let points = tet.points;
    #[cfg(target_arch = "x86_64")]
    if let Some(machine) = wide_machine() {
        return machine.vectorize(Skew::<Wide> { machine, points, volume_6 });
    }
    Skew::<Plain> { machine: (), points, volume_6 }.call()
}

struct Skew<F: FourLanes> {
    machine: F::Machine,
    points: [Point; 4],
    volume_6: f64,
}

impl<F: FourLanes> NullaryFnOnce for Skew<F> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        by_four::<F>(self.machine, self.points, self.volume_6)
    }
}

/// The skew, computed in four lanes; see the top of the file.
#[inline(always)]
fn by_four<F: FourLanes>(machine: F::Machine, [a, b, c, d]: [Point; 4], volume_6: f64) -> f64 {
    let from = vectors::<F>(machine, [b, a, a, a]);
    let one = sub(vectors::<F>(machine, [c, d, b, c]), from);
    let another = sub(vectors::<F>(machine, [d, c, d, b]), from);
    let third = sub(vectors::<F>(machine, [d, d, d, c]), vectors::<F>(machine, [c, c, b, b]));
    let normals = cross(one, another);

    // The extreme cotangents of the angles of each facet, and then of all four facets.
    let p = dot(one, third) * F::load(machine, &[-1.0, 1.0, -1.0, 1.0]);
    let q = dot(another, third) * F::load(machine, &[1.0, -1.0, 1.0, -1.0]);
    let r = dot(one, another);
    let sine = dot(normals, normals);
    let low = ratio::<F>(machine, signed_square(p.min(q).min(r)), sine).min_lane();
    let high = ratio::<F>(machine, signed_square(p.max(q).max(r)), sine).max_lane();

    // The dihedral angles at one side of each facet, then those at the third sides.
    let stored = [normals[0].stored(), normals[1].stored(), normals[2].stored()];
    let at_one = cosine::<F>(machine, &stored, [0, 1, 2, 1], [3, 2, 3, 3]);
    let at_one = ratio::<F>(machine, signed_square(at_one), dot(one, one));
    let at_third = cosine::<F>(machine, &stored, [0, 0, 0, 0], [1, 1, 2, 3]);
    let at_third = ratio::<F>(machine, signed_square(at_third), dot(third, third));
    let squares = [at_one.min(at_third).min_lane(), at_one.max(at_third).max_lane(), low, high];
    worst::<F>(machine, squares, volume_6.abs())
}

#[inline(always)]
fn vectors<F: FourLanes>(machine: F::Machine, [a, b, c, d]: [Point; 4]) -> FourVectors<F> {
    [
        F::load(machine, &[a[0], b[0], c[0], d[0]]),
        F::load(machine, &[a[1], b[1], c[1], d[1]]),
        F::load(machine, &[a[2], b[2], c[2], d[2]]),
    ]
}

/// Gathers four vectors by their indices.
#[inline(always)]
fn picked<F: FourLanes>(
    machine: F::Machine,
    [x, y, z]: &[[f64; 4]; 3],
    [i, j, k, l]: [usize; 4],
) -> FourVectors<F> {
    [
        F::load(machine, &[x[i], x[j], x[k], x[l]]),
        F::load(machine, &[y[i], y[j], y[k], y[l]]),
        F::load(machine, &[z[i], z[j], z[k], z[l]]),
    ]
}

/// Cosines, up to a positive factor, of the dihedral angles between facets with these normals.
#[inline(always)]
fn cosine<F: FourLanes>(
    machine: F::Machine,
    normals: &[[f64; 4]; 3],
    left: [usize; 4],
    right: [usize; 4],
) -> F {
    F::splat(machine, 0.0) - dot(picked::<F>(machine, normals, left), picked::<F>(machine, normals, right))
}

/// Cotangent from cosine and sine, both up to one positive factor. 0/0, an angle at something without extent,
/// counts as angle 0.
#[inline(always)]
fn ratio<F: FourLanes>(machine: F::Machine, cosine: F, sine: F) -> F {
    (cosine / sine).or_if_nan(F::splat(machine, f64::INFINITY))
}

/// Skew per angle above and below the regular one, of a dihedral angle and a face angle.
pub(super) const ABOVE: [f64; 2] = [1.0 / (PI - REGULAR), 1.0 / (PI - FRAC_PI_3)];
pub(super) const BELOW: [f64; 2] = [-1.0 / REGULAR, -1.0 / FRAC_PI_3];

/// The largest skew, from the extreme values of `cot |cot|`: the least and largest of the dihedral angles
/// (times the square of `size`, six times the volume), then those of the face angles.
#[inline(always)]
fn worst<F: FourLanes>(machine: F::Machine, squares: [f64; 4], size: f64) -> f64 {
    const REGULARS: [f64; 4] = [REGULAR, REGULAR, FRAC_PI_3, FRAC_PI_3];
    const PER_REACH: [f64; 4] = [ABOVE[0], BELOW[0], ABOVE[1], BELOW[1]];
    let squares = F::load(machine, &squares);
    let cotangents = signed_root(machine, squares) / F::load(machine, &[size, size, 1.0, 1.0]);
    let off = angles::<F>(machine, cotangents) - F::load(machine, &REGULARS);
    (off * F::load(machine, &PER_REACH)).max(F::splat(machine, 0.0)).max_lane()
}

/// `x |x|`: has the order of x, and saves square roots until the extremes are known.
#[inline(always)]
pub(super) fn signed_square<F: FourLanes>(x: F) -> F {
    x * x.abs()
}

#[inline(always)]
pub(super) fn signed_root<F: FourLanes>(machine: F::Machine, x: F) -> F {
    let root = x.abs().sqrt();
    x.select_positive(root, F::splat(machine, 0.0) - root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The skew by its definition, from all angles, one by one.
    fn by_definition(tet: [Point; 4]) -> f64 {
        use crate::geometry::tet::FACETS;
        use crate::geometry::vector::{cross, dot, norm, sub};
        let between = |u: Point, v: Point| norm(cross(u, v)).atan2(dot(u, v));
        let off =
            |angle: f64, regular: f64| ((angle - regular) / (PI - regular)).max((regular - angle) / regular);
        let mut worst = 0.0f64;
        for facet in FACETS {
            let corners = facet.map(|i| tet[i]);
            for i in 0..3 {
                let [p, q, r] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
                worst = worst.max(off(between(sub(q, p), sub(r, p)), FRAC_PI_3));
            }
        }
        for angle in crate::geometry::quality::dihedral::angles(tet) {
            worst = worst.max(off(angle, REGULAR));
        }
        worst
    }

    fn point() -> impl Strategy<Value = Point> {
        prop::array::uniform3(prop_oneof![-1.0f64..1.0, Just(0.0), Just(0.5), -1e-9f64..1e-9])
    }

    proptest! {
        /// Tets of all kinds: random, flat, inverted, thin and tiny.
        #[test]
        fn skew_is_what_it_is_by_definition(tet in prop::array::uniform4(point())) {
            let volume_6 = Scaled::new(tet).volume_6();
            prop_assert!((equiangle_skew(tet) - by_definition(tet)).abs() < 1e-9 || volume_6 == 0.0);
            #[cfg(target_arch = "x86_64")]
            if let (Some(machine), true) = (wide_machine(), volume_6 != 0.0) {
                let one_by_one = by_four::<Plain>((), tet, volume_6);
                let at_once = machine.vectorize(Skew::<Wide> { machine, points: tet, volume_6 });
                prop_assert_eq!(one_by_one.to_bits(), at_once.to_bits());
            }
        }
    }
}
