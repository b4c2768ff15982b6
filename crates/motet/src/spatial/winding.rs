//! How often a surface goes around a point, also if it has holes, crosses itself or exists twice.
//!
//! The solid angles of the triangles are summed and divided by that of the sphere: a whole number for a
//! closed surface, a number in between for an open one (Jacobson, Kavan and Sorkine-Hornung 2013, *Robust
//! inside-outside segmentation using generalized winding numbers*). Distant triangles are treated together,
//! as one with the sum of their area vectors (Barill, Dickson, Schmidt, Levin and Jacobson 2018, *Fast
//! winding numbers for soups and clouds*).

use std::f64::consts::PI;

use crate::base::{Point, VertexId};
use crate::geometry::triangle::{area_vector, centroid};
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};

/// From this multiple of its radius on, a group of triangles is treated as one. The sum is then correct to a
/// hundredth: the test below prints 0.0057 for a ball.
const FAR_RATIO: f64 = 4.0;

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
    /// The sum of the area vectors.
    dipole: Point,
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
            return dot(group.dipole, sub(group.centre, p)) / (away * away * away);
        }
        if group.second == 0 {
            let [begin, end] = group.range;
            return self.triangles[begin as usize..end as usize].iter().map(|t| solid_angle(*t, p)).sum();
        }
        self.solid_angle_of_group(number + 1, p) + self.solid_angle_of_group(group.second, p)
    }
}

impl Group {
    fn of(triangles: &[[Point; 3]], range: [u32; 2]) -> Self {
        let zero = ([0.0; 3], 0.0, [0.0; 3]);
        let (sum, area, dipole) = triangles.iter().fold(zero, |(sum, area, dipole), t| {
            let normal = area_vector(*t);
            let own = norm(normal);
            (add(sum, scale(centroid(*t), own)), area + own, add(dipole, normal))
        });
        let centre = if area > 0.0 { scale(sum, 1.0 / area) } else { triangles[0][0] };
        let radius = triangles.as_flattened().iter().map(|&p| distance(p, centre)).fold(0.0, f64::max);
        Self { centre, radius, dipole, range, second: 0 }
    }
}

/// How often one triangle goes around `p`, in parts of a whole turn: what it adds to the winding number of a
/// surface.
pub(crate) fn winding_of_triangle(triangle: [Point; 3], p: Point) -> f64 {
    solid_angle(triangle, p) / (4.0 * PI)
}

fn longest_axis(triangles: &[[Point; 3]]) -> usize {
    let extent = |axis: usize| {
        let along = || triangles.as_flattened().iter().map(|p| p[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    (0..3).max_by(|&i, &j| extent(i).total_cmp(&extent(j))).unwrap_or(0)
}

/// The solid angle of a triangle seen from `p`, positive from behind (van Oosterom and Strackee 1983, *The
/// solid angle of a plane triangle*).
fn solid_angle(triangle: [Point; 3], p: Point) -> f64 {
    let [a, b, c] = triangle.map(|q| sub(q, p));
    let [la, lb, lc] = [norm(a), norm(b), norm(c)];
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * dot(a, cross(b, c)).atan2(below)
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
            triangles.iter().map(|t| solid_angle(corners(t), p)).sum::<f64>() / (4.0 * PI)
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
