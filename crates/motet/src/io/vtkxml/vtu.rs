//! Unstructured grids (`.vtu`): cells of any kind.

use crate::base::{Error, Result, VertexId};
use crate::io::format::WriteOptions;
use crate::io::labels::label_fields;
use crate::io::output::Output;
use crate::io::polyhedra::cells_with_polyhedra;
use crate::io::surplus_points::trim;
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::io::vtkxml::pieces::read_pieces;
use crate::io::vtkxml::polyhedra;
use crate::io::vtkxml::writer::{Data, Writer, ends, plain};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

const KIND: &str = "UnstructuredGrid";

pub(super) fn read(file: &File<'_>) -> Result<Mesh> {
    read_pieces(file, read_piece)
}

fn read_piece<'a>(file: &File<'a>, piece: &Element<'a>) -> Result<Mesh> {
    let n_points = piece.required_count("NumberOfPoints")?;
    let n_cells = piece.required_count("NumberOfCells")?;
    Ok(Mesh {
        points: read_points(file, piece, n_points)?,
        cells: read_cells(file, piece, n_cells)?,
        point_data: file.fields(piece.child("PointData"), Some(n_points))?,
        cell_data: file.fields(piece.child("CellData"), Some(n_cells))?,
        ..Mesh::default()
    })
}

/// Reads the points of a piece.
pub(super) fn read_points(file: &File<'_>, piece: &Element<'_>, n: usize) -> Result<Vec<[f64; 3]>> {
    if n > VertexId::MAX_COUNT {
        return Err(Error::input(format!("{n} points are more than a mesh can hold")).at(piece.place()));
    }
    let mut arrays = file.arrays(piece.child("Points"));
    match arrays.next() {
        Some(array) => array?.points(n),
        None if n == 0 => Ok(Vec::new()),
        None => Err(Error::input(format!("{n} points declared, but there is no array of points"))
            .at(piece.place())
            .remedy("the file is damaged: write it again")),
    }
}

fn read_cells(file: &File<'_>, piece: &Element<'_>, n: usize) -> Result<Cells> {
    if n == 0 {
        return Ok(Cells::new());
    }
    let Some(element) = piece.child("Cells") else {
        return Err(Error::input(format!("{n} cells declared, but the element Cells is missing"))
            .at(piece.place())
            .remedy("the file is damaged: write it again"));
    };
    let kinds = read_kinds(file, element, n)?;
    let mut offsets = file.required_array(element, "offsets")?.offsets(n)?;
    let ids = file.required_array(element, "connectivity")?.ids(None)?;
    let mut vertices = bytemuck::allocation::cast_vec::<u32, VertexId>(ids);
    trim(&kinds, &mut offsets, &mut vertices, file.notes);
    if !kinds.contains(&CellKind::POLYHEDRON) {
        return Cells::from_parts(kinds, offsets, vertices).map_err(|e| e.at(element.place()));
    }
    let faces = polyhedra::read(file, element, &kinds)?;
    cells_with_polyhedra(&kinds, offsets, vertices, faces).map_err(|e| e.at(element.place()))
}

fn read_kinds(file: &File<'_>, element: &Element<'_>, n: usize) -> Result<Vec<CellKind>> {
    let array = file.required_array(element, "types")?;
    let numbers = match array.values(Some(n))? {
        Values::U8(numbers) => Some(numbers),
        other => other.to_i64().and_then(|wide| wide.into_iter().map(|k| u8::try_from(k).ok()).collect()),
    };
    let numbers =
        numbers.ok_or_else(|| Error::input("a cell type is not between 0 and 255").at(element.place()))?;
    Ok(bytemuck::allocation::cast_vec(numbers))
}

/// Writes a mesh; returns what the format could not hold.
pub(super) fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (label_cells, label_names) = label_fields(mesh);
    let mut writer = Writer::new(KIND, options, output);
    let field_data: Vec<&Field> = mesh.field_data.iter().chain(&label_names).collect();
    if !field_data.is_empty() {
        writer.fields("FieldData", &field_data, true)?;
    }
    writer.open(&format!(
        "Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"",
        mesh.points.len(),
        mesh.cells.len()
    ));
    writer.fields("PointData", &mesh.point_data.iter().collect::<Vec<_>>(), false)?;
    writer.fields("CellData", &mesh.cell_data.iter().chain(&label_cells).collect::<Vec<_>>(), false)?;
    writer.open("Points");
    writer.array("Points", 3, None, Data::Points(&mesh.points))?;
    writer.close("Points");
    writer.open("Cells");
    writer.array("connectivity", 1, None, Data::Ids(plain(mesh.cells.connectivity().items())))?;
    writer.array("offsets", 1, None, Data::Ids(ends(mesh.cells.connectivity())))?;
    writer.array("types", 1, None, Data::Bytes(bytemuck::cast_slice(mesh.cells.kinds())))?;
    if !mesh.cells.polyhedron_faces().is_empty() {
        let (faces, face_ends) = polyhedra::old_layout(&mesh.cells);
        writer.array("faces", 1, None, Data::Int64(faces))?;
        writer.array("faceoffsets", 1, None, Data::Int64(face_ends))?;
    }
    writer.close("Cells");
    writer.close("Piece");
    writer.finish(KIND)
}
