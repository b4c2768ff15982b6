//! How often a surface goes around a point, also if it has holes, crosses itself or exists twice.
//!
//! The solid angles of the triangles are summed and divided by that of the sphere: a whole number for a
//! closed surface, a number in between for an open one (Jacobson, Kavan and Sorkine-Hornung 2013, *Robust
//! inside-outside segmentation using generalized winding numbers*). Distant triangles are treated together,
//! by a Taylor series of third order (Barill, Dickson, Schmidt, Levin and Jacobson 2018, *Fast winding
//! numbers for soups and clouds*).

use std::f64::consts::PI;

use crate::base::{Point, VertexId};
use crate::geometry::triangle::{area_vector, centroid};
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};

/// From this multiple of its radius on, a group of triangles is treated as one. The sum is then correct to a
/// hundredth: the test below prints 0.0033 for a ball.
const FAR_RATIO: f64 = 2.0;

/// A group of no more triangles than this is not split.
const MAX_LEAF: usize = 8;

/// A surface, its triangles in groups within groups.
#[derive(Clone, Debug)]
pub struct WindingNumber {
    /// The corners, in the order of the groups.
    triangles: Vec<[Point; 3]>,
    groups: Vec<Group>,
}

#[derive(Clone, Copy, Debug)]
struct Group {
    /// The area-weighted mean of the centroids, and a radius around it that contains all corners.
    centre: Point,
    radius: f64,
    series: Series,
    /// The triangles, `begin..end`.
    range: [u32; 2],
    /// The second of the two groups that this one is split into; the first follows it directly. 0 if it is
    /// not split.
    second: u32,
}

impl WindingNumber {
    /// Builds the groups of triangles with finite corners.
    ///
    /// Panics when a triangle names a point beyond `points`.
    pub fn new(points: &[Point], triangles: &[[VertexId; 3]]) -> Self {
        let corners = triangles.iter().map(|t| t.map(|v| points[v.index()])).collect();
        let mut tree = Self { triangles: corners, groups: Vec::new() };
        if !triangles.is_empty() {
            tree.build_group(0, triangles.len());
        }
        tree
    }

    /// Makes the group of triangles `begin..end`, and those within it; returns its number.
    fn build_group(&mut self, begin: usize, end: usize) -> u32 {
        let number = self.groups.len();
        self.groups.push(Group::of(&self.triangles[begin..end], [begin as u32, end as u32]));
        if end - begin > MAX_LEAF {
            let members = &mut self.triangles[begin..end];
            let axis = longest_axis(members);
            let middle = members.len() / 2;
            let key = |t: &[Point; 3]| t[0][axis] + t[1][axis] + t[2][axis];
            members.select_nth_unstable_by(middle, |s, t| key(s).total_cmp(&key(t)));
            self.build_group(begin, begin + middle);
            self.groups[number].second = self.build_group(begin + middle, end);
        }
        number as u32
    }

    /// How often the surface goes around `p`: 1 inside a surface that faces outward, 0 outside, and something
    /// between on it.
    pub fn at(&self, p: Point) -> f64 {
        if self.groups.is_empty() { 0.0 } else { self.solid_angle_of_group(0, p) / (4.0 * PI) }
    }

    fn solid_angle_of_group(&self, number: u32, p: Point) -> f64 {
        let group = &self.groups[number as usize];
        let away = distance(group.centre, p);
        if away > FAR_RATIO * group.radius {
            return group.series.at(sub(group.centre, p), away);
        }
        if group.second == 0 {
            let [begin, end] = group.range;
            return solid_angle(&self.triangles[begin as usize..end as usize], p);
        }
        self.solid_angle_of_group(number + 1, p) + self.solid_angle_of_group(group.second, p)
    }
}

