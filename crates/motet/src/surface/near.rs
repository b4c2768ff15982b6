//! Triangles near a place, while they change: so that no change makes any cross.

use super::sheet::{Change, Sheet};
use crate::base::{Point, VertexId};
use crate::geometry::distance::triangle_triangle;
use crate::preflight::meet;
use crate::spatial::{Bounds, GrowingBoxes, bounding_box, touch};

/// The middle of an edge is off it by less than this times the largest coordinate.
const ROUNDING: f64 = 1e-14;

/// The boxes of all triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Near {
    boxes: GrowingBoxes,
    found: Vec<u32>,
}

impl Near {
    pub(super) fn new(sheet: &Sheet) -> Self {
        let mut near = Self::default();
        sheet.existing().for_each(|t| near.boxes.add(t, bounding_box(sheet.corners(t))));
        near
    }

    /// Whether the new triangles of a change meet each other or any triangle that stays, other than in the
    /// vertices and edges that they share; what the removed ones met does not count. A change that is
    /// `in_place` leaves the surface where it is up to rounding, and can only meet what is that near.
    pub(super) fn crosses(&mut self, sheet: &mut Sheet, change: &Change, in_place: bool) -> bool {
        let Some((v, place)) = change.placed else { return self.is_met(sheet, change, None, in_place) };
        let is_new = v.index() == sheet.points.len();
        if is_new {
            sheet.points.push(place);
        }
        let before = std::mem::replace(&mut sheet.points[v.index()], place);
        let met = self.is_met(sheet, change, Some((v, before)), in_place);
        match is_new {
            true => drop(sheet.points.pop()),
            false => sheet.points[v.index()] = before,
        }
        met
    }

    /// Whether the new triangles meet others or each other; the placed vertex is where it will be, and was
    /// `before`.
    fn is_met(
        &mut self,
        sheet: &Sheet,
        change: &Change,
        before: Option<(VertexId, Point)>,
        in_place: bool,
    ) -> bool {
        let corners = |t: &[VertexId; 3]| t.map(|v| sheet.points[v.index()]);
        let mut vertices: Vec<VertexId> = change.added.iter().flat_map(|(t, _)| *t).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let bounds = bounding_box(vertices.iter().map(|v| sheet.points[v.index()]));
        let old = |v: VertexId| match before {
            Some((placed, place)) if placed == v => place,
            _ => sheet.points[v.index()],
        };
        self.found.clear();
        self.boxes.touching(bounds, &mut self.found);
        self.found.sort_unstable();
        self.found.dedup();
        let is_far = |other: [Point; 3]| {
            let reach = ROUNDING * bounds.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            // Where triangles meet, signs say so sooner than a common point does, which is exact.
            let is_near = |t: &[Point; 3]| {
                triangle_triangle::meet(*t, other)
                    || triangle_triangle::closest_below(*t, other, reach * reach).is_some()
            };
            in_place && !change.removed.iter().any(|&t| is_near(&sheet.triangle(t).map(old)))
        };
        let added: Vec<([VertexId; 3], Bounds)> =
            change.added.iter().map(|(t, _)| (*t, bounding_box(corners(t)))).collect();
        let met_before = |other| change.removed.iter().any(|&t| meet_at(old, sheet.triangle(t), other));
        let meets_any = |t: u32| {
            let other = sheet.triangle(t);
            let of_other = bounding_box(corners(&other));
            let mut near = added.iter().filter(|(_, bounds)| touch(*bounds, of_other));
            near.any(|(t, _)| meet(&sheet.points, *t, other))
                && !is_far(corners(&other))
                && !met_before(other)
        };
        if self.found.iter().any(|t| !change.removed.contains(t) && meets_any(*t)) {
            return true;
        }
        let is_met = |(k, (t, bounds)): (usize, &([VertexId; 3], Bounds))| {
            let mut others = added[..k].iter().filter(|other| touch(*bounds, other.1));
            others.any(|(other, _)| meet(&sheet.points, *t, *other))
        };
        added.iter().enumerate().any(is_met)
    }

    /// Takes out the triangles that a change removes, before it is made.
    pub(super) fn remove(&mut self, sheet: &Sheet, change: &Change) {
        for &t in &change.removed {
            self.boxes.remove(t, bounding_box(sheet.corners(t)));
        }
    }

    /// Takes in triangles after a change was made.
    pub(super) fn add(&mut self, sheet: &Sheet, ids: &[u32]) {
        ids.iter().for_each(|&t| self.boxes.add(t, bounding_box(sheet.corners(t))));
    }
}

/// Whether two triangles meet, with vertices at these places.
fn meet_at(place: impl Fn(VertexId) -> Point, s: [VertexId; 3], t: [VertexId; 3]) -> bool {
    let mut vertices = [s, t].concat();
    vertices.sort_unstable();
    vertices.dedup();
    let points: Vec<Point> = vertices.iter().map(|v| place(*v)).collect();
    let own = |t: [VertexId; 3]| t.map(|v| VertexId::new(vertices.partition_point(|w| *w < v)));
    meet(&points, own(s), own(t))
}
