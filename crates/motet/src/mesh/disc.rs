//! Fills a closed rim with triangles, in rings that shrink towards its middle, each with fewer vertices than
//! the one around it.

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, distance, scale};

/// Fills a rim with triangles of about the size of its edges, oriented like the rim. The new inner vertices
/// are added to `points`. The whole rim must be visible from its middle, the mean of its vertices.
pub(crate) fn disc(points: &mut Vec<Point>, rim: &[VertexId]) -> Vec<[VertexId; 3]> {
    let n_rings = n_rings(points, rim);
    disc_of_rings(points, rim, n_rings)
}

/// The number of rings for triangles of about the size of the rim's edges: each ring has the height of an
/// equilateral triangle.
pub(crate) fn n_rings(points: &[Point], rim: &[VertexId]) -> usize {
    let at = |i: usize| points[rim[i % rim.len()].index()];
    let (n, middle) = (rim.len() as f64, middle(points, rim));
    let radius = (0..rim.len()).map(|i| distance(at(i), middle)).sum::<f64>() / n;
    let edge = (0..rim.len()).map(|i| distance(at(i), at(i + 1))).sum::<f64>() / n;
    let rings = (radius / (edge * 0.75f64.sqrt())).round() as usize;
    // The ratio means nothing for a rim of zero length; and no rim needs more rings than it has vertices.
    rings.clamp(1, rim.len().max(1))
}

fn middle(points: &[Point], rim: &[VertexId]) -> Point {
    scale(rim.iter().fold([0.0; 3], |sum, v| add(sum, points[v.index()])), 1.0 / rim.len() as f64)
}

/// Fills a rim as [`disc()`] does, with the given number of rings: the triangles stay the same wherever the
/// rim moves.
pub(crate) fn disc_of_rings(points: &mut Vec<Point>, rim: &[VertexId], n_rings: usize) -> Vec<[VertexId; 3]> {
    let corners: Vec<Point> = rim.iter().map(|v| points[v.index()]).collect();
    let middle = middle(points, rim);
    let (mut triangles, mut outer) = (Vec::new(), rim.to_vec());
    for ring in (1..n_rings).rev() {
        let share = ring as f64 / n_rings as f64;
        let inner = shrunk(points, &corners, middle, share);
        zip(&outer, &inner, &mut triangles);
        outer = inner;
    }
    let centre = VertexId::new(points.len());
    points.push(middle);
    triangles.extend((0..outer.len()).map(|i| [outer[i], outer[(i + 1) % outer.len()], centre]));
    triangles
}

/// Adds a copy of a rim, scaled towards its middle by `share`, with vertices about as far apart as those of
/// the rim; returns their ids.
fn shrunk(points: &mut Vec<Point>, rim: &[Point], middle: Point, share: f64) -> Vec<VertexId> {
    let n = ((rim.len() as f64 * share).round() as usize).max(3);
    (0..n)
        .map(|i| {
            let along = i as f64 * rim.len() as f64 / n as f64;
            let (at, rest) = ((along as usize).min(rim.len() - 1), along.fract());
            let on_rim = add(scale(rim[at], 1.0 - rest), scale(rim[(at + 1) % rim.len()], rest));
            points.push(add(scale(middle, 1.0 - share), scale(on_rim, share)));
            VertexId::new(points.len() - 1)
        })
        .collect()
}

/// Adds the triangles between two rings that start at the same angle, advancing on whichever ring is behind.
fn zip(outer: &[VertexId], inner: &[VertexId], triangles: &mut Vec<[VertexId; 3]>) {
    let at = |ring: &[VertexId], i: usize| ring[i % ring.len()];
    let (mut i, mut j) = (0, 0);
    while i < outer.len() || j < inner.len() {
        let next = |i: usize, ring: &[VertexId]| (i as f64 + 0.5) / ring.len() as f64;
        if j == inner.len() || i < outer.len() && next(i, outer) <= next(j, inner) {
            triangles.push([at(outer, i), at(outer, i + 1), at(inner, j)]);
            i += 1;
        } else {
            triangles.push([at(outer, i), at(inner, j + 1), at(inner, j)]);
            j += 1;
        }
    }
}
