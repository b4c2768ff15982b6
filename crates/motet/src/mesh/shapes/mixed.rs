//! A box of hexahedra, wedges, pyramids and tets, conforming: every common kind in one mesh.

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, scale};
use crate::mesh::facets::facet_shapes;
use crate::mesh::shapes::boxes::{lattice, lattice_cell, lattice_points};
use crate::mesh::shapes::labelled::labelled;
use crate::mesh::shapes::split::fan_triangles;
use crate::mesh::{CellKind, Cells, Mesh};

/// The box `[0, 3] x [0, 1] x [0, 1]` in cells of edge `1 / n`: hexahedra in `x < 1`, wedges up to `x < 2`,
/// beyond that pyramids around the centre of each cell, those at the boundary divided into two tets each.
/// Region `mixed`; patch `surface`.
///
/// Panics unless `n` is at least 1.
pub fn mixed(n: usize) -> Mesh {
    assert!(n > 0, "a mesh has cells");
    let size = [3 * n, n, n];
    let mut points = lattice_points(size, |_, i| i as f64 / n as f64);
    let mut cells = Cells::new();
    for place in lattice(size) {
        let hexahedron = lattice_cell(size, place);
        match place[0] / n {
            0 => cells.push(CellKind::HEXAHEDRON, hexahedron),
            1 => push_wedges(hexahedron, &mut cells),
            _ => push_pyramids(hexahedron, &mut points, &mut cells),
        }
    }
    labelled(points, cells, "mixed", &["surface"], |_| 0)
}

fn push_wedges([a, b, c, d, e, f, g, h]: [VertexId; 8], cells: &mut Cells) {
    cells.push(CellKind::WEDGE, [a, b, c, e, f, g]);
    cells.push(CellKind::WEDGE, [a, c, d, e, g, h]);
}

fn push_pyramids(hexahedron: [VertexId; 8], points: &mut Vec<Point>, cells: &mut Cells) {
    let corners = hexahedron.map(|v| points[v.index()]);
    let apex = VertexId::new(points.len());
    points.push(scale(corners.into_iter().fold([0.0; 3], add), 1.0 / 8.0));
    for facet in facet_shapes(CellKind::HEXAHEDRON).unwrap_or_default() {
        let ring: Vec<VertexId> = facet.corners().iter().map(|&i| hexahedron[i as usize]).collect();
        if on_boundary(&ring, points) {
            fan_triangles(&ring).for_each(|[a, b, c]| cells.push(CellKind::TETRA, [a, c, b, apex]));
        } else {
            // The base of a pyramid faces its apex.
            cells.push(CellKind::PYRAMID, ring.into_iter().rev().chain([apex]));
        }
    }
}

fn on_boundary(ring: &[VertexId], points: &[Point]) -> bool {
    let all_on = |k: usize, x: f64| ring.iter().all(|v| points[v.index()][k] == x);
    (0..3).any(|k| all_on(k, 0.0) || all_on(k, if k == 0 { 3.0 } else { 1.0 }))
}
