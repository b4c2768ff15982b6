//! Parts that surfaces of wires are made of: tubes along polylines, mitred where these bend, and balls. Their
//! volumes are those of round ones.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use crate::base::{Point, VertexId};
use crate::geometry::tet;
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub, unit};
use crate::mesh::shapes::frames::{any_across, reflected, turn};

/// A polyline with a radius at each of its points. Consecutive points are distinct.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wire {
    pub(crate) points: Vec<Point>,
    pub(crate) radii: Vec<f64>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub(crate) closed: bool,
}

/// Triangles that face outward, and their points.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Soup {
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[VertexId; 3]>,
    /// About the length of the edges of each triangle.
    pub(crate) sizes: Vec<f64>,
}

/// The radius at which a regular polygon has its corners that has the area of a circle of radius 1.
pub(crate) fn corner_radius(around: usize) -> f64 {
    let angle = TAU / around as f64;
    (angle / angle.sin()).sqrt()
}

impl Wire {
    /// The number of segments.
    pub(crate) fn n_segments(&self) -> usize {
        self.points.len() - usize::from(!self.closed)
    }

    /// The ends of a segment, as indices of points.
    pub(crate) fn ends(&self, segment: usize) -> [usize; 2] {
        [segment, (segment + 1) % self.points.len()]
    }

    /// The length of a segment.
    pub(crate) fn length(&self, segment: usize) -> f64 {
        let [a, b] = self.ends(segment);
        distance(self.points[a], self.points[b])
    }

    /// The direction of a segment.
    fn along(&self, segment: usize) -> Point {
        let [a, b] = self.ends(segment);
        unit(sub(self.points[b], self.points[a])).unwrap_or([0.0, 0.0, 1.0])
    }

    /// The segments before and after a point; `None` at an end.
    pub(crate) fn around(&self, point: usize) -> Option<[usize; 2]> {
        let n = self.points.len();
        let is_end = !self.closed && (point == 0 || point + 1 == n);
        (!is_end).then(|| [(point + n - 1) % n, point])
    }

    /// The tangent of half the angle by which the line bends at a point: how far the section there leans, in
    /// radii; 0 at an end, infinite where the line turns back.
    pub(crate) fn lean(&self, point: usize) -> f64 {
        let Some([before, after]) = self.around(point) else { return 0.0 };
        let [d, e] = [before, after].map(|segment| self.along(segment));
        let [half_sine, half_cosine] = [norm(sub(e, d)), norm(add(e, d))];
        if half_sine == 0.0 { 0.0 } else { half_sine / half_cosine }
    }

    /// The volume of the tube of round sections along the line: those of the frustums along its segments.
    /// A tube mitred through its centre line has exactly this volume, if its radius is the same everywhere.
    pub(crate) fn volume(&self) -> f64 {
        let of = |segment: usize| {
            let [r, s] = self.ends(segment).map(|point| self.radii[point]);
            PI / 3.0 * (r * r + r * s + s * s) * self.length(segment)
        };
        (0..self.n_segments()).map(of).sum()
    }

    /// Adds a tube with `around` sides along the line, closed at its ends, to a soup. Its sections are
    /// regular polygons of the area of the circles, the first of them turned by `phase`; rings are at most
    /// `spacing` sides apart. At bends rings lie in the planes that halve the angle, so the tube is made of
    /// prisms.
    pub(crate) fn sweep(&self, around: usize, phase: f64, spacing: f64, soup: &mut Soup) {
        let nodes = self.nodes(around, phase);
        let first = soup.points.len();
        let (mut n_rings, mut sizes) = (0, Vec::new());
        for segment in 0..self.n_segments() {
            let [a, b] = self.ends(segment);
            let side = PI * (self.radii[a] + self.radii[b]) / around as f64;
            let n = (self.length(segment) / (side * spacing)).ceil().max(1.0) as usize;
            for step in 0..n {
                let share = step as f64 / n as f64;
                let at = |(p, q): (&Point, &Point)| add(scale(*p, 1.0 - share), scale(*q, share));
                let ring = nodes[a].iter().zip(&nodes[b]);
                // The first ring as it is, to the bit.
                soup.points.extend(ring.map(|pair| if step == 0 { *pair.0 } else { at(pair) }));
                sizes.push(side);
                n_rings += 1;
            }
        }
        if !self.closed {
            soup.points.extend(&nodes[nodes.len() - 1]);
            n_rings += 1;
        }
        let id = |ring: usize, side: usize| VertexId::new(first + ring % n_rings * around + side % around);
        for (ring, &size) in sizes.iter().enumerate() {
            for side in 0..around {
                let [a, b] = [id(ring, side), id(ring, side + 1)];
                let [c, d] = [id(ring + 1, side + 1), id(ring + 1, side)];
                soup.triangles.extend([[a, b, c], [a, c, d]]);
                soup.sizes.extend([size; 2]);
            }
        }
        if !self.closed {
            let [start, end] = [0, 1].map(|k| VertexId::new(soup.points.len() + k));
            soup.points.extend([self.points[0], self.points[self.points.len() - 1]]);
            for side in 0..around {
                soup.triangles.push([start, id(0, side + 1), id(0, side)]);
                soup.triangles.push([end, id(n_rings - 1, side), id(n_rings - 1, side + 1)]);
                soup.sizes.extend([sizes[0], sizes[sizes.len() - 1]]);
            }
        }
    }

