//! Faces of polyhedra, in both of VTK's layouts.
//!
//! ```text
//! old          faces                 n faces, then for each: n vertices, vertex, vertex, ...
//!              faceoffsets           for each cell where its faces end, -1 for cells that are not polyhedra
//! from 9.4 on  face_connectivity     vertices, face after face
//!              face_offsets          where each face ends
//!              polyhedron_to_faces   faces, cell after cell
//!              polyhedron_offsets    where the faces of each cell end
//! ```
//! The old layout is written, since every version of VTK reads it.

use crate::base::{Csr, Error, Result, VertexId};
use crate::io::polyhedra::{face_stream, next_polyhedron};
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::mesh::{CellKind, Cells};

/// Reads the faces of each polyhedron, in the order of the cells; `cells` is the element with the arrays,
/// `kinds` the kind of each cell.
pub(super) fn read(file: &File<'_>, cells: &Element<'_>, kinds: &[CellKind]) -> Result<Vec<Csr<VertexId>>> {
    let new = cells.children.iter().any(|c| c.attribute("Name") == Some("polyhedron_to_faces"));
    if new { read_new(file, cells, kinds) } else { read_old(file, cells, kinds) }
}

fn read_old(file: &File<'_>, cells: &Element<'_>, kinds: &[CellKind]) -> Result<Vec<Csr<VertexId>>> {
    let stream = file.required_array(cells, "faces")?.ids(None)?;
    let ends =
        file.required_array(cells, "faceoffsets")?.values(Some(kinds.len()))?.to_i64().unwrap_or_default();
    let mut rest = stream.as_slice();
    let mut all = Vec::new();
    for (cell, _) in kinds.iter().enumerate().filter(|(_, k)| **k == CellKind::POLYHEDRON) {
        let faces = next_polyhedron(&mut rest).filter(|_| {
            ends.get(cell).is_some_and(|&end| usize::try_from(end) == Ok(stream.len() - rest.len()))
        });
        all.push(faces.ok_or_else(|| inconsistent_faces(cell))?);
    }
    Ok(all)
}

fn read_new(file: &File<'_>, cells: &Element<'_>, kinds: &[CellKind]) -> Result<Vec<Csr<VertexId>>> {
    let ids = |name: &str| file.required_array(cells, name)?.ids(None);
    let (vertices, face_ends) = (ids("face_connectivity")?, ids("face_offsets")?);
    let (faces, cell_ends) = (ids("polyhedron_to_faces")?, ids("polyhedron_offsets")?);
    let mut all = Vec::new();
    for (cell, _) in kinds.iter().enumerate().filter(|(_, k)| **k == CellKind::POLYHEDRON) {
        let faces = list(&cell_ends, &faces, cell).ok_or_else(|| inconsistent_faces(cell))?;
        let mut of_cell = Csr::default();
        for &face in faces {
            let face = list(&face_ends, &vertices, face as usize).ok_or_else(|| inconsistent_faces(cell))?;
            // A face may be used repeatedly, so that the file does not bound the sum.
            if of_cell.items().len() + face.len() > vertices.len() {
                return Err(inconsistent_faces(cell));
            }
            of_cell.push(face.iter().map(|&v| VertexId(v)));
        }
        all.push(of_cell);
    }
    Ok(all)
}

/// List `i` of the lists that end at `ends`.
fn list<'a>(ends: &[u32], items: &'a [u32], i: usize) -> Option<&'a [u32]> {
    let start = if i == 0 { 0 } else { *ends.get(i - 1)? };
    items.get(start as usize..*ends.get(i)? as usize)
}

fn inconsistent_faces(cell: usize) -> Error {
    Error::input("the face arrays are inconsistent for this polyhedron")
        .at(format!("cell {cell}"))
        .remedy("the file is damaged: write it again")
}

/// The arrays `faces` and `faceoffsets` of the old layout.
pub(super) fn old_layout(cells: &Cells) -> (Vec<i64>, Vec<i64>) {
    let (mut stream, mut ends) = (Vec::new(), Vec::with_capacity(cells.len()));
    let mut polyhedra = cells.polyhedron_faces().iter();
    for kind in cells.kinds() {
        let faces = if *kind == CellKind::POLYHEDRON { polyhedra.next() } else { None };
        let Some(faces) = faces else {
            ends.push(-1);
            continue;
        };
        stream.extend(face_stream(faces).into_iter().map(i64::from));
        ends.push(stream.len() as i64);
    }
    (stream, ends)
}
