//! From the last tet to one in conflict with the newcomer, facet by facet.
//!
//! A visibility walk (Devillers, Pion and Teillaud 2002, *Walking in a triangulation*): cross any facet that has the
//! newcomer on its other side. It cannot go round in circles in a Delaunay triangulation (Edelsbrunner 1989). It
//! stops at the first tet in conflict, mostly one before the tet that holds the point.

use super::conflict::{Newcomer, in_conflict};
use super::store::{FACETS, Store, is_ghost};
use crate::base::Point;
use crate::geometry::fused::{cross, dot};
use crate::geometry::predicates::orient;
use crate::geometry::vector::sub;
use pulp::Simd;

/// Finds a tet in conflict. `None` when there is none: the newcomer is a vertex already.
#[inline(always)]
pub(super) fn walk<S: Simd>(
    simd: S,
    store: &Store,
    points: &[Point],
    start: u32,
    new: Newcomer,
    sure: f64,
) -> Option<u32> {
    let mut tet = start;
    let mut from = u32::MAX;
    loop {
        if in_conflict(simd, store, points, tet, new) {
            return Some(tet);
        }
        let link = exit::<S>(store, points, tet, from, new.point, sure)?;
        from = link;
        tet = link >> 2;
    }
}

/// The link across a facet that has `q` strictly on its other side; `entered` is the link by which the walk came.
#[inline(always)]
fn exit<S: Simd>(
    store: &Store,
    points: &[Point],
    tet: u32,
    entered: u32,
    q: Point,
    sure: f64,
) -> Option<u32> {
    let (vertices, links) = (store.vertices[tet as usize], store.links[tet as usize]);
    if is_ghost(vertices) {
        // Only a walk that starts at a ghost meets one without a conflict.
        return Some(links[3]);
    }
    let came_by = if entered >> 2 == tet { entered & 3 } else { 4 };
    let arm = |i: usize| sub(points[vertices[i] as usize], q);
    let arms = [arm(0), arm(1), arm(2), arm(3)];
    for (i, [a, b, c]) in FACETS.into_iter().enumerate() {
        let exact = || {
            orient::orient3d(
                q,
                points[vertices[a] as usize],
                points[vertices[b] as usize],
                points[vertices[c] as usize],
            )
        };
        if i as u32 != came_by && beyond::<S>([arms[a], arms[b], arms[c]], sure, exact) {
            return Some(links[i]);
        }
    }
    None
}

/// Whether the origin lies strictly beyond a facet given by its `arms`. `sure` bounds the error of any such determinant
/// within the box of all points (static filter); closer calls ask the `exact` sign.
#[inline(always)]
fn beyond<S: Simd>([a, b, c]: [Point; 3], sure: f64, exact: impl FnOnce() -> i8) -> bool {
    let determinant = dot::<S>(cross::<S>(a, b), c);
    if determinant.abs() > sure { determinant < 0.0 } else { exact() < 0 }
}
