//! Flat facets of surfaces: triangles in one plane, exactly or up to rounding, that belong to the same
//! patches of the same surfaces.

use super::triangulation::Plane;
use crate::base::{DisjointSets, Point, VertexId, sorted_ids};
use crate::delaunay::flat_facets;
use crate::geometry::rounding;
use crate::geometry::triangle::area;
use crate::meshing::sheet::{Label, Sheet};

/// Flat facets.
pub(super) struct Facets {
    /// The facet of each triangle.
    pub(super) facet_of: Vec<u32>,
    /// The plane of each facet, with the orientation of its triangles.
    pub(super) planes: Vec<Plane>,
    /// For each facet, how the surfaces that contain its triangles use them.
    pub(super) labels: Vec<Vec<Label>>,
}

impl Facets {
    /// Finds the facets of a sheet; `None` if a triangle has no plane in floating-point arithmetic.
    pub(super) fn find(points: &[Point], sheet: &Sheet) -> Option<Self> {
        let corners = |i: usize| sheet.triangles[i].map(|v| points[v.index()]);
        let roots = roots(points, sheet);
        // The plane of a facet is that of its largest triangle.
        let mut largest: Vec<usize> = (0..roots.len()).collect();
        for (i, &root) in roots.iter().enumerate() {
            if area(corners(i)) > area(corners(largest[root])) {
                largest[root] = i;
            }
        }
        let plane_of = |i: usize| Plane::of(corners(largest[i]));
        let mut is_whole = vec![true; roots.len()];
        for (i, &root) in roots.iter().enumerate() {
            is_whole[root] = is_whole[root] && plane_of(root)?.turn(corners(i)) > 0;
        }
        let mut number = vec![None; roots.len()];
        let mut facets = Self { facet_of: Vec::new(), planes: Vec::new(), labels: Vec::new() };
        for (i, &root) in roots.iter().enumerate() {
            let (of, plane) =
                if is_whole[root] { (root, plane_of(root)?) } else { (i, Plane::of(corners(i))?) };
            let of = *number[of].get_or_insert_with(|| {
                facets.planes.push(plane);
                facets.labels.push(sheet.labels[i].clone());
                (facets.planes.len() - 1) as u32
            });
            facets.facet_of.push(of);
        }
        Some(facets)
    }
}

/// For each triangle, a triangle that represents its facet.
fn roots(points: &[Point], sheet: &Sheet) -> Vec<usize> {
    let Sheet { triangles, labels } = sheet;
    let flat = flat_facets(points, triangles, rounding::of(points));
    let mut edges: Vec<([VertexId; 2], bool, u32)> = Vec::with_capacity(3 * triangles.len());
    for (i, &[a, b, c]) in (0..).zip(triangles) {
        edges.extend([[a, b], [b, c], [c, a]].map(|[p, q]| (sorted_ids([p, q]), p < q, i)));
    }
    edges.sort_unstable();
    let mut sets = DisjointSets::new(triangles.len());
    for run in edges.chunk_by(|x, y| x.0 == y.0) {
        let &[(_, one, i), (_, other, j)] = run else { continue };
        let [s, t] = [i, j].map(|t| t as usize);
        // Triangles of a facet have the same orientation.
        if one != other && flat[s] == flat[t] && labels[s] == labels[t] {
            sets.join(i, j);
        }
    }
    sets.roots().into_iter().map(|root| root as usize).collect()
}
