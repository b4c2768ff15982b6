//! Divides wedges, pyramids and quads, each facet from its vertex of smallest number, so that both cells at a
//! quad agree on its diagonal (Dompierre, Labbé, Vallet and Camarero 1999).

use crate::base::VertexId;
use crate::mesh::facets::facet_shapes;
use crate::mesh::{CellKind, Cells, Mesh};

/// Returns the mesh with wedges, pyramids and quads divided into tets and triangles; the parts of a cell
/// inherit its rows of cell arrays.
pub(crate) fn split(mesh: Mesh) -> Mesh {
    let (mut cells, mut from) = (Cells::new(), Vec::new());
    for (cell, kind, vertices) in mesh.cells.iter() {
        match kind {
            CellKind::WEDGE | CellKind::PYRAMID => {
                tets(kind, vertices, &mut |tet| cells.push(CellKind::TETRA, tet));
            }
            CellKind::QUAD => fan(vertices).for_each(|t| cells.push(CellKind::TRIANGLE, t)),
            _ => cells.push(kind, vertices.iter().copied()),
        }
        from.resize(cells.len(), cell.index());
    }
    let cell_data = mesh.cell_data.iter().map(|field| field.pick(from.iter().copied())).collect();
    Mesh { cells, cell_data, ..mesh }
}

/// The number of tets that a cell is divided into.
pub(super) fn n_tets(kind: CellKind) -> usize {
    match kind {
        CellKind::WEDGE => 3,
        CellKind::PYRAMID => 2,
        _ => 1,
    }
}

/// Divides a cell into tets between its vertex of smallest number and the facets opposite.
fn tets(kind: CellKind, vertices: &[VertexId], each: &mut impl FnMut([VertexId; 4])) {
    let Some(&apex) = vertices.iter().min() else { return };
    for shape in facet_shapes(kind).unwrap_or_default() {
        let ring: Vec<VertexId> = shape.corners().iter().map(|&k| vertices[k as usize]).collect();
        if !ring.contains(&apex) {
            // Rings face outward, away from the apex.
            fan(&ring).for_each(|[a, b, c]| each([a, c, b, apex]));
        }
    }
}

/// The triangles of a ring, all around its vertex of smallest number.
pub(super) fn fan(ring: &[VertexId]) -> impl Iterator<Item = [VertexId; 3]> + '_ {
    let n = ring.len();
    let first = (0..n).min_by_key(|&i| ring[i]).unwrap_or(0);
    (1..n.saturating_sub(1)).map(move |i| [ring[first], ring[(first + i) % n], ring[(first + i + 1) % n]])
}
