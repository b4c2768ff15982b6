//! Rigid motions, and the one that best fits the motion of points.

use crate::base::Point;
use crate::geometry::symmetric::largest_eigenvector;
use crate::geometry::vector::{add, cross, norm, scale, sub};

/// A rotation about a centre, followed by a translation of that centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// The centre before and after the motion.
    pub centres: [Point; 2],
    /// The axis of rotation, a unit vector.
    pub axis: Point,
    /// Half the angle of rotation in radians, from 0 to pi / 2.
    pub half_angle: f64,
}

impl Rigid {
    /// The motion that minimises the sum of squared distances from the moved first points to the second
    /// points (Horn 1987: the rotation is the quaternion that is the eigenvector to the largest eigenvalue of
    /// a symmetric matrix). Where no point moves there is exactly no rotation.
    pub fn fit(pairs: &[(Point, Point)]) -> Self {
        let share = 1.0 / pairs.len().max(1) as f64;
        let mean = |of: fn(&(Point, Point)) -> Point| scale(pairs.iter().map(of).fold([0.0; 3], add), share);
        let centres = [mean(|p| p.0), mean(|p| p.1)];
        let mut s = [[0.0; 3]; 3];
        for (from, to) in pairs {
            let (a, b) = (sub(*from, centres[0]), sub(*to, centres[1]));
            (0..3).for_each(|i| (0..3).for_each(|j| s[i][j] += a[i] * b[j]));
        }
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s;
        let q = largest_eigenvector([
            [xx + yy + zz, yz - zy, zx - xz, xy - yx],
            [yz - zy, xx - yy - zz, xy + yx, zx + xz],
            [zx - xz, xy + yx, yy - xx - zz, yz + zy],
            [xy - yx, zx + xz, yz + zy, zz - xx - yy],
        ]);
        let [w, x, y, z] = if q[0] < 0.0 { q.map(|c| -c) } else { q };
        let sine = norm([x, y, z]);
        let axis = if sine > 0.0 { [x, y, z].map(|c| c / sine) } else { [0.0, 0.0, 1.0] };
        Self { centres, axis, half_angle: sine.atan2(w) }
    }

    /// The position of a point after the whole motion.
    pub fn apply(&self, p: Point) -> Point {
        add(self.centres[1], rotated(sub(p, self.centres[0]), scale(self.axis, 2.0 * self.half_angle)))
    }
}

/// Rotates a vector; the rotation is given as its axis times its angle in radians (Rodrigues 1840).
fn rotated(v: Point, turn: Point) -> Point {
    let angle = norm(turn);
    let half = 0.5 * angle;
    let (first, of_half) = match angle > 1e-6 {
        true => (angle.sin() / angle, half.sin() / half),
        false => (1.0, 1.0),
    };
    let across = cross(turn, v);
    add(v, add(scale(across, first), scale(cross(turn, across), 0.5 * of_half * of_half)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::distance;

    fn points() -> Vec<Point> {
        (0..20).map(|i| f64::from(i) * 0.7).map(|t| [t.sin() + 3.0, (2.0 * t).cos(), 0.2 * t]).collect()
    }

    #[test]
    fn a_rigid_motion_is_found_from_how_points_move() {
        let axis = scale([0.3, -0.4, 1.2], 1.0 / 1.3);
        for degrees in [0.0f64, 1e-7, 1e-3, 15.0, 90.0, 179.0, 180.0] {
            let moved = |p: Point| {
                add(rotated(sub(p, [3.0, 1.0, -2.0]), scale(axis, degrees.to_radians())), [0.5, 0.1, -7.0])
            };
            let rigid = Rigid::fit(&points().into_iter().map(|p| (p, moved(p))).collect::<Vec<_>>());
            for p in points() {
                assert!(distance(rigid.apply(p), moved(p)) < 1e-12, "{degrees}");
            }
        }
    }
}
