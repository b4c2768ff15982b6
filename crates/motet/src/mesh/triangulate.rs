//! Division of surface cells of any kind into triangles.

use crate::base::{Point, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot};
use crate::mesh::CellKind;

/// Triangles of quadratic cells by local vertex indices, middle nodes included.
const TRIANGLE_6: &[[usize; 3]] = &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
const TRIANGLE_7: &[[usize; 3]] = &[[0, 3, 6], [3, 1, 6], [1, 4, 6], [4, 2, 6], [2, 5, 6], [5, 0, 6]];
const QUAD_6: &[[usize; 3]] = &[[0, 4, 5], [0, 5, 3], [4, 1, 2], [4, 2, 5]];
const QUAD_8: &[[usize; 3]] = &[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]];
const QUAD_9: &[[usize; 3]] =
    &[[0, 4, 8], [4, 1, 8], [1, 5, 8], [5, 2, 8], [2, 6, 8], [6, 3, 8], [3, 7, 8], [7, 0, 8]];

/// Calls `put` with the triangles of one surface cell, oriented like the cell. Cells of other dimensions and
/// of unknown kinds have none. Quadratic cells are divided at their middle nodes, so that every vertex is
/// used.
pub fn triangulate(kind: CellKind, cell: &[VertexId], points: &[Point], put: &mut dyn FnMut([VertexId; 3])) {
    let table = match kind {
        CellKind::TRIANGLE => &[[0, 1, 2]][..],
        CellKind::QUADRATIC_TRIANGLE => TRIANGLE_6,
        CellKind::BIQUADRATIC_TRIANGLE => TRIANGLE_7,
        CellKind::QUADRATIC_LINEAR_QUAD => QUAD_6,
        CellKind::QUADRATIC_QUAD => QUAD_8,
        CellKind::BIQUADRATIC_QUAD => QUAD_9,
        CellKind::PIXEL => return clip_ears(&[cell[0], cell[1], cell[3], cell[2]], points, put),
        CellKind::QUAD | CellKind::POLYGON => return clip_ears(cell, points, put),
        CellKind::TRIANGLE_STRIP => return strip(cell, put),
        CellKind::QUADRATIC_POLYGON => {
            let (corners, middles) = cell.split_at(cell.len() / 2);
            let ring: Vec<_> = corners.iter().zip(middles).flat_map(|(&a, &b)| [a, b]).collect();
            return clip_ears(&ring, points, put);
        }
        _ => return,
    };
    table.iter().for_each(|places| put(places.map(|i| cell[i])));
}

/// The triangles of a strip, of which every second one is reversed.
fn strip(cell: &[VertexId], put: &mut dyn FnMut([VertexId; 3])) {
    for (i, w) in cell.windows(3).enumerate() {
        put(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] });
    }
}

/// Triangulates a ring by ear clipping (Meisters 1975), which handles non-convex rings; a convex ring becomes
/// the fan around its first corner. If no ear is left (the ring crosses itself or is flat), the next corner
/// is cut off regardless.
fn clip_ears(ring: &[VertexId], points: &[Point], put: &mut dyn FnMut([VertexId; 3])) {
    let mut left = ring.to_vec();
    let normal = ring_normal(ring, points);
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).map(|i| (i + 1) % n).find(|&i| is_ear(&left, i, normal, points)).unwrap_or(1);
        put(corner(&left, ear));
        left.remove(ear);
    }
    if let [a, b, c] = left[..] {
        put([a, b, c]);
    }
}

/// The corner at `i` between its two neighbours.
fn corner(ring: &[VertexId], i: usize) -> [VertexId; 3] {
    let n = ring.len();
    [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]
}

/// The area vector of a ring (Newell).
fn ring_normal(ring: &[VertexId], points: &[Point]) -> Point {
    let Some(&first) = ring.first() else { return [0.0; 3] };
    ring.windows(2).map(|w| area_vector([first, w[0], w[1]].map(|v| points[v.index()]))).fold([0.0; 3], add)
}

/// Whether the corner at `i` is convex and no other vertex lies in its triangle.
fn is_ear(ring: &[VertexId], i: usize, normal: Point, points: &[Point]) -> bool {
    let ear = corner(ring, i);
    let [a, b, c] = ear.map(|v| points[v.index()]);
    let turns = |x: Point, y: Point, z: Point| dot(area_vector([x, y, z]), normal);
    let within = |v: &VertexId| {
        let p = points[v.index()];
        !ear.contains(v) && [turns(a, b, p), turns(b, c, p), turns(c, a, p)].iter().all(|&t| t >= 0.0)
    };
    turns(a, b, c) > 0.0 && !ring.iter().any(within)
}
