//! Faces of a polyhedron as one stream of numbers, as VTK's files have them:
//! how many faces, then for each how many vertices, and these.

use crate::base::{Csr, VertexId};

/// Takes the faces of one polyhedron off the front of `stream`; `None` when it ends too early.
pub(super) fn next_polyhedron(stream: &mut &[u32]) -> Option<Csr<VertexId>> {
    let (&n_faces, mut rest) = stream.split_first()?;
    let mut faces = Csr::default();
    for _ in 0..n_faces {
        let (&n, behind) = rest.split_first()?;
        let (face, behind) = behind.split_at_checked(n as usize)?;
        faces.push(face.iter().map(|&v| VertexId(v)));
        rest = behind;
    }
    *stream = rest;
    Some(faces)
}

/// The faces of one polyhedron as a stream.
pub(super) fn face_stream(faces: &Csr<VertexId>) -> Vec<u32> {
    let mut stream = vec![faces.len() as u32];
    for face in faces.iter() {
        stream.push(face.len() as u32);
        stream.extend(face.iter().map(|v| v.0));
    }
    stream
}
