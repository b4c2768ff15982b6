//! The facets of the surface, in the Delaunay triangulation of the sites.

use hashbrown::HashMap;

use super::field::Field;
use crate::base::{Point, Result, Threads, VertexId, sorted_ids};
use crate::delaunay::Triangulation;
use crate::geometry::vector::{add, cross, dot, is_finite, scale, sub};
use crate::spatial::OUTSIDE;

/// The sites at the corners of a box around everything.
pub(super) const N_AROUND: usize = 8;

/// A facet of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// The sites, counter-clockwise seen from outside.
    pub(super) sites: [VertexId; 3],
    /// The centres of the circumspheres on the inner and the outer side.
    pub(super) centres: [Point; 2],
}

/// What is known of tets, by their sites.
#[derive(Default)]
pub(super) struct Known(HashMap<[VertexId; 4], bool>);

/// The facets of the surface for these sites, the first of which are around everything.
///
/// # Errors
/// When a stop was requested, or when there are too many sites.
pub(super) fn facets(
    sites: &[Point],
    field: &Field,
    known: &mut Known,
    threads: &Threads,
) -> Result<Vec<Facet>> {
    let triangulation = Triangulation::new(sites, threads)?;
    let tets = triangulation.tets();
    let centre = |t: usize| circumcentre(tets[t].map(|v| sites[v.index()]));
    let is_around = |v: &VertexId| v.index() < N_AROUND;
    let before = &known.0;
    let inside: Vec<bool> = threads.map_parts(tets.len(), 256, |t| {
        if tets[t].iter().any(is_around) {
            return false;
        }
        before
            .get(&sorted_ids(tets[t]))
            .copied()
            .unwrap_or_else(|| is_finite(centre(t)) && field.is_inside(centre(t)))
    });
    known.0 = tets.iter().zip(&inside).map(|(tet, inside)| (sorted_ids(*tet), *inside)).collect();
    let mut found = Vec::new();
    for (t, neighbors) in triangulation.neighbors().iter().enumerate().filter(|(t, _)| inside[*t]) {
        let [a, b, c, d] = tets[t];
        for (sites, other) in [[b, c, d], [c, a, d], [a, b, d], [a, c, b]].into_iter().zip(neighbors) {
            if *other != OUTSIDE && !inside[other.index()] {
                found.push(Facet { sites, centres: [centre(t), centre(other.index())] });
            }
        }
    }
    Ok(found)
}

/// The centre of the sphere through four points; not finite if they lie in a plane.
fn circumcentre([a, b, c, d]: [Point; 4]) -> Point {
    let [u, v, w] = [b, c, d].map(|p| sub(p, a));
    let [vw, wu, uv] = [cross(v, w), cross(w, u), cross(u, v)];
    let sum = add(add(scale(vw, dot(u, u)), scale(wu, dot(v, v))), scale(uv, dot(w, w)));
    add(a, scale(sum, 0.5 / dot(u, vw)))
}
