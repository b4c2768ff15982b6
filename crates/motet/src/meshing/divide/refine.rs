//! Makes the triangles of flat facets small and regular by Delaunay refinement (Ruppert 1995, *A Delaunay
//! refinement algorithm for quality 2-dimensional mesh generation*).
//!
//! The circumcentre of a triangle that is too large or too narrow is inserted; if a crease is in the way, the
//! crease is divided instead.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::triangulation::{Blocked, Plane, TriangleId, Triangulation};
use crate::base::{Point, Result, VertexId, Watch};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};

/// A triangle is too large if its circumradius exceeds this fraction of the size. Edges are then about as
/// long as the size on average.
const LARGE: f64 = 0.75;
/// A triangle is too narrow if its circumradius exceeds this multiple of its shortest edge: it has an angle
/// below 25 degrees.
const NARROW: f64 = 1.183;
/// Edges shorter than this fraction of the size are not made, and do not make a triangle count as narrow:
/// creases closer together leave narrow triangles.
const MIN_EDGE: f64 = 0.062_5;

/// A triangle to be divided; those with the largest circumradius come first.
#[derive(PartialEq)]
struct Candidate {
    radius: f64,
    triangle: TriangleId,
    vertices: [VertexId; 3],
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.radius.total_cmp(&other.radius).then(other.triangle.cmp(&self.triangle))
    }
}

/// Divides creases into parts of about `size`.
pub(super) fn divide_creases(triangulation: &mut Triangulation, size: f64, watch: &Watch) -> Result<()> {
    let creases = triangulation.creases();
    for (i, &[a, b]) in creases.iter().enumerate() {
        watch.report_and_check("dividing the surface", i, creases.len())?;
        let [p, q] = [triangulation.point(a), triangulation.point(b)];
        let n = (distance(p, q) / size).round() as usize;
        // By bisection, so that few triangles see each point.
        let mut todo = vec![([a, b], [0, n.max(1)])];
        while let Some(([from, to], [low, high])) = todo.pop() {
            let middle = (low + high) / 2;
            if middle == low {
                continue;
            }
            let share = middle as f64 / n as f64;
            let point = std::array::from_fn(|k| {
                if share == 0.5 { 0.5 * (p[k] + q[k]) } else { p[k] + share * (q[k] - p[k]) }
            });
            let Some((new, _)) = triangulation.divide([from, to], point) else { continue };
            todo.extend([([from, new], [low, middle]), ([new, to], [middle, high])]);
        }
    }
    Ok(())
}

/// Divides triangles until none is too large, or too narrow unless its small angle lies between two creases.
/// At most `most` points are inserted.
pub(super) fn refine(triangulation: &mut Triangulation, size: f64, most: usize, watch: &Watch) -> Result<()> {
    let mut heap: BinaryHeap<Candidate> = (0..triangulation.triangles.len() as TriangleId)
        .filter_map(|t| candidate(triangulation, t, size))
        .collect();
    let (mut n_made, mut n_tried) = (0, 0);
    while let Some(Candidate { triangle, vertices, .. }) = heap.pop() {
        if triangulation.triangles[triangle as usize] != vertices {
            continue;
        }
        n_tried += 1;
        watch.report_and_check("dividing the surface", n_tried, n_tried + heap.len())?;
        if n_made >= most {
            break;
        }
        let corners = triangulation.corners(triangle);
        let inserted = match triangulation.insert(
            triangle,
            circumcentre(corners, &triangulation.planes[triangulation.facet_of[triangle as usize] as usize]),
        ) {
            Ok(inserted) => inserted,
            Err(Blocked::NoSpace) => continue,
            Err(Blocked::By([a, b])) => {
                let [p, q] = [triangulation.point(a), triangulation.point(b)];
                if distance(p, q) < 2.0 * MIN_EDGE * size {
                    continue;
                }
                let Some((_, inserted)) = triangulation.divide([a, b], scale(add(p, q), 0.5)) else {
                    continue;
                };
                // What the crease hid may be visible now.
                heap.extend(candidate(triangulation, triangle, size).filter(|w| w.vertices == vertices));
                inserted
            }
        };
        n_made += 1;
        heap.extend(inserted.into_iter().filter_map(|t| candidate(triangulation, t, size)));
    }
    Ok(())
}

/// Returns a triangle if it must be divided.
fn candidate(triangulation: &Triangulation, triangle: TriangleId, size: f64) -> Option<Candidate> {
    let vertices = triangulation.triangles[triangle as usize];
    let corners = triangulation.corners(triangle);
    let lengths: [f64; 3] = std::array::from_fn(|i| distance(corners[i], corners[(i + 1) % 3]));
    let shortest = (0..3).min_by(|&i, &j| lengths[i].total_cmp(&lengths[j])).unwrap_or(0);
    let area = norm(area_vector(corners));
    let radius = lengths[0] * lengths[1] * lengths[2] / (4.0 * area);
    let is_crease = |i: usize| triangulation.is_crease([vertices[i], vertices[(i + 1) % 3]]);
    // An angle between two creases cannot be changed.
    let is_given = || (0..3).filter(|&i| i != shortest).all(is_crease);
    let is_narrow =
        || radius > NARROW * lengths[shortest] && lengths[shortest] > MIN_EDGE * size && !is_given();
    (radius > LARGE * size || is_narrow()).then_some(Candidate { radius, triangle, vertices })
}

/// The circumcentre of a triangle, in the plane of its facet.
fn circumcentre([a, b, c]: [Point; 3], plane: &Plane) -> Point {
    let [u, v] = [sub(b, a), sub(c, a)];
    let w = cross(u, v);
    let to = add(scale(cross(w, u), dot(v, v)), scale(cross(v, w), dot(u, u)));
    plane.project(add(a, scale(to, 0.5 / dot(w, w))))
}