    /// The ring at each point of the line. The frame of each segment is that of the one before, turned as the
    /// line bends; on a closed line the angle by which the last misses the first is spread evenly.
    fn nodes(&self, around: usize, phase: f64) -> Vec<Vec<Point>> {
        let n = self.n_segments();
        let mut across = vec![any_across(self.along(0))];
        for segment in 1..n + usize::from(self.closed) {
            let [d, e] = [self.along(segment - 1), self.along(segment % n)];
            across.push(reflected(reflected(across[segment - 1], d), add(d, e)));
        }
        let missed = if self.closed { turn(across[0], across[n], self.along(0)) } else { 0.0 };
        let corner = corner_radius(around);
        let ring = |point: usize| {
            // A ring is the same seen from the segment after and from that before it.
            let segment = point.min(n - 1);
            let along = self.along(segment);
            let [u, v] = [across[segment], cross(along, across[segment])];
            let plane = self.around(point).map(|[before, after]| add(self.along(before), self.along(after)));
            let begin = phase - missed * point as f64 / self.points.len() as f64;
            let place = |side: usize| {
                let (sin, cos) = (begin + TAU * side as f64 / around as f64).sin_cos();
                let offset = scale(add(scale(u, cos), scale(v, sin)), corner * self.radii[point]);
                let lean = plane.map_or(0.0, |plane| -dot(offset, plane) / dot(along, plane));
                add(self.points[point], add(offset, scale(along, lean)))
            };
            (0..around).map(place).collect()
        };
        (0..self.points.len()).map(ring).collect()
    }
}

/// Adds a ball to a soup: an icosahedron whose edges are divided into `parts`, turned by `phase`, with the
/// volume of the round one.
pub(crate) fn add_ball(centre: Point, radius: f64, parts: usize, phase: f64, soup: &mut Soup) {
    let (points, triangles) = unit_ball(parts);
    let first = soup.points.len();
    let volume: f64 =
        triangles.iter().map(|t| tet::volume([[0.0; 3], points[t[0]], points[t[1]], points[t[2]]])).sum();
    let size = radius * (4.0 * PI / 3.0 / volume).cbrt();
    let (sin, cos) = phase.sin_cos();
    let (sin_2, cos_2) = (2.0 * phase + 1.0).sin_cos();
    let turned = |[x, y, z]: Point| {
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        [x, cos_2 * y - sin_2 * z, sin_2 * y + cos_2 * z]
    };
    soup.points.extend(points.iter().map(|p| add(centre, scale(turned(*p), size))));
    soup.triangles.extend(triangles.iter().map(|t| t.map(|v| VertexId::new(first + v))));
    soup.sizes.resize(soup.triangles.len(), TAU * radius / (5 * parts) as f64);
}

/// The points on the unit sphere, and the triangles, of an icosahedron with divided edges.
fn unit_ball(parts: usize) -> (Vec<Point>, Vec<[usize; 3]>) {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (s, t) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([[0.0, s, t], [s, t, 0.0], [t, 0.0, s]]);
    }
    let are_joined = |i: usize, j: usize| i != j && distance(corners[i], corners[j]) < 2.1;
    let (mut points, mut triangles, mut ids) = (Vec::new(), Vec::new(), HashMap::new());
    for (a, b, c) in (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c))))
    {
        if !(are_joined(a, b) && are_joined(b, c) && are_joined(c, a)) {
            continue;
        }
        let outward = dot(corners[a], cross(corners[b], corners[c])) > 0.0;
        let [a, b, c] = if outward { [a, b, c] } else { [a, c, b] };
        let mut at = |i: usize, j: usize| {
            let mut shares = [(a, parts - i - j), (b, i), (c, j)];
            shares.sort_unstable();
            let key: Vec<(usize, usize)> = shares.into_iter().filter(|share| share.1 > 0).collect();
            *ids.entry(key.clone()).or_insert_with(|| {
                let sum = key.iter().fold([0.0; 3], |sum, (v, n)| add(sum, scale(corners[*v], *n as f64)));
                points.push(scale(sum, 1.0 / norm(sum)));
                points.len() - 1
            })
        };
        for i in 0..parts {
            for j in 0..parts - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < parts {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    (points, triangles)
}
