//! Rotations nearest to gradients, four at a time.

use crate::base::Point;
use crate::base::four::{FourLanes, FourVectors, cross as cross4, dot as dot4};
use crate::geometry::vector::{add, cross, scale};

/// A rotation as a quaternion: `[w, x, y, z]`, of length 1.
pub(crate) type Quaternion = [f64; 4];

pub(crate) const IDENTITY: Quaternion = [1.0, 0.0, 0.0, 0.0];

/// Steps of Newton's method: from condition numbers of 100 as many reach the last bit.
const NEWTON_STEPS: usize = 8;

/// The axes to which the polar factor of a plane gradient takes two unit vectors at right angles and their
/// normal, given what the gradient makes of the two. Not numbers where these are along a line.
#[inline(always)]
pub(super) fn frame<F: FourLanes>(machine: F::Machine, [a, b]: [FourVectors<F>; 2]) -> [FourVectors<F>; 3] {
    let normal = unit4(machine, cross4(a, b));
    // Of `a` and `b` turned by 90 degrees, the stretch cancels in the sum.
    let back = cross4(b, normal);
    let along = unit4(machine, [a[0] + back[0], a[1] + back[1], a[2] + back[2]]);
    [along, cross4(normal, along), normal]
}

/// The axes to which the polar factor of a matrix takes the three axes, given their images: by Newton's
/// method, scaled (Higham 1986). Also whether the factor is a rotation: positive where the matrix mirrors
/// nothing.
#[inline(always)]
pub(super) fn polar<F: FourLanes>(
    machine: F::Machine,
    mut images: [FourVectors<F>; 3],
) -> ([FourVectors<F>; 3], F) {
    let half = F::splat(machine, 0.5);
    let mut is_rotation = half;
    for step in 0..NEWTON_STEPS {
        let [a, b, c] = images;
        // The inverse, transposed, times the determinant.
        let cofactors = [cross4(b, c), cross4(c, a), cross4(a, b)];
        let determinant = dot4(a, cofactors[0]);
        if step == 0 {
            is_rotation = determinant;
        }
        let squares = dot4(a, a) + dot4(b, b) + dot4(c, c);
        let [a, b, c] = cofactors;
        let of_cofactors = dot4(a, a) + dot4(b, b) + dot4(c, c);
        let scale = ((of_cofactors / squares).sqrt() / determinant).sqrt();
        let (share, of_cofactor) = (half * scale, half / (scale * determinant));
        for k in 0..3 {
            for j in 0..3 {
                images[k][j] = images[k][j] * share + cofactors[k][j] * of_cofactor;
            }
        }
    }
    // A rotation, also where the steps did not suffice.
    let normal = unit4(machine, images[2]);
    let along = unit4(machine, cross4(images[1], normal));
    ([along, cross4(normal, along), normal], is_rotation)
}

/// The rotation that takes one right-handed set of axes to another (Shepperd 1978: computed from the largest
/// of the four components, so that no precision is lost); [`IDENTITY`] where `moved` is 0, so that what only
/// translates is not rounded, and where an axis is not a number.
#[inline(always)]
pub(super) fn quaternion<F: FourLanes>(
    machine: F::Machine,
    from: [FourVectors<F>; 3],
    to: [FourVectors<F>; 3],
    moved: F,
) -> [F; 4] {
    let mut m = [[F::splat(machine, 0.0); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            m[i][j] = to[0][i] * from[0][j] + to[1][i] * from[1][j] + to[2][i] * from[2][j];
        }
    }
    let one = F::splat(machine, 1.0);
    let (x, y, z) = (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]);
    let (xy, yz, zx) = (m[1][0] + m[0][1], m[2][1] + m[1][2], m[0][2] + m[2][0]);
    // Four times the square of each component, and the component times all.
    let (sum, difference) = (m[0][0] + m[1][1], m[0][0] - m[1][1]);
    let mut square = one + sum + m[2][2];
    let mut all = [square, x, y, z];
    let of_x = one + difference - m[2][2];
    let of_y = one - difference - m[2][2];
    let of_z = one - sum + m[2][2];
    for (other, of_other) in [(of_x, [x, of_x, xy, zx]), (of_y, [y, xy, of_y, yz]), (of_z, [z, zx, yz, of_z])]
    {
        let is_larger = other - square;
        square = square.max(other);
        for i in 0..4 {
            all[i] = is_larger.select_positive(of_other[i], all[i]);
        }
    }
    let share = F::splat(machine, 0.5) / square.sqrt();
    let is_known = moved * square;
    for i in 0..4 {
        all[i] = is_known.select_positive(all[i] * share, F::splat(machine, IDENTITY[i]));
    }
    all
}

#[inline(always)]
fn unit4<F: FourLanes>(machine: F::Machine, a: FourVectors<F>) -> FourVectors<F> {
    let share = F::splat(machine, 1.0) / dot4(a, a).sqrt();
    [a[0] * share, a[1] * share, a[2] * share]
}

/// The difference between the rotated `v` and `v`, without cancellation where the rotation is small.
pub(crate) fn rotation_change(q: Quaternion, v: Point) -> Point {
    let axis = [q[1], q[2], q[3]];
    scale(cross(axis, add(cross(axis, v), scale(v, q[0]))), 2.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::base::four::Plain;
    use crate::geometry::symmetric::largest_eigenvector;
    use crate::geometry::vector::dot;

    proptest! {
        /// Against the quaternion of the nearest rotation as an eigenvector (Horn 1987).
        #[test]
        fn the_polar_factor_is_the_nearest_rotation(
            images in prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)),
        ) {
            let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = images;
            let determinant = dot(images[0], cross(images[1], images[2]));
            prop_assume!(determinant > 1e-3);
            let expected = largest_eigenvector([
                [xx + yy + zz, yz - zy, zx - xz, xy - yx],
                [yz - zy, xx - yy - zz, xy + yx, zx + xz],
                [zx - xz, xy + yx, yy - xx - zz, yz + zy],
                [xy - yx, zx + xz, yz + zy, zz - xx - yy],
            ]);
            let (to, is_rotation) = polar((), images.map(|image| image.map(|x| Plain::splat((), x))));
            prop_assert!(is_rotation.stored()[0] > 0.0);
            for (k, axis) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
                let turned = add(axis, rotation_change(expected, axis));
                for (x, of_four) in turned.iter().zip(to[k]) {
                    prop_assert!((x - of_four.stored()[0]).abs() < 1e-11, "{:?} {}", images, k);
                }
            }
        }
    }
}
