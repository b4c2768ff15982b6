//! Walks from the last tet to one in conflict with the newcomer, facet by facet.
//!
//! This is a visibility walk (Devillers, Pion and Teillaud 2002, *Walking in a triangulation*): it crosses
//! any facet that has the newcomer on its other side. It cannot cycle in a Delaunay triangulation
//! (Edelsbrunner 1989). It stops at the first tet in conflict, usually one before the tet that contains the
//! point.

use super::conflict::{FROZEN, Newcomer, in_conflict};
use super::parts::Part;
use super::store::{FACETS, Tets, is_ghost};
use crate::base::Point;
use crate::geometry::fused::{cross, dot};
use crate::geometry::predicates::orient;
use crate::geometry::vector::sub;
use pulp::Simd;

/// Finds a tet in conflict; `None` where that tet, or one on the way to it, may not be touched, or where
/// there is none because the newcomer is a vertex already.
#[inline(always)]
pub(super) fn walk<S: Simd>(
    simd: S,
    tets: Tets,
    points: &[Point],
    start: u32,
    new: Newcomer,
    part: Part,
    sure: f64,
) -> Option<u32> {
    let mut tet = start;
    let mut from = u32::MAX;
    loop {
        let is_frozen = tets.gauges.mark(tet) == FROZEN;
        if is_frozen && is_ghost(tets.vertices.get(tet)) {
            // Whatever is beyond the hull is in conflict. The tet behind it can belong to another part.
            return None;
        }
        if in_conflict(simd, tets, points, tet, new) {
            return (!is_frozen).then_some(tet);
        }
        let facet = exit::<S>(tets, points, tet, from, new.point, sure)?;
        from = tets.links.get(tet)[facet % 4];
        if is_frozen && part.is_beyond(tets.vertices.get(from >> 2)) {
            return None;
        }
        tet = from >> 2;
    }
}

/// A facet that has `q` strictly on its other side; `entered` is the link by which the walk entered the tet.
/// `sure` bounds the error of any determinant within the box of all points (static filter); closer cases are
/// decided by the exact sign.
#[inline(always)]
fn exit<S: Simd>(tets: Tets, points: &[Point], tet: u32, entered: u32, q: Point, sure: f64) -> Option<usize> {
    let vertices = tets.vertices.get(tet);
    if is_ghost(vertices) {
        // Only a walk that starts at a ghost meets one without a conflict.
        return Some(3);
    }
    let entered_facet = if entered >> 2 == tet { entered & 3 } else { 4 };
    let arm = |i: usize| sub(points[vertices[i] as usize], q);
    let arms = [arm(0), arm(1), arm(2), arm(3)];
    // All four at once: which facet it is cannot be predicted, so a branch for each costs more than the
    // arithmetic.
    let (mut beyond, mut decided) = (0u32, 0u32);
    for (i, [a, b, c]) in FACETS.into_iter().enumerate() {
        let determinant = dot::<S>(cross::<S>(arms[a], arms[b]), arms[c]);
        beyond |= u32::from(determinant < -sure) << i;
        decided |= u32::from(determinant.abs() > sure) << i;
    }
    let others = 0b1111 & !(1 << entered_facet);
    if beyond & others != 0 {
        return Some((beyond & others).trailing_zeros() as usize);
    }
    let doubtful = others & !decided;
    let exact = |i: u32| {
        let [a, b, c] = FACETS[i as usize].map(|j| points[vertices[j] as usize]);
        orient::orient3d(q, a, b, c) < 0
    };
    (0..4).find(|&i| doubtful & 1 << i != 0 && exact(i)).map(|i| i as usize)
}
