//! Surfaces for the tests of contact: small shapes of triangles, random and degenerate.

#![allow(dead_code, reason = "each test uses a part of it")]

pub(crate) mod oracle;

use std::f64::consts::TAU;

use motet::base::{Point, VertexId};
use motet::contact::{Body, Room};

use crate::common::Numbers;

/// Points and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub(crate) fn map(mut self, f: impl Fn(Point) -> Point) -> Self {
        self.points.iter_mut().for_each(|p| *p = f(*p));
        self
    }

    pub(crate) fn shifted(self, by: Point) -> Self {
        self.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]])
    }

    pub(crate) fn scaled(self, by: f64) -> Self {
        self.map(|p| p.map(|x| x * by))
    }

    pub(crate) fn turned_inside_out(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    pub(crate) fn corners(&self, t: usize) -> [Point; 3] {
        self.triangles[t].map(|v| self.points[v as usize])
    }
}

/// All shapes over one list of points.
pub(crate) fn bodies(shapes: &[Shape]) -> (Vec<Point>, Vec<Body>) {
    let (mut points, mut bodies) = (Vec::new(), Vec::new());
    for (i, shape) in shapes.iter().enumerate() {
        let first = points.len() as u32;
        let triangles = shape.triangles.iter().map(|t| t.map(|v| VertexId(first + v))).collect();
        bodies.push(Body { name: format!("body{i}"), triangles, room: Room::Found });
        points.extend(&shape.points);
    }
    (points, bodies)
}

/// Random triangles in the unit cube.
pub(crate) fn soup(numbers: &mut Numbers, n: usize) -> Shape {
    let points = (0..3 * n).map(|_| [(); 3].map(|()| numbers.unit())).collect();
    Shape { points, triangles: (0..n as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect() }
}

/// A grid over the unit square, with `n` cells per side, at `height(x, y)`.
pub(crate) fn sheet(n: u32, mut height: impl FnMut(f64, f64) -> f64) -> Shape {
    let mut shape = Shape::default();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            shape.points.push([x, y, height(x, y)]);
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = i * (n + 1) + j;
            let b = a + n + 1;
            shape.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    shape
}

/// The unit cube from 0 to 1, each side of two triangles, facing outward.
pub(crate) fn cube() -> Shape {
    let points = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape { points, triangles }
}

/// A ring around the z axis swept along circles: a torus of these radii, or with `rise` a coil that is open
/// at its ends.
pub(crate) fn torus(around: u32, along: u32, [large, small]: [f64; 2]) -> Shape {
    coil(around, along, [large, small], 0.0, 1.0)
}

/// A wire of radius `small` on a helix of radius `large`, with `turns` turns, rising by `rise` per turn;
/// closed if that is 0.
pub(crate) fn coil(around: u32, along: u32, [large, small]: [f64; 2], rise: f64, turns: f64) -> Shape {
    let mut shape = Shape::default();
    let is_closed = rise == 0.0;
    let n_rings = if is_closed { along } else { along + 1 };
    for i in 0..n_rings {
        let u = turns * TAU * f64::from(i) / f64::from(along);
        for j in 0..around {
            let v = TAU * f64::from(j) / f64::from(around);
            let r = large + small * v.cos();
            shape.points.push([r * u.cos(), r * u.sin(), small * v.sin() + rise * u / TAU]);
        }
    }
    for i in 0..along {
        for j in 0..around {
            let at = |i: u32, j: u32| (i % n_rings) * around + j % around;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            shape.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    shape
}
