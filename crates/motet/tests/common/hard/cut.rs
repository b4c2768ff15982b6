//! Boxes with badly divided faces: random points on edges and faces, collinear with others, and edges flipped
//! at random.

use motet::base::Point;
use motet::geometry::predicates::orient3d;
use motet::geometry::vector::{add, scale, sub};

use super::super::Numbers;
use super::body::{Body, cuboid};

/// A box with about `steps` points on its surface, at fractions of eighths of edges and triangles: many are
/// in line.
pub(crate) fn cut_box(steps: usize, numbers: &mut Numbers) -> Body {
    cut(steps, |n| (1 + n.below(7)) as f64 / 8.0, numbers)
}

/// A box with about `steps` points on its surface, near existing points, so that triangles are thin.
pub(crate) fn cut_box_thin(steps: usize, numbers: &mut Numbers) -> Body {
    cut(steps, |n| [0.5, 0.1, 1e-3, 1e-6, 0.999_999][n.below(5)] * (0.5 + 0.5 * n.unit()), numbers)
}

fn cut(steps: usize, share: impl Fn(&mut Numbers) -> f64, numbers: &mut Numbers) -> Body {
    let box_body = cuboid([0.0; 3], [1.0, 2.0, 1.5]);
    let mut faces = Faces {
        triangles: box_body.triangles.iter().map(|t| t.map(|v| v.index())).collect(),
        points: box_body.points,
    };
    for _ in 0..steps {
        match numbers.below(4) {
            0 => faces.split_edge(share(numbers), numbers),
            1 => faces.split_triangle([share(numbers), share(numbers)], numbers),
            _ => faces.flip(numbers),
        }
    }
    Body::new(faces.points, &faces.triangles, box_body.volume)
}

struct Faces {
    points: Vec<Point>,
    triangles: Vec<[usize; 3]>,
}

/// A place inside the box, in no plane of a face.
const WITHIN: Point = [0.5, 1.0, 0.75];

impl Faces {
    /// Whether triangles face outward and none is flat. All lie in faces of the box, so signs are those
    /// within the plane.
    fn are_sound(&self, triangles: &[[usize; 3]]) -> bool {
        triangles.iter().all(|t| {
            let [a, b, c] = t.map(|v| self.points[v]);
            orient3d(a, b, c, WITHIN) < 0
        })
    }

    /// A triangle rotated so that a random edge is its first, and the vertices of the two triangles at that
    /// edge.
    fn random_edge(&self, numbers: &mut Numbers) -> ([usize; 2], [usize; 4]) {
        let s = numbers.below(self.triangles.len());
        let mut turned = self.triangles[s];
        turned.rotate_left(numbers.below(3));
        let [a, b, c] = turned;
        let across =
            |t: &[usize; 3]| (0..3).find(|&k| t[k] == b && t[(k + 1) % 3] == a).map(|k| t[(k + 2) % 3]);
        let found = self.triangles.iter().enumerate().find_map(|(t, other)| Some((t, across(other)?)));
        let (t, d) = found.expect("the surface is closed");
        ([s, t], [a, b, c, d])
    }

    /// A place that is exactly in the plane of a face if the others are: no sum of shares is rounded.
    fn between(&self, from: usize, to: &[(usize, f64)]) -> Point {
        let origin = self.points[from];
        to.iter().fold(origin, |p, &(v, share)| add(p, scale(sub(self.points[v], origin), share)))
    }

    fn split_edge(&mut self, share: f64, numbers: &mut Numbers) {
        let ([s, t], [a, b, c, d]) = self.random_edge(numbers);
        let m = self.points.len();
        self.points.push(self.between(a, &[(b, share)]));
        let new = [[a, m, c], [m, b, c], [b, m, d], [m, a, d]];
        if self.are_sound(&new) {
            [self.triangles[s], self.triangles[t]] = [new[0], new[2]];
            self.triangles.extend([new[1], new[3]]);
        } else {
            self.points.pop();
        }
    }

    fn split_triangle(&mut self, [p, q]: [f64; 2], numbers: &mut Numbers) {
        let s = numbers.below(self.triangles.len());
        let [a, b, c] = self.triangles[s];
        let m = self.points.len();
        self.points.push(self.between(a, &[(b, p * (1.0 - q)), (c, p * q)]));
        let new = [[a, b, m], [b, c, m], [c, a, m]];
        if self.are_sound(&new) {
            self.triangles[s] = new[0];
            self.triangles.extend([new[1], new[2]]);
        } else {
            self.points.pop();
        }
    }

    fn flip(&mut self, numbers: &mut Numbers) {
        let ([s, t], [a, b, c, d]) = self.random_edge(numbers);
        let corners = [a, b, c, d].map(|v| self.points[v]);
        let [p, q, r, o] = corners;
        let new = [[a, d, c], [d, b, c]];
        // Edges of the box are not flipped.
        if orient3d(p, q, r, o) == 0 && self.are_sound(&new) {
            [self.triangles[s], self.triangles[t]] = new;
        }
    }
}
