//! Triangles that close a rim: rings that shrink towards its middle, each with fewer vertices than the one around it.

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, distance, scale};

/// Triangles between a rim and its middle, counter-clockwise as the rim is; their inner vertices are added to `points`. The rim must be
/// seen whole from its middle. Triangles have about the size of its edges.
pub(super) fn disc(points: &mut Vec<Point>, rim: &[VertexId]) -> Vec<[VertexId; 3]> {
    let corners: Vec<Point> = rim.iter().map(|v| points[v.index()]).collect();
    let n = rim.len() as f64;
    let middle = scale(corners.iter().fold([0.0; 3], |sum, p| add(sum, *p)), 1.0 / n);
    let radius = corners.iter().map(|p| distance(*p, middle)).sum::<f64>() / n;
    let edge = (0..rim.len()).map(|i| distance(corners[i], corners[(i + 1) % rim.len()])).sum::<f64>() / n;
    // Rings at the height of a triangle of equal edges.
    let n_rings = ((radius / (edge * 0.75f64.sqrt())).round() as usize).max(1);
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

/// A smaller copy of a rim, with vertices as far apart as those of the rim.
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

/// Triangles between two rings that both start at one angle: whichever is behind goes on.
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
