//! The rotation of each vertex of a wall.
//!
//! The rotation of a facet is the part of its deformation that is no stretch: the polar factor of its plane
//! gradient, with the normal carried along. The rotation of a vertex is the mean over its facets, weighted by
//! area; that of a point of a facet is the mean over the three vertices, by its weights. So it does not jump
//! from facet to facet, and two neighbours in a layer that have their feet on different facets stay
//! neighbours. A wall that moves rigidly rotates every point by exactly its own rotation.

use crate::base::{Csr, Point, Threads};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};

/// A rotation as a quaternion: `[w, x, y, z]`, of length 1 unless it is part of a sum.
pub(crate) type Quaternion = [f64; 4];

pub(crate) const IDENTITY: Quaternion = [1.0, 0.0, 0.0, 0.0];

/// A triangle of the wall in its reference position.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Unit vectors along the first edge, across it in the plane, and along the normal.
    axes: [Point; 3],
    edges: [Point; 2],
    /// 1 / length of the first edge; the component of the second edge along the first, relative to its
    /// length; 1 / height above it.
    plane: [f64; 3],
    area: f64,
}

/// The triangles of a wall, over vertices numbered from 0.
#[derive(Debug)]
pub(crate) struct Wall {
    triangles: Vec<[u32; 3]>,
    /// `None` for a triangle without area, which has no influence.
    frames: Vec<Option<Frame>>,
    vertex_to_triangles: Csr<u32>,
}

impl Wall {
    /// The wall made of `triangles` between `points`, in its reference position.
    pub(crate) fn new(points: &[Point], triangles: Vec<[u32; 3]>) -> Self {
        let frames = triangles.iter().map(|t| Frame::new(t.map(|v| points[v as usize]))).collect();
        let vertex_to_triangles = Csr::from_pairs(points.len(), || {
            triangles.iter().enumerate().flat_map(|(i, t)| t.map(|v| (v as usize, i as u32)))
        });
        Self { triangles, frames, vertex_to_triangles }
    }

    pub(crate) fn triangle(&self, i: usize) -> [u32; 3] {
        self.triangles[i]
    }

    /// The rotation of every vertex after a motion by `displacement`.
    pub(crate) fn rotations(
        &self,
        displacement: impl Fn(u32) -> Point + Sync,
        threads: &Threads,
    ) -> Vec<Quaternion> {
        let of_facet = |frame: &Frame, [a, b, c]: [u32; 3]| {
            let [a, b, c] = [displacement(a), displacement(b), displacement(c)];
            frame.rotation([a, b, c])
        };
        let facets = threads.map(self.triangles.len(), |i| {
            self.frames[i].as_ref().map_or([0.0; 4], |frame| of_facet(frame, self.triangles[i]))
        });
        let around = |v: usize| self.vertex_to_triangles.list(v).iter().map(|&t| (1.0, facets[t as usize]));
        threads.map(self.vertex_to_triangles.len(), |v| mean(around(v)))
    }
}

impl Frame {
    fn new([a, b, c]: [Point; 3]) -> Option<Self> {
        let edges = [sub(b, a), sub(c, a)];
        let normal = cross(edges[0], edges[1]);
        let (length, twice_area) = (norm(edges[0]), norm(normal));
        let along = scale(edges[0], 1.0 / length);
        let normal = scale(normal, 1.0 / twice_area);
        let axes = [along, cross(normal, along), normal];
        let plane = [1.0 / length, dot(edges[1], along) / length, length / twice_area];
        let finite = axes.as_flattened().iter().chain(&plane).all(|x| x.is_finite());
        finite.then_some(Self { axes, edges, plane, area: 0.5 * twice_area })
    }

    /// The rotation scaled by the area; zero when the facet has lost its area.
    fn rotation(&self, [a, b, c]: [Point; 3]) -> Quaternion {
        if a == b && a == c {
            // Only translated, like most of a wall of which a part moves: a twentieth of the time, and no
            // rounding.
            return IDENTITY.map(|x| x * self.area);
        }
        let [first, second] = [add(self.edges[0], sub(b, a)), add(self.edges[1], sub(c, a))];
        let normal = unit(cross(first, second));
        // The plane gradient: images of the unit vectors along and across the first edge.
        let along = scale(first, self.plane[0]);
        let across = scale(sub(second, scale(first, self.plane[1])), self.plane[2]);
        // Its polar factor rotates the first axis to this one.
        let along = unit(add(along, cross(across, normal)));
        let turned = [along, cross(normal, along), normal];
        let q = quaternion(self.axes, turned).map(|x| x * self.area);
        if q.iter().all(|x| x.is_finite()) { q } else { [0.0; 4] }
    }
}

