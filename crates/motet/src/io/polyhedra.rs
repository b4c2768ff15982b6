//! Polyhedra: cells with their faces, and the face streams of VTK's files: the number of faces, then for each
//! the number of its vertices and the vertices.

use crate::base::{Csr, Result, VertexId};
use crate::mesh::{CellKind, Cells};

/// Takes the faces of one polyhedron from the front of `stream`; `None` if the stream ends too early.
pub(super) fn next_polyhedron(stream: &mut &[u32]) -> Option<Csr<VertexId>> {
    let (&n_faces, mut rest) = stream.split_first()?;
    let mut faces = Csr::default();
    for _ in 0..n_faces {
        let (&n, tail) = rest.split_first()?;
        let (face, tail) = tail.split_at_checked(n as usize)?;
        faces.push(face.iter().map(|&v| VertexId(v)));
        rest = tail;
    }
    *stream = rest;
    Some(faces)
}

/// The faces of a polyhedron as a stream.
pub(super) fn face_stream(faces: &Csr<VertexId>) -> Vec<u32> {
    let mut stream = vec![faces.len() as u32];
    for face in faces.iter() {
        stream.push(face.len() as u32);
        stream.extend(face.iter().map(|v| v.0));
    }
    stream
}

/// Builds cells from their kinds, their offsets, all their vertices, and the faces of the polyhedra among
/// them.
pub(super) fn cells_with_polyhedra(
    kinds: &[CellKind],
    offsets: Vec<u32>,
    vertices: Vec<VertexId>,
    faces: Vec<Csr<VertexId>>,
) -> Result<Cells> {
    // Validate polyhedra as polygons, which may have any number of vertices.
    let stand_in = |k: &CellKind| if *k == CellKind::POLYHEDRON { CellKind::POLYGON } else { *k };
    let checked = Cells::from_parts(kinds.iter().map(stand_in).collect(), offsets, vertices)?;
    let mut faces = faces.into_iter();
    let mut cells = Cells::new();
    for ((_, _, vertices), &kind) in checked.iter().zip(kinds) {
        let vertices = vertices.iter().copied();
        match kind {
            CellKind::POLYHEDRON => cells.push_polyhedron(vertices, faces.next().unwrap_or_default()),
            _ => cells.push(kind, vertices),
        }
    }
    Ok(cells)
}
