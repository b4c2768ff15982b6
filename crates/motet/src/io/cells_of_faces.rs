//! Recovers cells from their faces.

use crate::base::{Csr, VertexId};
use crate::mesh::facets::facet_shapes;
use crate::mesh::{CellKind, Cells};

/// Cell kinds identified by their faces: numbers of triangles and of quads.
const KINDS: [(CellKind, usize, usize); 4] = [
    (CellKind::TETRA, 4, 0),
    (CellKind::PYRAMID, 4, 1),
    (CellKind::WEDGE, 2, 3),
    (CellKind::HEXAHEDRON, 0, 6),
];

/// Appends the cell with these faces, each a ring that runs counter-clockwise seen from outside. Faces that
/// fit no fixed kind make a polyhedron.
pub(super) fn push(cells: &mut Cells, faces: &[Vec<VertexId>]) {
    let count = |n: usize| faces.iter().filter(|face| face.len() == n).count();
    let kind = KINDS.iter().find(|&&(_, triangles, quads)| {
        count(3) == triangles && count(4) == quads && faces.len() == triangles + quads
    });
    match kind.and_then(|&(kind, ..)| Some((kind, corners(kind, faces)?))) {
        Some((kind, vertices)) => cells.push(kind, vertices),
        None => {
            let mut vertices: Vec<VertexId> = faces.iter().flatten().copied().collect();
            vertices.sort_unstable();
            vertices.dedup();
            let mut rings = Csr::default();
            faces.iter().for_each(|face| rings.push(face.iter().copied()));
            cells.push_polyhedron(vertices, rings);
        }
    }
}

/// The vertices of a cell of the given kind, in VTK's order; `None` if the faces do not form one.
///
/// One face is matched with the first face of the kind of that size; each other vertex is found along an edge
/// from it.
fn corners(kind: CellKind, faces: &[Vec<VertexId>]) -> Option<Vec<VertexId>> {
    let shapes = facet_shapes(kind)?;
    let n = kind.n_vertices()?;
    // The quad of a pyramid, or a triangle of a wedge.
    let size = if kind == CellKind::PYRAMID {
        4
    } else if kind == CellKind::WEDGE {
        3
    } else {
        faces[0].len()
    };
    let base = faces.iter().find(|face| face.len() == size)?;
    let shape = shapes.iter().find(|shape| shape.n_corners == size)?.corners();
    let mut vertices: Vec<Option<VertexId>> = vec![None; n];
    for (&place, &v) in shape.iter().zip(base) {
        vertices[place as usize] = Some(v);
    }
    for (&place, &v) in shape.iter().zip(base) {
        let rings = shapes.iter().map(|shape| shape.corners());
        let beyond = successors(rings, place).find(|p| !shape.contains(p))?;
        let found = successors(faces.iter().map(Vec::as_slice), v).find(|v| !base.contains(v))?;
        let known = &mut vertices[beyond as usize];
        if known.is_some_and(|known| known != found) {
            return None;
        }
        *known = Some(found);
    }
    let vertices: Vec<VertexId> = vertices.into_iter().collect::<Option<_>>()?;
    let is_there = |corners: &[u8]| {
        let ring: Vec<VertexId> = corners.iter().map(|&place| vertices[place as usize]).collect();
        faces.iter().any(|face| is_same_ring(face, &ring))
    };
    shapes.iter().all(|shape| is_there(shape.corners())).then_some(vertices)
}

/// The successors of `of` in the rings that contain it.
fn successors<'a, T: Copy + PartialEq + 'a>(
    rings: impl Iterator<Item = &'a [T]>,
    of: T,
) -> impl Iterator<Item = T> {
    rings.filter_map(move |ring| {
        let place = ring.iter().position(|&x| x == of)?;
        Some(ring[(place + 1) % ring.len()])
    })
}

/// Whether two rings pass through the same vertices in the same direction, whatever their starting points.
fn is_same_ring(a: &[VertexId], b: &[VertexId]) -> bool {
    let start = b.iter().position(|v| a.first() == Some(v));
    a.len() == b.len() && start.is_some_and(|start| a.iter().eq(b[start..].iter().chain(&b[..start])))
}
