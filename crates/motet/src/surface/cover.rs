//! Whether the new surface stays near all places of the given one: samples of that surface, each attached to
//! a triangle of the new one.

use super::sheet::{Change, Sheet};
use crate::base::{Point, VertexId};
use crate::geometry::triangle::{at, closest, longest_side, middles};
use crate::geometry::vector::distance_squared;
use crate::spatial::{Bounds, bounding_box, squared_distance_to_box};

/// Samples of a triangle are about as far apart as the allowed distance times this, with up to [`MAX_PARTS`]
/// parts of an edge.
const SPACING: f64 = 2.0;
const MAX_PARTS: f64 = 8.0;

/// Samples of the given surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Cover {
    places: Vec<Point>,
    /// The samples of each triangle.
    of_triangle: Vec<Vec<u32>>,
}

/// Where the samples of the removed triangles of a change go: pairs of a sample and the place of a triangle
/// among the new ones.
pub(super) type Moves = Vec<(u32, u32)>;

/// A new triangle of a change.
struct New {
    corners: [Point; 3],
    bounds: Bounds,
    label: u32,
}

impl Cover {
    /// Samples of a sheet that is as it was given: vertices and, of triangles that are large beside the
    /// allowed distance, centroids, middles of edges, and points in between.
    pub(super) fn new(sheet: &Sheet, allowed: f64) -> Self {
        let mut cover = Self { places: Vec::new(), of_triangle: vec![Vec::new(); sheet.n_slots()] };
        let mut is_sampled = vec![false; sheet.points.len()];
        for t in sheet.existing() {
            let corners = sheet.corners(t);
            for v in sheet.triangle(t) {
                if !std::mem::replace(&mut is_sampled[v.index()], true) {
                    cover.add(t, sheet.points[v.index()]);
                }
            }
            let n = (longest_side(corners) / (SPACING * allowed)).floor().min(MAX_PARTS) as usize;
            if n > 0 {
                middles(corners).into_iter().for_each(|place| cover.add(t, place));
            }
            for (i, j) in (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j))).filter(|_| n > 2) {
                let weights = [i, j, n - i - j].map(|k| k as f64 / n as f64);
                // Corners are samples already.
                if weights.iter().all(|w| *w < 1.0) {
                    cover.add(t, at(corners, weights));
                }
            }
        }
        cover
    }

    /// Adds a sample, a place of the given surface, to the nearest triangle of a vertex.
    pub(super) fn add_near(&mut self, sheet: &Sheet, v: VertexId, place: Point) {
        let star = sheet.star(v).iter().map(|&t| (squared_distance(place, sheet.corners(t)), t));
        if let Some((_, t)) = star.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1))) {
            self.add(t, place);
        }
    }

    fn add(&mut self, t: u32, place: Point) {
        self.of_triangle[t as usize].push(self.places.len() as u32);
        self.places.push(place);
    }

    /// Where the samples of a change go: to the nearest new triangle of their label. `None` if one is farther
    /// than `allowed` from all of them.
    pub(super) fn moves(&self, sheet: &Sheet, change: &Change, allowed: f64) -> Option<Moves> {
        let new: Vec<New> = sheet
            .corners_after(change)
            .zip(&change.added)
            .map(|(corners, (_, label))| New { corners, bounds: bounding_box(corners), label: *label })
            .collect();
        let mut moves = Vec::new();
        for &t in &change.removed {
            let label = sheet.label(t);
            for &sample in &self.of_triangle[t as usize] {
                let p = self.places[sample as usize];
                let (mut least, mut nearest) = (f64::INFINITY, None);
                for (k, New { corners, bounds, .. }) in (0..).zip(&new).filter(|(_, new)| new.label == label)
                {
                    if squared_distance_to_box(p, *bounds) < least {
                        let squared = squared_distance(p, *corners);
                        if squared < least {
                            (least, nearest) = (squared, Some(k));
                        }
                    }
                }
                if least > allowed * allowed {
                    return None;
                }
                moves.push((sample, nearest?));
            }
        }
        Some(moves)
    }

    /// Takes over a change that was made; `ids` are those of the new triangles.
    pub(super) fn commit(&mut self, change: &Change, moves: &Moves, ids: &[u32]) {
        for &t in &change.removed {
            self.of_triangle[t as usize].clear();
        }
        let most = ids.iter().max().map_or(0, |&t| t as usize + 1);
        self.of_triangle.resize_with(most.max(self.of_triangle.len()), Vec::new);
        for &(sample, k) in moves {
            self.of_triangle[ids[k as usize] as usize].push(sample);
        }
    }
}

fn squared_distance(p: Point, corners: [Point; 3]) -> f64 {
    distance_squared(at(corners, closest(corners, p)), p)
}