impl Group {
    fn of(triangles: &[[Point; 3]], range: [u32; 2]) -> Self {
        let (sum, area) = triangles.iter().fold(([0.0; 3], 0.0), |(sum, area), t| {
            let own = norm(area_vector(*t));
            (add(sum, scale(centroid(*t), own)), area + own)
        });
        let centre = if area > 0.0 { scale(sum, 1.0 / area) } else { triangles[0][0] };
        let radius = triangles.as_flattened().iter().map(|&p| distance(p, centre)).fold(0.0, f64::max);
        let mut series = Series::default();
        triangles.iter().for_each(|t| series.add(t.map(|p| sub(p, centre)), area_vector(*t)));
        Self { centre, radius, series, range, second: 0 }
    }
}

/// The solid angle of triangles seen from far away, as a Taylor series around a centre: the integral of
/// `n . r / |r|^3` over them.
#[derive(Clone, Copy, Debug, Default)]
struct Series {
    /// The integral of the normal `n`.
    normal: Point,
    /// Of `x . n`, where `x` is the place seen from the centre.
    trace: f64,
    /// Of `x n`, by the products of coordinates of [`Self::squares`].
    square: [f64; 6],
    /// Of `(x . n) x + (x . x) n / 2`.
    vector: Point,
    /// Of `x x n`, by the products of coordinates of [`Self::cubes`].
    cube: [f64; 10],
}

impl Series {
    /// The products of two coordinates.
    fn squares([x, y, z]: Point) -> [f64; 6] {
        [x * x, y * y, z * z, y * z, z * x, x * y]
    }

    /// The products of three coordinates.
    fn cubes([x, y, z]: Point) -> [f64; 10] {
        let (xx, yy, zz) = (x * x, y * y, z * z);
        [xx * x, yy * y, zz * z, xx * y, xx * z, yy * z, yy * x, zz * x, zz * y, x * y * z]
    }

    /// Adds a triangle, seen from the centre, and its area vector.
    fn add(&mut self, corners: [Point; 3], n: Point) {
        let middle = centroid(corners);
        self.normal = add(self.normal, n);
        self.trace += dot(middle, n);
        let [x, y, z] = middle;
        let square =
            [x * n[0], y * n[1], z * n[2], y * n[2] + z * n[1], z * n[0] + x * n[2], x * n[1] + y * n[0]];
        self.square.iter_mut().zip(square).for_each(|(sum, of)| *sum += of);
        // The mean of x x^T over a triangle: that of its corners and nine times its centroid.
        let mut means = Self::squares(middle).map(|of| 9.0 * of);
        for corner in corners {
            means.iter_mut().zip(Self::squares(corner)).for_each(|(sum, of)| *sum += of);
        }
        let [xx, yy, zz, yz, zx, xy] = means.map(|of| of / 12.0);
        let [u, v, w] = n;
        let along = [xx * u + xy * v + zx * w, xy * u + yy * v + yz * w, zx * u + yz * v + zz * w];
        self.vector = add(self.vector, add(along, scale(n, 0.5 * (xx + yy + zz))));
        let cube = [
            xx * u,
            yy * v,
            zz * w,
            xx * v + 2.0 * xy * u,
            xx * w + 2.0 * zx * u,
            yy * w + 2.0 * yz * v,
            yy * u + 2.0 * xy * v,
            zz * u + 2.0 * zx * w,
            zz * v + 2.0 * yz * w,
            2.0 * (yz * u + zx * v + xy * w),
        ];
        self.cube.iter_mut().zip(cube).for_each(|(sum, of)| *sum += of);
    }

    /// The solid angle, where the centre is at `r` from the eye, `away` far.
    fn at(&self, r: Point, away: f64) -> f64 {
        let inverse = 1.0 / (away * away);
        let cubed = inverse / away;
        let of = |list: &[f64], with: &[f64]| list.iter().zip(with).map(|(x, y)| x * y).sum::<f64>();
        let second = self.trace - 3.0 * inverse * of(&self.square, &Self::squares(r));
        let third = inverse * (7.5 * inverse * of(&self.cube, &Self::cubes(r)) - 3.0 * dot(self.vector, r));
        cubed * (dot(self.normal, r) + second + third)
    }
}

