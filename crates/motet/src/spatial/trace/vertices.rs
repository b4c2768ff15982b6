//! Rows of new and moved vertices: their weights in the removed tets that contained their places.

use super::overlaps::Removed;
use super::{ChangedVertex, LocalChange, map};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::tet;
use crate::geometry::vector::{distance, norm, sub};
use crate::mesh::history::Rows;
use crate::spatial::boxes::bounding_box;

/// A place outside a tet by no more than this fraction of the size of the tet's box counts as on the tet.
const ROUND_OFF: f64 = 1e-12;

/// The rows of vertices, how many of them lay outside, and how far at most.
pub(super) struct Vertices {
    pub(super) rows: Rows<VertexId>,
    pub(super) n_outside: usize,
    pub(super) farthest_outside: f64,
}

/// One place: the removed tet that contains it or is nearest to it, its weights there, and how far outside it
/// lies.
struct Place {
    tet: usize,
    weights: [f64; 4],
    outside: f64,
}

pub(super) fn trace(change: &LocalChange<'_>, removed: &Removed<'_>, threads: &Threads) -> Result<Vertices> {
    let mut vertices = change.changed_vertices.to_vec();
    vertices.sort_unstable_by_key(|v| v.vertex);
    let places = map(&vertices, threads, |v| place(removed, change.new_points[v.vertex.index()], v.vertex));
    let mut found = Vertices { rows: Rows::new(), n_outside: 0, farthest_outside: 0.0 };
    for (&ChangedVertex { vertex, was }, place) in vertices.iter().zip(places) {
        let Place { tet, weights, outside } = place?;
        let corners = removed.tets[tet].vertices;
        let largest = (1..4).fold(0, |best, i| if weights[i] > weights[best] { i } else { best });
        let parts = [0, 1, 2, 3].map(|i| (corners[i], weights[i]));
        found.rows.push(vertex, &parts, was.unwrap_or(corners[largest]));
        found.n_outside += usize::from(outside > 0.0);
        found.farthest_outside = found.farthest_outside.max(outside);
    }
    Ok(found)
}

fn place(removed: &Removed<'_>, p: Point, vertex: VertexId) -> Result<Place> {
    if let Some(tet) = holder(removed, p) {
        let weights = tet::closest(removed.solids[tet].corners(), p);
        return Ok(Place { tet, weights, outside: 0.0 });
    }
    let Some((tet, weights)) = removed.nearest(p, None) else {
        let n = removed.tets.len();
        return Err(Error::input(format!("is new at {p:?}, which is not near any of the {n} removed tets"))
            .at(format!("vertex {vertex}"))
            .remedy("list the removed tets that the tets at this vertex replace"));
    };
    let corners = removed.solids[tet].corners();
    let [low, high] = bounding_box(corners);
    let beyond = distance(tet::at(corners, weights), p);
    let outside = if beyond > ROUND_OFF * norm(sub(high, low)) { beyond } else { 0.0 };
    Ok(Place { tet, weights, outside })
}

/// The first removed tet that contains `p`; an inverted one only if no other does.
fn holder(removed: &Removed<'_>, p: Point) -> Option<usize> {
    let mut candidates = Vec::new();
    removed.tree.touching([p, p], &mut candidates);
    let holds = |i: &usize| tet::holds(removed.solids[*i].corners(), p);
    let holders = candidates.into_iter().map(|i| i as usize).filter(holds);
    let mut inverted = None;
    for i in holders {
        if removed.solids[i].is_positive() {
            return Some(i);
        }
        inverted = inverted.or(Some(i));
    }
    inverted
}
