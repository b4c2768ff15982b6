//! Whether edges and facets that a change brings are there already, outside its cavity: possible only where tets overlap.

use std::collections::HashSet;

use crate::base::{TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS};
use crate::kernel::change::Change;
use crate::kernel::check::Reject;
use crate::kernel::complex::Complex;

impl Complex {
    /// Edges and facets that come must not be there already. Where all tets are positive none can be: it would lie within the cavity, with other tets.
    pub(super) fn check_news(&self, change: &Change) -> Result<(), Reject> {
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

/// The tets of some vertices, each list walked once: a vertex of the fill is asked for by many edges and facets.
struct Stars<'a> {
    complex: &'a Complex,
    known: Vec<(VertexId, Vec<TetId>)>,
}

impl Stars<'_> {
    /// Whether a tet that is not in the cavity has all of some vertices, or may have: where the tets of the first do not all hang together by facets.
    fn has_outside(&mut self, vertices: &[VertexId], change: &Change) -> bool {
        let complex = self.complex;
        // A vertex to come is not in the lists yet, or has no tet.
        let is_there = |v: &VertexId| v.index() < complex.points.len() && complex.is_used(*v);
        if !vertices.iter().all(is_there) {
            return false;
        }
        let star = self.of(vertices[0]);
        let has_all = |tet: &TetId| vertices.iter().all(|v| complex.vertices(*tet).contains(v));
        star.iter().any(|tet| has_all(tet) && !change.cavity.contains(tet))
            || star.len() != complex.vertex_to_n_tets[vertices[0].index()] as usize
    }

    fn of(&mut self, vertex: VertexId) -> &[TetId] {
        let known = self.known.iter().position(|(v, _)| *v == vertex).unwrap_or_else(|| {
            self.known.push((vertex, walked(self.complex, vertex)));
            self.known.len() - 1
        });
        &self.known[known].1
    }
}

/// The tets of a vertex that hang together by facets at it.
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
