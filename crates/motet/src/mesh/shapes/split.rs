//! Division of cells of any kind into tets that conform without regard to neighbours.

use crate::base::VertexId;
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Cells};

/// Splits every volume cell into tets; surface cells, curves and points are left out. Middle nodes of
/// quadratic cells are dropped.
///
/// A cell is divided into the cone over its facets from its vertex of smallest id, and a facet into the fan
/// from its own (the "pulling" of polytopes; for hexahedra, wedges and pyramids see Dompierre, Labbé, Vallet,
/// Camarero 1999). Both cells at a facet see the same fan, so the tets conform. The numbering of the vertices
/// determines the diagonals.
///
/// The tets are positive for convex cells of positive volume. A hexahedron gives six tets, a wedge three, a
/// pyramid two.
pub fn to_tets(cells: &Cells) -> Cells {
    let facets = Facets::of(cells);
    let mut tets = Vec::new();
    for (cell, kind, vertices) in cells.iter() {
        if kind == CellKind::TETRA {
            tets.extend_from_slice(vertices);
            continue;
        }
        let Some(&apex) = vertices.iter().min() else { continue };
        for local in 0..facets.count(cell) as u32 {
            let ring: Vec<VertexId> = facets.corners(FacetUse { cell, local }).collect();
            for [a, b, c] in fan_triangles(&ring).filter(|_| !ring.contains(&apex)) {
                // The ring faces outward, away from the apex.
                tets.extend([a, c, b, apex]);
            }
        }
    }
    let mut split = Cells::new();
    for tet in tets.as_chunks::<4>().0 {
        split.push(CellKind::TETRA, *tet);
    }
    split
}

/// The triangles of a ring, as a fan from its vertex of smallest id.
pub(crate) fn fan_triangles(ring: &[VertexId]) -> impl Iterator<Item = [VertexId; 3]> + '_ {
    let n = ring.len();
    let first = (0..n).min_by_key(|&i| ring[i]).unwrap_or(0);
    (1..n.saturating_sub(1)).map(move |i| [ring[first], ring[(first + i) % n], ring[(first + i + 1) % n]])
}
