//! The building blocks of hard surfaces: boxes, extruded polygons, and transformations without rounding.

use motet::base::{Point, VertexId};
use motet::geometry::predicates::orient3d;

use super::super::Numbers;

/// Triangles over points, and the volume they enclose.
#[derive(Clone, Debug, Default)]
pub(crate) struct Body {
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[VertexId; 3]>,
    pub(crate) volume: Option<f64>,
    pub(crate) has_membranes: bool,
}

impl Body {
    pub(crate) fn new(points: Vec<Point>, triangles: &[[usize; 3]], volume: Option<f64>) -> Self {
        let triangles = triangles.iter().map(|t| t.map(VertexId::new)).collect();
        Self { points, triangles, volume, has_membranes: false }
    }

    /// Scales one axis by a power of two.
    pub(crate) fn scale(&mut self, axis: usize, by: f64) {
        self.points.iter_mut().for_each(|p| p[axis] *= by);
        self.volume = self.volume.map(|v| v * by);
    }

    /// Shifts the body, unless that rounds a coordinate; returns whether it did.
    pub(crate) fn shift(&mut self, by: Point) -> bool {
        let is_exact = |p: &Point| (0..3).all(|k| (p[k] + by[k]) - by[k] == p[k]);
        if !self.points.iter().all(is_exact) {
            return false;
        }
        self.points.iter_mut().for_each(|p| (0..3).for_each(|k| p[k] += by[k]));
        true
    }

    /// Permutes the axes cyclically: x becomes y.
    pub(crate) fn turn(&mut self) {
        self.points.iter_mut().for_each(|p| p.rotate_right(1));
    }

    /// The disjoint union of both bodies; volumes add up.
    pub(crate) fn with(mut self, other: &Self) -> Self {
        let first = self.points.len();
        self.points.extend(&other.points);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| VertexId::new(v.index() + first))));
        self.volume = self.volume.zip(other.volume).map(|(a, b)| a + b);
        self
    }

    pub(crate) fn turned_inside_out(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self.volume = self.volume.map(|v| -v);
        self
    }

    /// Merges points at the same place.
    pub(crate) fn welded(mut self) -> Self {
        let mut ids = std::collections::BTreeMap::new();
        let mut points: Vec<Point> = Vec::new();
        let new: Vec<VertexId> = self
            .points
            .iter()
            .map(|p| {
                // 0.0 and -0.0 are one place.
                *ids.entry(p.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    points.push(*p);
                    VertexId::new(points.len() - 1)
                })
            })
            .collect();
        self.triangles.iter_mut().for_each(|t| *t = t.map(|v| new[v.index()]));
        self.points = points;
        self
    }
}

/// The box between two corners, in twelve triangles.
pub(crate) fn cuboid(low: Point, high: Point) -> Body {
    let points = (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] })).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Body::new(points, &triangles, Some((0..3).map(|k| high[k] - low[k]).product()))
}

/// A quad in two triangles, along a random diagonal.
pub(crate) fn halves([a, b, c, d]: [usize; 4], numbers: &mut Numbers) -> [[usize; 3]; 2] {
    if numbers.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// The side of the line a b on which c lies: 1 left, -1 right, 0 on it. Exact.
pub(crate) fn orient2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let flat = |[x, y]: [f64; 2]| [x, y, 0.0];
    let below = [a[0], a[1], 1.0];
    orient3d(flat(a), flat(b), flat(c), below)
}

/// The triangles of a simple polygon, counter-clockwise, by cutting ears (Meisters 1975); no triangle is
/// flat, and corners on straight sides are kept.
pub(crate) fn ears(polygon: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::new();
    let mut at = 0;
    while left.len() > 3 {
        let n = left.len();
        let ear = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let i = (at..at + n).map(|i| i % n).find(|&i| is_ear(polygon, &left, ear(i))).expect("it is simple");
        triangles.push(ear(i));
        left.remove(i);
        // On with the next but one: fans around one corner are the exception.
        at = i + 1;
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

fn is_ear(polygon: &[[f64; 2]], left: &[usize], ear: [usize; 3]) -> bool {
    let [a, b, c] = ear.map(|i| polygon[i]);
    let is_within = |p: [f64; 2]| orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
    orient2d(a, b, c) > 0 && !left.iter().any(|i| !ear.contains(i) && is_within(polygon[*i]))
}

/// A simple polygon, counter-clockwise, from z = 0 up to `height`.
pub(crate) fn extruded(polygon: &[[f64; 2]], height: f64, numbers: &mut Numbers) -> Body {
    let n = polygon.len();
    let points = [0.0, height].iter().flat_map(|&z| polygon.iter().map(move |&[x, y]| [x, y, z])).collect();
    let caps = ears(polygon);
    let mut triangles: Vec<_> = caps.iter().map(|&[a, b, c]| [a, c, b]).collect();
    triangles.extend(caps.iter().map(|t| t.map(|i| i + n)));
    for i in 0..n {
        let next = (i + 1) % n;
        triangles.extend(halves([i, next, next + n, i + n], numbers));
    }
    Body::new(points, &triangles, Some(height * area(polygon)))
}

/// The area of a polygon, positive when counter-clockwise.
pub(crate) fn area(polygon: &[[f64; 2]]) -> f64 {
    let [ox, oy] = polygon[0];
    let next = polygon.iter().cycle().skip(1);
    let sum: f64 =
        polygon.iter().zip(next).map(|(p, q)| (p[0] - ox) * (q[1] - oy) - (q[0] - ox) * (p[1] - oy)).sum();
    0.5 * sum
}
