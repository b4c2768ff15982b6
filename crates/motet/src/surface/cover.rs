//! Whether the new surface stays near all places of the given one: samples of that surface, each attached to
//! a triangle of the new one.

use super::sheet::{Change, Sheet};
use crate::base::{Point, VertexId};
use crate::geometry::triangle::{at, distance_squared, is_well_shaped, longest_side, middles};
use crate::geometry::vector::{cross, dot, scale, sub};
use crate::spatial::{Bounds, bounding_box, squared_distance_to_box};

/// Samples of a triangle are about as far apart as the allowed distance times this, or as the size times
/// [`SPACING_OF_SIZE`] if that is more, with up to [`MAX_PARTS`] parts of an edge.
const SPACING: f64 = 2.0;
const SPACING_OF_SIZE: f64 = 0.25;
const MAX_PARTS: f64 = 6.0;

/// Samples nearer to a triangle than this times the allowed distance are on it.
const NEAR: f64 = 0.1;

/// Samples of the given surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Cover {
    samples: Vec<Point>,
    /// The samples of each triangle.
    of_triangle: Vec<Vec<u32>>,
    /// A triangle this near to a sample may have it, even if another is nearer.
    near: f64,
}

/// Where the samples of the removed triangles of a change go: pairs of a sample and the place of a triangle
/// among the new ones.
pub(super) type Moves = Vec<(u32, u32)>;

/// A new triangle of a change, prepared for the distances of many samples.
struct New {
    corners: [Point; 3],
    bounds: Bounds,
    label: u32,
    /// `None` for needles, of which it would say nothing.
    frame: Option<Frame>,
}

struct Frame {
    /// The unit normal.
    normal: Point,
    /// The gradients of the weights of the second and the third corner.
    gradients: [Point; 2],
    /// The heights over the sides opposite to the corners, squared.
    heights: [f64; 3],
}

impl New {
    fn of(corners: [Point; 3], label: u32) -> Self {
        let [a, b, c] = corners;
        let sides = [sub(c, b), sub(a, c), sub(b, a)];
        let normal = cross(sub(b, a), sub(c, a));
        let square = dot(normal, normal);
        let longest = sides.iter().map(|side| dot(*side, *side)).fold(0.0, f64::max);
        let frame = is_well_shaped(square, longest).then(|| Frame {
            normal: scale(normal, 1.0 / square.sqrt()),
            gradients: [sides[1], sides[2]].map(|side| scale(cross(normal, side), 1.0 / square)),
            heights: sides.map(|side| square / dot(side, side)),
        });
        Self { corners, bounds: bounding_box(corners), label, frame }
    }

    /// The squared distance of a point, if it is not above `most`.
    fn squared_distance(&self, p: Point, most: f64) -> Option<f64> {
        if squared_distance_to_box(p, self.bounds) > most {
            return None;
        }
        if let Some(frame) = &self.frame {
            let from_corner = sub(p, self.corners[0]);
            let off_plane = dot(from_corner, frame.normal);
            let [of_second, of_third] = frame.gradients.map(|gradient| dot(from_corner, gradient));
            let weights = [1.0 - of_second - of_third, of_second, of_third];
            // Beyond a side, it is at least as far off as the line of that side.
            let beside = (0..3)
                .filter(|&k| weights[k] < 0.0)
                .map(|k| weights[k] * weights[k] * frame.heights[k])
                .fold(0.0, f64::max);
            let least = off_plane * off_plane + beside;
            if beside == 0.0 || least > most {
                return Some(least).filter(|least| *least <= most);
            }
        }
        Some(distance_squared(self.corners, p)).filter(|found| *found <= most)
    }
}

impl Cover {
    /// Samples of a sheet that is as it was given: vertices and, of triangles that are large beside the
    /// allowed distance, centroids, middles of edges, and points in between.
    pub(super) fn new(sheet: &Sheet, sizes: &[f64], allowed: f64) -> Self {
        let of_triangle = vec![Vec::new(); sheet.n_slots()];
        let mut cover = Self { samples: Vec::new(), of_triangle, near: NEAR * allowed };
        let mut is_taken = vec![false; sheet.points.len()];
        for t in sheet.existing() {
            let corners = sheet.corners(t);
            for v in sheet.triangle(t) {
                if !std::mem::replace(&mut is_taken[v.index()], true) {
                    cover.add(t, sheet.points[v.index()]);
                }
            }
            let size = sheet.triangle(t).map(|v| sizes[v.index()]).into_iter().fold(f64::INFINITY, f64::min);
            let spacing = f64::max(SPACING * allowed, SPACING_OF_SIZE * size);
            let n = (longest_side(corners) / spacing).floor().min(MAX_PARTS) as usize;
            if n == 1 || n == 2 {
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
        let star = sheet.star(v).iter().map(|&t| (distance_squared(sheet.corners(t), place), t));
        if let Some((_, t)) = star.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1))) {
            self.add(t, place);
        }
    }

    fn add(&mut self, t: u32, place: Point) {
        self.of_triangle[t as usize].push(self.samples.len() as u32);
        self.samples.push(place);
    }

    /// Where the samples of a change go: to the nearest new triangle of their label. `None` if one is farther
    /// than `allowed` from all of them.
    pub(super) fn moves(&self, sheet: &Sheet, change: &Change, allowed: f64) -> Option<Moves> {
        let new = sheet.corners_after(change).zip(&change.added);
        let new: Vec<New> = new.map(|(corners, (_, label))| New::of(corners, *label)).collect();
        let mut moves = Vec::new();
        let n = new.len();
        for (own, &t) in change.removed.iter().enumerate() {
            let (own, label) = (own.min(n), sheet.label(t));
            for &sample in &self.of_triangle[t as usize] {
                let p = self.samples[sample as usize];
                // From the triangle that replaces its own one on, since that is nearest as a rule.
                let (mut least, mut nearest) = (f64::INFINITY, None);
                for k in (own..n).chain(0..own).filter(|&k| new[k].label == label) {
                    if let Some(found) = new[k].squared_distance(p, least)
                        && (found, Some(k as u32)) < (least, nearest)
                    {
                        (least, nearest) = (found, Some(k as u32));
                        if least <= self.near * self.near {
                            break;
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
