//! Flat parts of a surface, and which of them are caps.

use super::neighbors::{NONE, neighbors};
use crate::base::{Point, VertexId};
use crate::geometry::triangle::{area_vector, centroid};
use crate::geometry::vector::{self, add, dot, norm, scale, sub};

/// The largest distance of a corner from the plane of a part's largest triangle, relative to its distance
/// from the middle of that triangle. A plane rounded to single precision is ten times flatter, and walls are
/// curved far more.
const FLAT: f64 = 1e-3;

/// The cosine of the smallest angle of a sharp crease: 45 degrees.
const SHARP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Sets of triangles in one plane, connected by edges.
#[derive(Debug, Default)]
pub(super) struct Flats {
    /// The part of each triangle; [`NONE`] for those that were not considered.
    pub(super) of: Vec<u32>,
    /// The unit normal of each part.
    pub(super) normals: Vec<Point>,
}

impl Flats {
    /// Finds the flat parts among the triangles for which `wanted` holds.
    pub(super) fn find(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        behind: &[[u32; 3]],
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let corners = |t: usize| triangles[t].map(|v| points[v.index()]);
        let areas: Vec<Point> = (0..triangles.len()).map(|t| area_vector(corners(t))).collect();
        let mut order: Vec<usize> = (0..triangles.len()).filter(|&t| wanted(t)).collect();
        order.sort_by(|&s, &t| norm(areas[t]).total_cmp(&norm(areas[s])).then(s.cmp(&t)));
        let mut flats = Self { of: vec![NONE; triangles.len()], normals: Vec::new() };
        for seed in order {
            if flats.of[seed] != NONE {
                continue;
            }
            let part = flats.normals.len() as u32;
            let (normal, middle) = (unit(areas[seed]), centroid(corners(seed)));
            let is_flat = |t: usize| {
                let offsets = corners(t).map(|p| sub(p, middle));
                offsets.iter().all(|&o| dot(o, normal).abs() <= FLAT * norm(o))
            };
            let (mut todo, mut sum) = (vec![seed], [0.0; 3]);
            flats.of[seed] = part;
            while let Some(t) = todo.pop() {
                sum = add(sum, areas[t]);
                for &next in behind[t].iter().filter(|&&next| next != NONE) {
                    let next = next as usize;
                    if flats.of[next] == NONE && wanted(next) && is_flat(next) {
                        flats.of[next] = part;
                        todo.push(next);
                    }
                }
            }
            flats.normals.push(unit(sum));
        }
        flats
    }

    /// Finds the parts of triangles for which `wanted` holds, connected by edges, flat or not. Where a part
    /// ends a vessel, all around across its walls, its normal is the mean one, turned; zero where it
    /// continues the walls.
    pub(super) fn ends(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        behind: &[[u32; 3]],
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let area = |t: usize| area_vector(triangles[t].map(|v| points[v.index()]));
        let mut parts = Self { of: vec![NONE; triangles.len()], normals: Vec::new() };
        for seed in (0..triangles.len()).filter(|&t| wanted(t)) {
            if parts.of[seed] != NONE {
                continue;
            }
            let part = parts.normals.len() as u32;
            let (mut todo, mut sum, mut total, mut walls) = (vec![seed], [0.0; 3], 0.0, Vec::new());
            parts.of[seed] = part;
            while let Some(t) = todo.pop() {
                (sum, total) = (add(sum, area(t)), total + norm(area(t)));
                for &next in behind[t].iter().filter(|&&next| next != NONE) {
                    let next = next as usize;
                    if !wanted(next) {
                        walls.push(next);
                    } else if parts.of[next] == NONE {
                        parts.of[next] = part;
                        todo.push(next);
                    }
                }
            }
            let normal = scale(unit(sum), -1.0);
            let across = walls.iter().filter(|&&t| -dot(unit(area(t)), normal) < SHARP).count();
            let is_end = norm(sum) >= ONE_WAY * total && across as f64 >= MOST * walls.len() as f64;
            parts.normals.push(if is_end { normal } else { [0.0; 3] });
        }
        parts
    }
}

/// The least area of an end as seen along its normal, relative to its area.
const ONE_WAY: f64 = 0.8;

/// The least fraction of the triangles around an end that stand across it.
const MOST: f64 = 0.9;

/// The fewest triangles of a cap: on a rough wall single triangles may stand out.
const MIN_TRIANGLES: usize = 3;

/// For each triangle, whether it is on a cap: a flat part with a sharp crease all around. If all would be,
/// none is.
pub(in crate::meshing) fn is_on_cap(points: &[Point], triangles: &[[VertexId; 3]]) -> Vec<bool> {
    let behind = neighbors(triangles);
    let flats = Flats::find(points, triangles, &behind, |_| true);
    let normal = |t: usize| unit(area_vector(triangles[t].map(|v| points[v.index()])));
    let mut counts = vec![0; flats.normals.len()];
    flats.of.iter().for_each(|&part| counts[part as usize] += 1);
    let mut is_cap: Vec<bool> = counts.iter().map(|&n| n >= MIN_TRIANGLES).collect();
    for (t, next) in behind.iter().enumerate() {
        let part = flats.of[t] as usize;
        let beyond = next.iter().filter(|&&s| s != NONE && flats.of[s as usize] != flats.of[t]);
        is_cap[part] &= !beyond.into_iter().any(|&s| dot(flats.normals[part], normal(s as usize)) > SHARP);
    }
    let of_caps: Vec<bool> = flats.of.iter().map(|&part| is_cap[part as usize]).collect();
    if of_caps.iter().all(|cap| *cap) { vec![false; triangles.len()] } else { of_caps }
}

/// The unit vector in a direction; zero if there is none.
pub(super) fn unit(v: Point) -> Point {
    vector::unit(v).unwrap_or_default()
}
