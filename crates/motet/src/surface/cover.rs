//! Whether the new surface stays near all places of the given one: samples of that surface, each attached to
//! a triangle of the new one.

use super::sheet::{Change, Sheet};
use crate::base::{Point, VertexId};
use crate::geometry::triangle::{area, at, closest, longest_side, middles};
use crate::geometry::vector::distance_squared;
use crate::spatial::{Bounds, bounding_box, squared_distance_to_box};

/// Samples of a triangle are about as far apart as the allowed distance times this, with up to [`MAX_PARTS`]
/// parts of an edge.
const SPACING: f64 = 2.0;
const MAX_PARTS: f64 = 8.0;

/// The shares of a triangle's area of samples at its corners, and at the middles of its sides and the
/// centroid: exact for cubic functions.
const AT_CORNER: f64 = 1.0 / 20.0;
const AT_MIDDLES: [f64; 4] = [2.0 / 15.0, 2.0 / 15.0, 2.0 / 15.0, 9.0 / 20.0];

/// A sample of the given surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) place: Point,
    /// The area of the given surface that it stands for; 0 for those that are there to be near alone.
    pub(super) area: f64,
}

/// Samples of the given surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Cover {
    samples: Vec<Sample>,
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
        let mut cover = Self { samples: Vec::new(), of_triangle: vec![Vec::new(); sheet.n_slots()] };
        let mut at_vertices = vec![None; sheet.points.len()];
        for t in sheet.existing() {
            let corners = sheet.corners(t);
            let area = area(corners);
            let n = (longest_side(corners) / (SPACING * allowed)).floor().min(MAX_PARTS) as usize;
            let at_corner = match n {
                0 => 1.0 / 3.0,
                1 | 2 => AT_CORNER,
                _ => 1.0 / (3 * n * n) as f64,
            };
            for v in sheet.triangle(t) {
                let place = sheet.points[v.index()];
                let sample =
                    *at_vertices[v.index()].get_or_insert_with(|| cover.add(t, Sample { place, area: 0.0 }));
                cover.samples[sample as usize].area += at_corner * area;
            }
            if n > 0 {
                let shares = if n > 2 { [0.0; 4] } else { AT_MIDDLES };
                for (place, share) in middles(corners).into_iter().zip(shares) {
                    cover.add(t, Sample { place, area: share * area });
                }
            }
            for (i, j) in (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j))).filter(|_| n > 2) {
                let weights = [i, j, n - i - j].map(|k| k as f64 / n as f64);
                // Corners are samples already.
                if weights.iter().all(|w| *w < 1.0) {
                    let is_inside = weights.iter().all(|w| *w > 0.0);
                    let share = if is_inside { 2.0 } else { 1.0 } / (n * n) as f64;
                    cover.add(t, Sample { place: at(corners, weights), area: share * area });
                }
            }
        }
        cover
    }

    /// Adds a sample, a place of the given surface, to the nearest triangle of a vertex.
    pub(super) fn add_near(&mut self, sheet: &Sheet, v: VertexId, place: Point) {
        let star = sheet.star(v).iter().map(|&t| (squared_distance(place, sheet.corners(t)), t));
        if let Some((_, t)) = star.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1))) {
            self.add(t, Sample { place, area: 0.0 });
        }
    }

    /// The samples of a triangle.
    pub(super) fn samples(&self, t: u32) -> impl Iterator<Item = Sample> + '_ {
        self.of_triangle[t as usize].iter().map(|&sample| self.samples[sample as usize])
    }

    fn add(&mut self, t: u32, sample: Sample) -> u32 {
        let id = self.samples.len() as u32;
        self.of_triangle[t as usize].push(id);
        self.samples.push(sample);
        id
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
        let n = new.len();
        for (own, &t) in change.removed.iter().enumerate() {
            let (own, label) = (own.min(n), sheet.label(t));
            for &sample in &self.of_triangle[t as usize] {
                let p = self.samples[sample as usize].place;
                // From the triangle that replaces its own one on, since that is nearest as a rule.
                let (mut least, mut nearest) = (f64::INFINITY, None);
                for k in (own..n).chain(0..own) {
                    let New { corners, bounds, label: of } = &new[k];
                    if *of == label && squared_distance_to_box(p, *bounds) <= least {
                        let found = (squared_distance(p, *corners), Some(k as u32));
                        if found < (least, nearest) {
                            (least, nearest) = found;
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
