//! The parts of surfaces, connected where two triangles meet at an edge, and the side that the closed ones
//! face.

use std::cmp::Ordering;

use super::enclosed::volume_sign;
use super::fault::{Fault, FaultKind};
use super::sides::{Side, edges};
use super::surfaces::Surfaces;
use crate::base::{DisjointSets, VertexId};

/// The triangles that have sides, part by part.
pub(super) struct Parts {
    /// Pairs of the first triangle of a part and a triangle of that part; sorted.
    members: Vec<(u32, u32)>,
    /// For each triangle that is the first of its part: whether the part alone uses each edge as often in one
    /// direction as in the other.
    is_closed: Vec<bool>,
}

impl Parts {
    /// Finds the parts. An edge of more than two triangles joins none of them, since it is not clear which
    /// belong together.
    pub(super) fn new(n_triangles: usize, sides: &[Side]) -> Self {
        let mut sets = DisjointSets::new(n_triangles);
        for same in edges(sides) {
            if let [x, y] = same {
                sets.join(x.triangle, y.triangle);
            }
        }
        let mut is_closed = vec![true; n_triangles];
        let mut ways = Vec::new();
        for same in edges(sides) {
            ways.clear();
            ways.extend(same.iter().map(|side| (sets.root(side.triangle), side.is_forward)));
            ways.sort_unstable();
            for of_part in ways.chunk_by(|x, y| x.0 == y.0) {
                let n_forward = of_part.iter().filter(|way| way.1).count();
                is_closed[of_part[0].0 as usize] &= 2 * n_forward == of_part.len();
            }
        }
        let mut members: Vec<_> =
            sides.iter().map(|side| (sets.root(side.triangle), side.triangle)).collect();
        members.sort_unstable();
        members.dedup();
        Self { members, is_closed }
    }

    /// The triangles of each part, in rising order, and whether it is closed and consistently oriented.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Vec<u32>, bool)> {
        let parts = self.members.chunk_by(|x, y| x.0 == y.0);
        parts.map(|part| (part.iter().map(|member| member.1).collect(), self.is_closed[part[0].0 as usize]))
    }

    /// The triangles of the closed parts that face inward.
    pub(super) fn inward(&self, surfaces: &Surfaces) -> Vec<Vec<u32>> {
        let faces_inward = |part: &[u32]| {
            let triangles: Vec<[VertexId; 3]> =
                part.iter().map(|&t| surfaces.triangles[t as usize]).collect();
            volume_sign(surfaces.points, &triangles) == Some(Ordering::Less)
        };
        let closed = self.iter().filter(|(_, is_closed)| *is_closed).map(|(part, _)| part);
        closed.filter(|part| faces_inward(part)).collect()
    }
}

/// A fault for each closed part that faces inward, at its first triangle.
pub(super) fn faults(surfaces: &Surfaces, parts: &Parts) -> Vec<Fault> {
    let fault = |part: Vec<u32>| {
        let first = part[0];
        let vertices = &surfaces.triangles[first as usize];
        let surface = surfaces.surface(first);
        Fault::new(FaultKind::InwardPart, false, surface, vec![first], vertices, surfaces.points)
    };
    parts.inward(surfaces).into_iter().map(fault).collect()
}
