//! Seams: where a surface continues at the same places under other vertex ids.
//!
//! Files that store the corners of each triangle separately (STL), or repeat vertices for each normal,
//! texture or part (OBJ, PLY, CAD), have several vertices at one place. Such a surface may be closed, but its
//! connectivity shows open edges.

use crate::base::{Csr, Point, VertexId};
use crate::mesh::firsts_at_place;

/// The edges that triangles traverse more often in one direction than in the other, each once, with its ends
/// in rising order. A surface without open edges has an inside: its winding number around each point is an
/// integer. Sides that begin and end at the same vertex do not count.
pub fn open_edges(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let n_points = triangles.as_flattened().iter().map(|v| v.index() + 1).max().unwrap_or(0);
    let ways = |&[a, b, c]: &[VertexId; 3]| [[a, b], [b, c], [c, a]].into_iter().filter(|[u, v]| u != v);
    let edges = Csr::from_pairs(n_points, || {
        triangles.iter().flat_map(ways).map(|[u, v]| (u.min(v).index(), (u.max(v), u < v)))
    });
    let (mut sorted, mut open) = (Vec::new(), Vec::new());
    for (u, from_one) in edges.iter().enumerate() {
        sorted.clear();
        sorted.extend_from_slice(from_one);
        sorted.sort_unstable();
        let is_open = |uses: &&[(VertexId, bool)]| 2 * uses.iter().filter(|x| x.1).count() != uses.len();
        let of_one = sorted.chunk_by(|x, y| x.0 == y.0).filter(is_open);
        open.extend(of_one.map(|uses| [VertexId::new(u), uses[0].0]));
    }
    open
}

/// The duplicate vertices along seams, each paired with the first vertex at its place: both are ends of [open
/// edges](open_edges), at exactly the same place. In rising order.
///
/// Vertices that are not on an open edge are not listed, whatever else lies at their place: the two sides of
/// a slit, or two bodies that touch, are not one surface.
///
/// Panics if a triangle names a point beyond `points`.
pub fn seams(points: &[Point], triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let mut rim: Vec<VertexId> = open_edges(triangles).into_iter().flatten().collect();
    rim.sort_unstable();
    rim.dedup();
    let places: Vec<Point> = rim.iter().map(|v| points[v.index()]).collect();
    let firsts = firsts_at_place(&places);
    let repeated = (0..rim.len()).filter(|&i| firsts[i].index() != i);
    repeated.map(|i| [rim[i], rim[firsts[i].index()]]).collect()
}

/// The triangles with every duplicate vertex along a [seam](seams) replaced by the first vertex at its place.
///
/// Panics if a triangle names a point beyond `points`.
pub fn seamless(points: &[Point], triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 3]> {
    let repeated = seams(points, triangles);
    let first = |v: VertexId| repeated.binary_search_by_key(&v, |pair| pair[0]).map_or(v, |i| repeated[i][1]);
    triangles.iter().map(|t| t.map(first)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Surface;
    use crate::mesh::shapes::ball;

    #[test]
    fn a_soup_has_the_seams_of_its_surface_and_a_slit_has_none() {
        let surface = Surface::boundary_of(&ball(2, 1));
        assert!(
            open_edges(&surface.triangles).is_empty()
                && seams(&surface.points, &surface.triangles).is_empty()
        );
        let points: Vec<Point> =
            surface.triangles.as_flattened().iter().map(|v| surface.points[v.index()]).collect();
        let n = surface.triangles.len() as u32;
        let soup: Vec<[VertexId; 3]> = (0..n).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(VertexId)).collect();
        assert_eq!(open_edges(&soup).len(), soup.len() * 3);
        let repeated = seams(&points, &soup);
        assert_eq!(points.len() - repeated.len(), surface.vertices().len());
        assert!(open_edges(&seamless(&points, &soup)).is_empty());
        assert!(repeated.iter().all(|[v, first]| first < v && points[v.index()] == points[first.index()]));
        // The same ball twice, each closed under ids of its own: no vertex is on an open edge.
        let shift = surface.points.len() as u32;
        let again = surface.triangles.iter().map(|t| t.map(|v| VertexId(v.0 + shift)));
        let twice: Vec<[VertexId; 3]> = surface.triangles.iter().copied().chain(again).collect();
        assert!(seams(&[&surface.points[..], &surface.points].concat(), &twice).is_empty());
    }
}
