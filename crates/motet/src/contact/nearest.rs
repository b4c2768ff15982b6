//! The nearest points of two surfaces over all pairs of triangles, and the triangles that are near enough for
//! a warning.
//!
//! Distances of vertices from the other surface do not suffice: two edges that cross at a distance are
//! nearest between their ends. They are a good bound, though, so that few pairs of triangles are examined.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::results::Nearest;
use super::rule::Rule;
use super::surface_graph::PathSearch;
use crate::base::Threads;
use crate::geometry::distance::triangle_triangle;
use crate::geometry::triangle;

/// A bound is raised by this fraction, so that the pair it came from is found again.
const SLACK: f64 = 1e-9;

/// The nearest pair of triangles within the square root of `start`, which may be the squared distance of a
/// known pair.
pub(super) fn nearest(rule: &Rule<'_>, start: f64, threads: &Threads) -> Option<Nearest> {
    let is_own = std::ptr::eq(rule.a.body, rule.b.body);
    let corners = |[i, j]: [u32; 2]| (rule.a.corners(rule.points, i), rule.b.corners(rule.points, j));
    let bound = start * (1.0 + SLACK) + f64::MIN_POSITIVE;
    let measured = |paths: &mut PathSearch, i: u32, j: u32, bound: f64| {
        if is_own && i >= j || !rule.may_admit([i, j]) {
            return None;
        }
        let (a, b) = corners([i, j]);
        // A pair at the bound counts as well: among equally near pairs, the first one is found.
        let found = triangle_triangle::closest_below(a, b, bound.next_up())?;
        rule.admits([i, j], &found, paths).then_some(found.distance_squared)
    };
    let (_, i, j) = rule.a.tree.closest_pair(&rule.b.tree, bound, threads, measured)?;
    let (a, b) = corners([i, j]);
    let closest = triangle_triangle::closest(a, b);
    Some(Nearest {
        distance: closest.distance(),
        triangles: [i, j],
        vertices: [rule.a.triangles[i as usize], rule.b.triangles[j as usize]],
        points: [triangle::at(a, closest.on_a), triangle::at(b, closest.on_b)],
        features: closest.features(),
        closest,
    })
}

/// The squared distance of two triangles; `None` if the pair does not count.
pub(super) fn distance_squared(rule: &Rule<'_>, [i, j]: [u32; 2]) -> Option<f64> {
    if !rule.may_admit([i, j]) {
        return None;
    }
    let found = triangle_triangle::closest(rule.a.corners(rule.points, i), rule.b.corners(rule.points, j));
    rule.admits([i, j], &found, &mut PathSearch::default()).then_some(found.distance_squared)
}

/// Marks the triangles of both surfaces that are nearer to the other than `warn`; pairs of marked triangles
/// are not measured.
pub(super) fn mark_nearer(rule: &Rule<'_>, warn: f64, near: [&[AtomicBool]; 2], threads: &Threads) {
    let is_own = std::ptr::eq(rule.a.body, rule.b.body);
    rule.a.tree.closest_pair(&rule.b.tree, warn * warn, threads, |paths: &mut PathSearch, i, j, bound| {
        let flags = [&near[0][i as usize], &near[1][j as usize]];
        if is_own && i >= j || flags.iter().all(|flag| flag.load(Relaxed)) || !rule.may_admit([i, j]) {
            return None;
        }
        let (a, b) = (rule.a.corners(rule.points, i), rule.b.corners(rule.points, j));
        let found = triangle_triangle::closest_below(a, b, bound)?;
        if rule.admits([i, j], &found, paths) {
            flags.iter().for_each(|flag| flag.store(true, Relaxed));
        }
        None
    });
}
