//! Vertices moved off the given surface, until it lies on both sides of the new triangles alike, and given
//! lines on both sides of new ones. With all vertices on a curved surface, triangles would lie on one side of
//! it, and each call would take volume from what it encloses.

use super::features::{Kind, length};
use super::sheet::{Change, Sheet};
use super::work::{Work, cosines};
use crate::base::{Point, VertexId};
use crate::geometry::segment;
use crate::geometry::triangle::{area, area_vector, at};
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};

/// Vertices do not move by less than this times the allowed distance, so that planes stay planes.
const STILL: f64 = 0.01;

/// Into how many parts each side of a triangle is divided; at their centroids distances are measured.
const PARTS: usize = 4;
/// Distances are no larger than this times the allowed one.
const REACH: f64 = 2.0;

/// The weights of corners at the centroids of equal parts of a triangle.
fn parts() -> impl Iterator<Item = [f64; 3]> {
    let n = PARTS;
    let of = move |i: usize, j: usize, more: f64| {
        let [u, v] = [i, j].map(|k| (k as f64 + more) / n as f64);
        [u, v, 1.0 - u - v]
    };
    (0..n).flat_map(move |i| (0..n - i).map(move |j| (i, j))).flat_map(move |(i, j)| {
        let turned = (i + j + 1 < n).then(|| of(i, j, 2.0 / 3.0));
        std::iter::once(of(i, j, 1.0 / 3.0)).chain(turned)
    })
}

impl Work<'_> {
    /// Moves vertices by the offset of what is given around them, as far as `admissible` cosines of angles
    /// and the distance allow.
    pub(super) fn fit(&mut self, admissible: f64) {
        let admits = |sheet: &Sheet, change: &Change| {
            let [before, after] = cosines(sheet, change);
            after <= before.max(admissible)
        };
        let offsets = self.offsets();
        for (v, offset) in offsets.into_iter().enumerate() {
            let v = VertexId::new(v);
            let Some(offset) = offset.filter(|by| norm(*by) >= STILL * self.original.distance) else {
                continue;
            };
            let place = add(self.sheet.points[v.index()], offset);
            match self.features.kind(v) {
                Kind::OnLine => self.shift_line(v, place, admits),
                _ => self.shift(v, place, admits),
            };
        }
    }

    /// How far what is given lies from what is new around each vertex; `None` for vertices that stay.
    ///
    /// On a surface it is that along the vertex's normal which takes in its share of the volume between the
    /// two, to first order.
    fn offsets(&self) -> Vec<Option<Point>> {
        let n = self.sheet.points.len();
        let is_free = |v: VertexId| self.features.kind(v) == Kind::Free;
        let normals: Vec<Option<Point>> =
            (0..n).map(VertexId::new).map(|v| self.sheet.normal(v).filter(|_| is_free(v))).collect();
        let triangles: Vec<u32> = self.sheet.existing().collect();
        let of_corners = self.threads.map(triangles.len(), |k| self.at_corners(triangles[k], &normals));
        let mut volumes = vec![[0.0; 2]; n];
        for (&t, of_corners) in triangles.iter().zip(of_corners) {
            for (v, [share, per_offset]) in self.sheet.triangle(t).into_iter().zip(of_corners) {
                volumes[v.index()][0] += share;
                volumes[v.index()][1] += per_offset;
            }
        }
        let of = |v: VertexId| match self.features.kind(v) {
            Kind::Free => {
                let [share, per_offset] = volumes[v.index()];
                normals[v.index()].filter(|_| per_offset > 0.0).map(|n| scale(n, share / per_offset))
            }
            Kind::OnLine => self.offset_of_line(v),
            Kind::Corner => None,
        };
        (0..n).map(|v| of(VertexId::new(v))).collect()
    }

    /// For each corner of a triangle, its share of the volume between the triangle and the given surface, and
    /// the volume that it takes in per unit of offset along its normal.
    fn at_corners(&self, t: u32, normals: &[Option<Point>]) -> [[f64; 2]; 3] {
        let (corners, label) = (self.sheet.corners(t), self.sheet.label(t));
        let normals = self.sheet.triangle(t).map(|v| normals[v.index()]);
        let mut of_corners = [[0.0; 2]; 3];
        if normals == [None; 3] {
            return of_corners;
        }
        let Some(across) = unit(area_vector(corners)) else { return of_corners };
        let part = area(corners) / (PARTS * PARTS) as f64;
        for weights in parts() {
            let place = at(corners, weights);
            let Some(found) = self.original.near(label, place, REACH * self.original.distance) else {
                continue;
            };
            let volume = part * dot(across, sub(found.point, place));
            for (k, normal) in normals.iter().enumerate() {
                if let Some(normal) = normal {
                    of_corners[k][0] += weights[k] * volume;
                    of_corners[k][1] += part * weights[k] * dot(across, *normal);
                }
            }
        }
        of_corners
    }

    /// The mean offset of the given line, each place weighted by the share that the vertex has of it.
    fn offset_of_line(&self, v: VertexId) -> Option<Point> {
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for end in self.features.line_ends(&self.sheet, v) {
            let edge = [end, v];
            let ends = edge.map(|v| self.sheet.points[v.index()]);
            let line = self.features.lines.get(edge)?;
            let offset = |p: &Point| {
                let share = segment::closest(ends, *p);
                (share, sub(*p, segment::at(ends, share)))
            };
            let mut offsets: Vec<(f64, Point)> = line.places.iter().map(offset).collect();
            offsets.extend([(0.0, [0.0; 3]), (1.0, [0.0; 3])]);
            offsets.sort_by(|x, y| x.0.total_cmp(&y.0));
            let length = length(&self.sheet, edge);
            for pair in offsets.windows(2) {
                let [(s, from), (t, to)] = [pair[0], pair[1]];
                // The integral of a product of two linear functions.
                let product = add(scale(from, 2.0 * s + t), scale(to, s + 2.0 * t));
                sum = add(sum, scale(product, length * (t - s) / 6.0));
            }
            total += 0.5 * length;
        }
        (total > 0.0).then(|| scale(sum, 1.0 / total))
    }
}
