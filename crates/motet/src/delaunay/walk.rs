//! From the last tet to one in conflict with the newcomer, facet by facet.
//!
//! A visibility walk (Devillers, Pion and Teillaud 2002, *Walking in a triangulation*): cross any facet that has the
//! newcomer on its other side. It cannot go round in circles in a Delaunay triangulation (Edelsbrunner 1989). It
//! stops at the first tet in conflict, mostly one before the tet that holds the point.

use super::conflict::{Newcomer, in_conflict};
use super::store::{FACETS, Store};
use crate::base::Point;
use crate::geometry::predicates::orient;
use crate::geometry::vector::{cross, dot, sub};
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
        let link = exit(store, points, tet, from, new.point, sure)?;
        from = link;
        tet = link >> 2;
    }
}

/// The link across a facet that has `q` strictly on its other side; `entered` is the link by which the walk came.
#[inline(always)]
fn exit(store: &Store, points: &[Point], tet: u32, entered: u32, q: Point, sure: f64) -> Option<u32> {
    let record = &store.tets[tet as usize];
    if record.is_ghost() {
        // Only a walk that starts at a ghost meets one without a conflict.
        return Some(record.links[3]);
    }
    let came_by = if entered >> 2 == tet { entered & 3 } else { 4 };
    let arms = record.vertices.map(|v| sub(points[v as usize], q));
    (0..4)
        .find(|&i| {
            let [a, b, c] = FACETS[i];
            i as u32 != came_by
                && beyond([arms[a], arms[b], arms[c]], sure, || {
                    let [a, b, c] = FACETS[i].map(|j| points[record.vertices[j] as usize]);
                    orient::orient3d(q, a, b, c)
                })
        })
        .map(|i| record.links[i])
}

/// Whether the origin lies strictly beyond a facet given by its `arms`. `sure` bounds the error of any such determinant
/// within the box of all points (static filter); closer calls ask the `exact` sign.
#[inline(always)]
fn beyond([a, b, c]: [Point; 3], sure: f64, exact: impl FnOnce() -> i8) -> bool {
    let determinant = dot(cross(a, b), c);
    if determinant.abs() > sure { determinant < 0.0 } else { exact() < 0 }
}
