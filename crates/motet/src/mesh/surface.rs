//! A surface of triangles extracted from a mesh, the form that distance and contact computations use.

use std::collections::BTreeMap;

use crate::base::{CellId, Point, VertexId, sorted_ids};
use crate::mesh::triangulate::triangulate;
use crate::mesh::{Boundary, CellKind, Labels, Mesh, cone_volume};

/// Triangles over the points of a mesh. Vertices keep their ids in the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// All points of the mesh, including those that no triangle uses.
    pub points: Vec<Point>,
    /// The triangles, oriented like the cells they come from.
    pub triangles: Vec<[VertexId; 3]>,
    /// The cell that each triangle is part of: a surface cell or, for a surface made by
    /// [`Surface::boundary_of`], the volume cell behind it.
    pub triangle_to_cell: Vec<CellId>,
    /// The patch of each triangle; 0 where it has none.
    pub patches: Vec<i32>,
    /// Names of patches, where there are any.
    pub patch_names: BTreeMap<i32, String>,
}

impl Surface {
    /// The surface cells of a mesh as triangles, with their patches: triangles, quads, convex and non-convex
    /// polygons, strips, pixels and quadratic cells.
    pub fn of(mesh: &Mesh) -> Self {
        let labels = mesh.patches();
        let cells = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        Self::from_cells(mesh, labels.as_ref(), cells)
    }

    /// The boundary of the volume cells of a mesh as triangles facing outward, all of patch 0.
    pub fn boundary_of(mesh: &Mesh) -> Self {
        Self::of_boundary(mesh, Boundary::of(&mesh.cells))
    }

    /// The boundary of the volume cells of a mesh, already found, as triangles facing outward, all of patch
    /// 0.
    pub(crate) fn of_boundary(mesh: &Mesh, mut boundary: Boundary) -> Self {
        boundary.turn_outward(&mesh.cells, &mesh.points);
        let facets = boundary.cells.iter().zip(&boundary.kinds).zip(boundary.facets.iter());
        Self::from_cells(mesh, None, facets.map(|((&cell, &kind), vertices)| (cell, kind, vertices)))
    }

    /// The surface cells of a mesh as triangles or, if it has none, its boundary.
    pub fn own_or_boundary_of(mesh: &Mesh) -> Self {
        let surface = Self::of(mesh);
        if surface.triangles.is_empty() { Self::boundary_of(mesh) } else { surface }
    }

    /// Each of `triangles` replaced by the triangle of this surface with the same vertices, and so oriented
    /// as here, for example outward on a [boundary](Self::boundary_of); `None` if one has no counterpart
    /// here.
    pub fn turned(&self, triangles: &[[VertexId; 3]]) -> Option<Vec<[VertexId; 3]>> {
        let key = |t: &[VertexId; 3]| sorted_ids(*t);
        let mut own = self.triangles.clone();
        own.sort_by_key(key);
        let turned = |t| own.binary_search_by_key(&key(t), key).ok().map(|place| own[place]);
        triangles.iter().map(turned).collect()
    }

    fn from_cells<'a>(
        mesh: &Mesh,
        labels: Option<&Labels>,
        cells: impl Iterator<Item = (CellId, CellKind, &'a [VertexId])>,
    ) -> Self {
        let mut surface = Self {
            points: mesh.points.clone(),
            patch_names: labels.map(|l| l.names.clone()).unwrap_or_default(),
            ..Self::default()
        };
        for (cell, kind, vertices) in cells {
            triangulate(kind, vertices, &mesh.points, &mut |t| surface.triangles.push(t));
            let patch = labels.map_or(0, |l| l.ids[cell.index()]);
            surface.triangle_to_cell.resize(surface.triangles.len(), cell);
            surface.patches.resize(surface.triangles.len(), patch);
        }
        surface
    }

    /// The points of the corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [Point; 3] {
        self.triangles[triangle].map(|v| self.points[v.index()])
    }

    /// The signed volume that the triangles enclose, positive if they face outward. For a surface that is not
    /// closed, the volume between the triangles and the first corner of the first of them.
    pub fn enclosed_volume(&self) -> f64 {
        let Some(origin) = self.triangles.first().map(|t| self.points[t[0].index()]) else { return 0.0 };
        self.triangles.iter().map(|t| cone_volume(t.iter().copied(), &self.points, origin)).sum()
    }

    /// Every vertex of the triangles once, in rising order.
    pub fn vertices(&self) -> Vec<VertexId> {
        let mut seen = vec![false; self.points.len()];
        self.triangles.as_flattened().iter().for_each(|v| seen[v.index()] = true);
        (0..seen.len()).filter(|&v| seen[v]).map(VertexId::new).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cell_volumes;
    use crate::mesh::shapes::{ball, box_grid};

    #[test]
    fn a_boundary_encloses_what_the_cells_fill() {
        for mesh in [ball(3, 2), box_grid([2, 3, 4], [[5.0; 3], [6.0, 8.0, 10.0]])] {
            let filled: f64 = cell_volumes(&mesh.cells, &mesh.points).iter().sum();
            let mut surface = Surface::boundary_of(&mesh);
            assert!((surface.enclosed_volume() - filled).abs() < 1e-12 * filled);
            surface.triangles.iter_mut().for_each(|t| t.swap(0, 1));
            assert!((surface.enclosed_volume() + filled).abs() < 1e-12 * filled);
        }
        assert_eq!(Surface::default().enclosed_volume().to_bits(), 0);
    }
}
