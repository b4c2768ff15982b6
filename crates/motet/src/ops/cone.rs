//! Filling a cavity by joining one vertex to every facet around it.

use crate::base::VertexId;
use crate::geometry::tet::FACETS;
use crate::kernel::{Change, Complex};

/// Fills the cavity of `change` with tets from `apex` to each facet of its boundary that does not contain it.
/// Returns `false` if one of them is not better than `bar`, or if a wall lies within the cavity.
pub fn cone(complex: &Complex, apex: VertexId, bar: f64, change: &mut Change) -> bool {
    cone_on_edge(complex, apex, None, bar, change)
}

/// Fills a cavity as [`cone`] does, for an apex that lies on an edge: facets at the edge get no tet, and may
/// be walls.
pub(super) fn cone_on_edge(
    complex: &Complex,
    apex: VertexId,
    edge: Option<[VertexId; 2]>,
    bar: f64,
    change: &mut Change,
) -> bool {
    change.fill.clear();
    for i in 0..change.cavity.len() {
        let tet = change.cavity[i];
        let vertices = complex.vertices(tet);
        for (place, facet) in FACETS.into_iter().enumerate() {
            let facet = facet.map(|corner| vertices[corner]);
            if edge.is_some_and(|edge| edge.iter().all(|v| facet.contains(v))) {
                continue;
            }
            let behind = complex.across(tet, place);
            let is_inside = !behind.is_none() && change.cavity.contains(&behind.tet());
            if is_inside && complex.is_wall(tet, place) {
                return false;
            }
            if is_inside || facet.contains(&apex) {
                continue;
            }
            let [a, b, c] = facet;
            if !change.push_above(complex, [a, c, b, apex], complex.region(tet), bar) {
                return false;
            }
        }
    }
    true
}
