//! Edges where a surface ends, branches or reverses its orientation, and vertices where it touches itself.

use super::fault::{Fault, FaultKind};
use super::sides::{Side, edges};
use super::surfaces::{Role, Surfaces};
use crate::base::{DisjointSets, VertexId};

pub(super) fn faults(surfaces: &Surfaces, sides: &[Side]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for same in edges(sides) {
        let is_boundary = surfaces.role(same[0].surface) == Role::Boundary;
        let (kind, is_fatal) = match same {
            [_] => (FaultKind::OpenEdge, is_boundary),
            [x, y] if x.is_forward != y.is_forward => continue,
            [_, _] => (FaultKind::MisorientedEdge, false),
            // Walls meet there, or surfaces touch: tets conform all the same.
            _ => (FaultKind::NonManifoldEdge, false),
        };
        let triangles = same.iter().map(|side| side.triangle).collect();
        faults.push(Fault::new(kind, is_fatal, same[0].surface, triangles, &same[0].edge, surfaces.points));
    }
    faults.extend(pinched(surfaces, sides));
    faults
}

/// Vertices around which the triangles of a surface, connected where they share an edge, form more than one
/// fan.
fn pinched(surfaces: &Surfaces, sides: &[Side]) -> Vec<Fault> {
    let mut fans = DisjointSets::new(3 * surfaces.triangles.len());
    for same in edges(sides) {
        let first = same[0].corners();
        for side in &same[1..] {
            (0..2).for_each(|end| fans.join(first[end], side.corners()[end]));
        }
    }
    // Each fan once, by its first corner. There is a side for each corner.
    let mut firsts: Vec<(u32, VertexId, u32)> = Vec::new();
    for side in sides {
        let corner = 3 * side.triangle + u32::from(side.corner);
        if fans.root(corner) == corner {
            let vertex = side.edge[usize::from(!side.is_forward)];
            firsts.push((side.surface, vertex, side.triangle));
        }
    }
    firsts.sort_unstable();
    let at_one_vertex = firsts.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)).filter(|same| same.len() > 1);
    let fault = |same: &[(u32, VertexId, u32)]| {
        let triangles = same.iter().map(|first| first.2).collect();
        let (surface, vertex, _) = same[0];
        Fault::new(FaultKind::NonManifoldVertex, false, surface, triangles, &[vertex], surfaces.points)
    };
    at_one_vertex.map(fault).collect()
}
