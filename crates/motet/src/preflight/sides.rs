//! The sides of triangles, grouped by surface and edge: sorted once, for all queries of what meets at an
//! edge.

use super::surfaces::Surfaces;
use crate::base::VertexId;

/// One side of one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    pub(super) surface: u32,
    /// The ends of the edge, in rising order.
    pub(super) edge: [VertexId; 2],
    pub(super) triangle: u32,
    /// Which corner of the triangle it starts at.
    pub(super) corner: u8,
    /// Whether it runs from the smaller end to the larger.
    pub(super) is_forward: bool,
}

impl Side {
    /// The indices of its triangle's corners at the two ends of `edge`, among all corners.
    pub(super) fn corners(&self) -> [u32; 2] {
        let [start, end] = [self.corner, (self.corner + 1) % 3].map(|k| 3 * self.triangle + u32::from(k));
        if self.is_forward { [start, end] } else { [end, start] }
    }
}

/// The sides of the triangles for which `counts` is `true`, sorted. Sides from a vertex to itself are left
/// out.
pub(super) fn sorted_sides(surfaces: &Surfaces, counts: impl Fn(u32) -> bool) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * surfaces.triangles.len());
    for t in surfaces.ids().filter(|&t| counts(t)) {
        let vertices = surfaces.triangles[t as usize];
        for corner in 0..3u8 {
            let (from, to) = (vertices[usize::from(corner)], vertices[usize::from(corner + 1) % 3]);
            let edge = [from.min(to), from.max(to)];
            let surface = surfaces.surface(t);
            if from != to {
                sides.push(Side { surface, edge, triangle: t, corner, is_forward: from < to });
            }
        }
    }
    sides.sort_unstable();
    sides
}

/// The sides of each edge of each surface, edge by edge.
pub(super) fn edges(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|x, y| (x.surface, x.edge) == (y.surface, y.edge))
}
