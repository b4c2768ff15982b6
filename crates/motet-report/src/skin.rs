//! The visible surface of a mesh: triangles with their cells, and which of their sides are edges.

use std::collections::HashMap;

use motet::Mesh;
use motet::base::{VertexId, rising_list};
use motet::geometry::vector::is_finite;
use motet::mesh::{Boundary, CellKind, triangulate};

/// Marks a triangle without a cell of that dimension.
pub(crate) const NONE: u32 = u32::MAX;

/// The boundary of the volume cells and all surface cells, coincident triangles only once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skin {
    pub(crate) triangles: Vec<[VertexId; 3]>,
    /// Bit `i`: the side from corner `i` to the next is an edge of the mesh, not a diagonal of a divided
    /// cell.
    pub(crate) edges: Vec<u8>,
    pub(crate) volume_cell: Vec<u32>,
    pub(crate) surface_cell: Vec<u32>,
    /// Number of triangles left out because their points are not finite.
    pub(crate) not_finite: usize,
}

impl Skin {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let mut skin = Self::default();
        let mut surface: HashMap<Vec<VertexId>, u32> = HashMap::new();
        let of_surface = || mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        for (cell, _, vertices) in of_surface() {
            surface.entry(rising_list(vertices)).or_insert(cell.0);
        }
        let boundary = Boundary::of(&mesh.cells);
        let mut is_shown = vec![false; mesh.cells.len()];
        for ((cell, &kind), facet) in boundary.cells.iter().zip(&boundary.kinds).zip(boundary.facets.iter()) {
            let surface_cell = surface.get(&rising_list(facet)).copied().unwrap_or(NONE);
            if let Some(is_shown) = is_shown.get_mut(surface_cell as usize) {
                *is_shown = true;
            }
            skin.add(mesh, kind, facet, [cell.0, surface_cell]);
        }
        for (cell, kind, vertices) in of_surface().filter(|(cell, ..)| !is_shown[cell.index()]) {
            skin.add(mesh, kind, vertices, [NONE, cell.0]);
        }
        skin
    }

    fn add(&mut self, mesh: &Mesh, kind: CellKind, vertices: &[VertexId], cells: [u32; 2]) {
        let at = |v: VertexId| mesh.points[v.index()];
        for (triangle, edges) in pieces(mesh, kind, vertices) {
            if !triangle.iter().all(|&v| is_finite(at(v))) {
                self.not_finite += 1;
                continue;
            }
            self.triangles.push(triangle);
            self.edges.push(edges);
            self.volume_cell.push(cells[0]);
            self.surface_cell.push(cells[1]);
        }
    }
}

/// Divides a facet or surface cell into triangles, with the sides of each that are edges.
pub(crate) fn pieces(mesh: &Mesh, kind: CellKind, vertices: &[VertexId]) -> Vec<([VertexId; 3], u8)> {
    if let (CellKind::TRIANGLE, &[a, b, c]) = (kind, vertices) {
        return vec![([a, b, c], 7)];
    }
    let ring = ring(kind, vertices);
    let follow = |a: VertexId, b: VertexId| {
        let next = |i: usize| ring[(i + 1) % ring.len()];
        ring.iter().enumerate().any(|(i, &v)| (v, next(i)) == (a, b) || (v, next(i)) == (b, a))
    };
    let mut pieces = Vec::new();
    triangulate(kind, vertices, &mesh.points, &mut |t| {
        let is_edge = |i: usize| kind == CellKind::TRIANGLE_STRIP || follow(t[i], t[(i + 1) % 3]);
        pieces.push((t, (0..3).map(|i| u8::from(is_edge(i)) << i).sum()));
    });
    pieces
}

/// The vertices in order around the cell.
fn ring(kind: CellKind, vertices: &[VertexId]) -> Vec<VertexId> {
    let places: &[usize] = match kind {
        CellKind::PIXEL => &[0, 1, 3, 2],
        CellKind::QUADRATIC_TRIANGLE | CellKind::BIQUADRATIC_TRIANGLE => &[0, 3, 1, 4, 2, 5],
        CellKind::QUADRATIC_QUAD | CellKind::BIQUADRATIC_QUAD => &[0, 4, 1, 5, 2, 6, 3, 7],
        CellKind::QUADRATIC_LINEAR_QUAD => &[0, 4, 1, 2, 5, 3],
        CellKind::QUADRATIC_POLYGON => {
            let (corners, middles) = vertices.split_at(vertices.len() / 2);
            return corners.iter().zip(middles).flat_map(|(&a, &b)| [a, b]).collect();
        }
        _ => return vertices.to_vec(),
    };
    places.iter().filter_map(|&i| vertices.get(i).copied()).collect()
}

#[cfg(test)]
mod tests {
    use motet::mesh::shapes::{ball, box_grid, mixed, quadratic};
    use motet::mesh::{Cells, Surface};

    use super::*;

    fn area(mesh: &Mesh, triangles: &[[VertexId; 3]]) -> f64 {
        let at = |t: &[VertexId; 3]| t.map(|v| mesh.points[v.index()]);
        triangles.iter().map(|t| motet::geometry::triangle::area(at(t))).sum()
    }

    #[test]
    fn it_covers_the_boundary_once_whatever_the_cells_are() {
        for mesh in [ball(3, 2), mixed(2), quadratic(&ball(2, 2)), box_grid([2, 3, 1], [[0.0; 3], [1.0; 3]])]
        {
            let skin = Skin::of(&mesh);
            let outside: Vec<_> = (0..skin.triangles.len())
                .filter(|&i| skin.volume_cell[i] != NONE)
                .map(|i| skin.triangles[i])
                .collect();
            let expected = Surface::boundary_of(&mesh);
            assert_eq!(outside.len(), expected.triangles.len());
            let (ours, theirs) = (area(&mesh, &outside), area(&mesh, &expected.triangles));
            assert!((ours - theirs).abs() < 1e-12 * theirs);
        }
    }

    #[test]
    fn surface_cells_lend_their_patches_to_the_boundary() {
        let mesh = box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]);
        let skin = Skin::of(&mesh);
        let n_surface = mesh.cells.kinds().iter().filter(|kind| kind.dim() == Some(2)).count();
        assert!(n_surface > 0 && skin.surface_cell.iter().all(|&cell| cell != NONE));
        assert_eq!(skin.triangles.len(), n_surface);
    }

    #[test]
    fn a_diagonal_is_no_edge() {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let cells = Cells::uniform(CellKind::QUAD, (0..4).map(VertexId).collect()).unwrap();
        let skin = Skin::of(&Mesh::new(points, cells));
        let n_edges: u32 = skin.edges.iter().map(|edges| edges.count_ones()).sum();
        assert_eq!((skin.triangles.len(), n_edges), (2, 4));
    }

    #[test]
    fn points_that_are_no_numbers_are_counted() {
        let mut mesh = ball(2, 1);
        let all = Skin::of(&mesh).triangles;
        let [a, b, _] = all[0];
        mesh.points[a.index()][1] = f64::NAN;
        mesh.points[b.index()][0] = f64::INFINITY;
        let skin = Skin::of(&mesh);
        let is_off = |t: &&[VertexId; 3]| t.contains(&a) || t.contains(&b);
        assert_eq!(skin.not_finite, all.iter().filter(is_off).count());
        assert_eq!(skin.triangles.len() + skin.not_finite, all.len());
    }
}