fn unit(a: Point) -> Point {
    scale(a, 1.0 / norm(a))
}

/// The rotation that takes one right-handed set of axes to another (Shepperd 1978: computed from the largest
/// of the four components, so that no precision is lost).
fn quaternion(from: [Point; 3], to: [Point; 3]) -> Quaternion {
    let m = |i: usize, j: usize| (0..3).map(|k| to[k][i] * from[k][j]).sum::<f64>();
    let diagonal = [m(0, 0), m(1, 1), m(2, 2)];
    let trace: f64 = diagonal.iter().sum();
    let squares = [
        1.0 + trace,
        1.0 + 2.0 * diagonal[0] - trace,
        1.0 + 2.0 * diagonal[1] - trace,
        1.0 + 2.0 * diagonal[2] - trace,
    ];
    let largest = (1..4).fold(0, |i, j| if squares[j] > squares[i] { j } else { i });
    let (x, y, z) = (m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
    let (xy, yz, zx) = (m(1, 0) + m(0, 1), m(2, 1) + m(1, 2), m(0, 2) + m(2, 0));
    let s = squares[largest];
    let q = [[s, x, y, z], [x, s, xy, zx], [y, xy, s, yz], [z, zx, yz, s]][largest];
    q.map(|c| c * 0.5 / s.sqrt())
}

/// The weighted mean of rotations, normalised; `q` and `-q` are the same rotation, so each is taken on the
/// side of the sum so far.
pub(crate) fn mean(parts: impl Iterator<Item = (f64, Quaternion)>) -> Quaternion {
    let mut sum = [0.0; 4];
    for (weight, q) in parts {
        let side = (0..4).map(|i| sum[i] * q[i]).sum::<f64>();
        let weight = if side < 0.0 { -weight } else { weight };
        (0..4).for_each(|i| sum[i] += weight * q[i]);
    }
    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { sum.map(|x| x / length) } else { IDENTITY }
}

/// The difference between the rotated `v` and `v`, without cancellation where the rotation is small.
pub(crate) fn rotation_change(q: Quaternion, v: Point) -> Point {
    let axis = [q[1], q[2], q[3]];
    scale(cross(axis, add(cross(axis, v), scale(v, q[0]))), 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::distance;
    use crate::motion::Prescribed;

    const TRIANGLES: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    const POINTS: [Point; 4] = [[0.1, 0.2, 0.0], [1.0, 0.0, 0.3], [0.2, 1.4, 0.0], [0.0, -0.2, 1.1]];

    fn turned_by(angle: f64, axis: Point) -> (Vec<Quaternion>, Prescribed) {
        let turn = Prescribed::Turn { axis, angle, centre: [3.0, -1.0, 2.0] };
        let wall = Wall::new(&POINTS, TRIANGLES.to_vec());
        (wall.rotations(|v| turn.displacement(POINTS[v as usize], 1.0), &Threads::single()), turn)
    }

    #[test]
    fn a_rigid_turn_is_found_at_any_angle() {
        for degrees in [0.0, 1e-6, 30.0, 90.0, 179.9, 180.0, 250.0] {
            for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.3, 0.4, -2.0]] {
                let (rotations, turn) = turned_by(f64::to_radians(degrees), axis);
                let (v, origin) = ([0.3, -0.7, 1.9], [0.0; 3]);
                let turned = sub(turn.apply(v, 1.0), turn.apply(origin, 1.0));
                for q in rotations {
                    assert!(distance(add(v, rotation_change(q, v)), turned) < 1e-14, "{degrees} {axis:?}");
                }
            }
        }
    }

    #[test]
    fn stretch_does_not_turn() {
        let wall = Wall::new(&POINTS, vec![[0, 1, 2]]);
        for q in &wall.rotations(|v| scale(POINTS[v as usize], 0.7), &Threads::single())[..3] {
            assert!((q[0] - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn what_has_no_area_has_no_say() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let wall = Wall::new(&points, vec![[0, 1, 2], [0, 1, 3]]);
        let rotations = wall.rotations(|_| [0.0, 0.0, 1.0], &Threads::single());
        assert_eq!(rotations[2], IDENTITY);
        let fallen = |v| if v == 3 { [0.5, -1.0, 0.0] } else { [0.0; 3] };
        let flattened = wall.rotations(fallen, &Threads::single());
        assert!(flattened.iter().all(|&q| q == IDENTITY));
    }
}
