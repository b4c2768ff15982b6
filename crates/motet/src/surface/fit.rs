//! Vertices moved off the given surface, until it lies on both sides of the new triangles alike, and given
//! lines on both sides of new ones. With all vertices on a curved surface, triangles would lie on one side of
//! it, and each call would take volume from what it encloses.

use super::features::{Kind, length};
use super::sheet::{Change, Sheet};
use super::work::{Work, cosines};
use crate::base::{Point, VertexId};
use crate::geometry::segment;
use crate::geometry::triangle::{at, closest};
use crate::geometry::vector::{add, dot, norm, scale, sub};

/// Vertices do not move by less than this times the allowed distance, so that planes stay planes.
const STILL: f64 = 0.01;

impl Work<'_> {
    /// Moves vertices by the mean offset of what is given around them, as far as `admissible` cosines of
    /// angles and the distance allow.
    pub(super) fn fit(&mut self, admissible: f64) {
        let admits = |sheet: &Sheet, change: &Change| {
            let [before, after] = cosines(sheet, change);
            after <= before.max(admissible)
        };
        let vertices = (0..self.sheet.points.len()).map(VertexId::new);
        let offsets: Vec<Option<Point>> = vertices.clone().map(|v| self.offset(v)).collect();
        for (v, offset) in vertices.zip(offsets) {
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

    /// How far what is given lies from what is new around a vertex; `None` for vertices that stay.
    fn offset(&self, v: VertexId) -> Option<Point> {
        match self.features.kind(v) {
            Kind::Free => self.offset_of_surface(v),
            Kind::OnLine => self.offset_of_line(v),
            Kind::Corner => None,
        }
    }

    /// The mean offset of the given surface along the normal, each place weighted by the share that the
    /// vertex has of it.
    fn offset_of_surface(&self, v: VertexId) -> Option<Point> {
        let star = self.sheet.star(v);
        let normal = self.sheet.normal(v)?;
        let (mut sum, mut total) = (0.0, 0.0);
        for &t in star {
            let corners = self.sheet.corners(t);
            let own = self.sheet.triangle(t).iter().position(|w| *w == v)?;
            for sample in self.cover.samples(t) {
                let weights = closest(corners, sample.place);
                let weight = weights[own] * sample.area;
                sum += weight * dot(normal, sub(sample.place, at(corners, weights)));
                total += weight;
            }
        }
        (total > 0.0).then(|| scale(normal, sum / total))
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
