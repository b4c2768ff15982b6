//! Whether edges and facets that a change inserts exist already, outside its cavity: possible only where tets
//! overlap.

use std::collections::HashSet;

use crate::base::{TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS};
use crate::kernel::change::Change;
use crate::kernel::check::Reject;
use crate::kernel::complex::Complex;

impl Complex {
    /// Checks that new edges and facets do not exist already. If all tets are positive none can: it would lie
    /// within the cavity, inside other tets.
    pub(super) fn check_existing(&self, change: &Change) -> Result<(), Reject> {
        let mut stars = Stars { complex: self, known: Vec::new() };
        let is_in_cavity = |vertices: &[VertexId]| {
            change.cavity.iter().any(|&t| vertices.iter().all(|v| self.vertices(t).contains(v)))
        };
        for tet in &change.fill {
            let edges = EDGES.map(|edge| edge.map(|i| tet.vertices[i]));
            for edge in edges.into_iter().filter(|edge| !is_in_cavity(edge)) {
                if stars.has_outside(&edge, change) {
                    return Err(Reject::Exists(edge));
                }
            }
            for facet in FACETS.map(|facet| facet.map(|i| tet.vertices[i])) {
                if !is_in_cavity(&facet) && stars.has_outside(&facet, change) {
                    return Err(Reject::Exists([facet[0], facet[1]]));
                }
            }
        }
        Ok(())
    }
}

/// The stars of some vertices, each walked once: many edges and facets query the same vertex of the fill.
struct Stars<'a> {
    complex: &'a Complex,
    known: Vec<(VertexId, Vec<TetId>)>,
}

impl Stars<'_> {
    /// Whether a tet outside the cavity has all the vertices, or may have them because the tets of the first
    /// one are not all connected through facets.
    fn has_outside(&mut self, vertices: &[VertexId], change: &Change) -> bool {
        let complex = self.complex;
        // A new vertex is not in the lists yet, or has no tet.
        let is_there = |v: &VertexId| v.index() < complex.n_vertex_slots() && complex.is_used(*v);
        if !vertices.iter().all(is_there) {
            return false;
        }
        let star = self.of(vertices[0]);
        let has_all = |tet: &TetId| vertices.iter().all(|v| complex.vertices(*tet).contains(v));
        star.iter().any(|tet| has_all(tet) && !change.cavity.contains(tet))
            || star.len() != complex.overlaps.n_tets(vertices[0])
    }

    fn of(&mut self, vertex: VertexId) -> &[TetId] {
        let known = self.known.iter().position(|(v, _)| *v == vertex).unwrap_or_else(|| {
            self.known.push((vertex, walked(self.complex, vertex)));
            self.known.len() - 1
        });
        &self.known[known].1
    }
}

/// The tets of a vertex that are connected through facets at it.
fn walked(complex: &Complex, vertex: VertexId) -> Vec<TetId> {
    let mut star = vec![complex.tet_of(vertex)];
    let mut is_found: HashSet<TetId> = star.iter().copied().collect();
    let mut i = 0;
    while let Some(&tet) = star.get(i) {
        i += 1;
        let place = complex.place(tet, vertex);
        for next in (0..4).filter(|&facet| facet != place).map(|facet| complex.across(tet, facet)) {
            if !next.is_none() && is_found.insert(next.tet()) {
                star.push(next.tet());
            }
        }
    }
    star
}