/// How often one triangle goes around `p`, in parts of a whole turn: what it adds to the winding number of a
/// surface.
pub(crate) fn winding_of_triangle(triangle: [Point; 3], p: Point) -> f64 {
    solid_angle(&[triangle], p) / (4.0 * PI)
}

fn longest_axis(triangles: &[[Point; 3]]) -> usize {
    let extent = |axis: usize| {
        let along = || triangles.as_flattened().iter().map(|p| p[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    (0..3).max_by(|&i, &j| extent(i).total_cmp(&extent(j))).unwrap_or(0)
}

/// The sum of the solid angles of triangles seen from `p`, positive from behind (van Oosterom and Strackee
/// 1983, *The solid angle of a plane triangle*). Half of each is the argument of a complex number; these are
/// multiplied, and whole turns counted, so that one arc tangent is needed.
fn solid_angle(triangles: &[[Point; 3]], p: Point) -> f64 {
    // Arguments are in (-pi, pi].
    let is_above = |[re, im]: [f64; 2]| im > 0.0 || im == 0.0 && re < 0.0;
    let (mut product, mut turns) = ([1.0, 0.0], 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|q| sub(q, p));
        let [la, lb, lc] = [norm(a), norm(b), norm(c)];
        let re = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        let im = dot(a, cross(b, c));
        let next = [product[0] * re - product[1] * im, product[0] * im + product[1] * re];
        let size = next[0].abs().max(next[1].abs());
        // A triangle seen from one of its corners has no angle.
        if !(size > 0.0 && size.is_finite()) {
            continue;
        }
        if is_above(product) && is_above([re, im]) && !is_above(next) {
            turns += 1.0;
        } else if product[1] < 0.0 && im < 0.0 && next[1] >= 0.0 {
            turns -= 1.0;
        }
        product = next.map(|x| x / size);
    }
    // The sum turns -0 into 0.
    2.0 * ((product[1] + 0.0).atan2(product[0]) + 2.0 * PI * turns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Surface;
    use crate::mesh::shapes::ball;

    #[test]
    fn winding_numbers_of_a_ball_and_of_half_a_ball() {
        let surface = Surface::boundary_of(&ball(12, 2));
        let whole = WindingNumber::new(&surface.points, &surface.triangles);
        let exact = |triangles: &[[VertexId; 3]], p: Point| -> f64 {
            let corners = |t: &[VertexId; 3]| t.map(|v| surface.points[v.index()]);
            triangles.iter().map(|t| solid_angle(&[corners(t)], p)).sum::<f64>() / (4.0 * PI)
        };
        let mut worst: f64 = 0.0;
        for i in -12..=12 {
            for j in -3..=3 {
                let p = [0.16 * f64::from(i), 0.3 * f64::from(j), 0.1];
                let off = (whole.at(p) - exact(&surface.triangles, p)).abs();
                assert!(off < 1e-2, "{p:?} {off}");
                assert!((norm(p) - 1.0).abs() < 0.01 || (whole.at(p) > 0.5) == (norm(p) < 1.0), "{p:?}");
                worst = worst.max(off);
            }
        }
        println!("off by {worst:.4} at most");
        let is_upper = |t: &&[VertexId; 3]| centroid(t.map(|v| surface.points[v.index()]))[2] > 0.0;
        let half: Vec<[VertexId; 3]> = surface.triangles.iter().filter(is_upper).copied().collect();
        let open = WindingNumber::new(&surface.points, &half);
        for p in [[0.0; 3], [0.1, 0.2, 0.5], [2.0, 1.0, -3.0], [0.0, 0.0, -0.9]] {
            assert!((open.at(p) - exact(&half, p)).abs() < 1e-2, "{p:?}");
        }
        // A surface that exists twice counts twice.
        let twice = [&surface.triangles[..], &surface.triangles[..]].concat();
        assert!((WindingNumber::new(&surface.points, &twice).at([0.0; 3]) - 2.0).abs() < 2e-2);
        assert_eq!(WindingNumber::new(&[], &[]).at([0.0; 3]), 0.0);
    }
}
