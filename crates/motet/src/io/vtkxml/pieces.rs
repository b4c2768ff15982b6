//! Several pieces of one file become one mesh.

use crate::base::{Csr, Error, Result, VertexId};
use crate::io::labels::take_label_names;
use crate::io::scalar::append;
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// Reads every `Piece` of the data set with `read_piece` and joins them in the
/// order of the file, with the field data.
pub(super) fn read_pieces<'a>(
    file: &File<'a>,
    read_piece: impl Fn(&File<'a>, &Element<'a>) -> Result<Mesh>,
) -> Result<Mesh> {
    let data_set = file.data_set()?;
    let mut whole: Option<Mesh> = None;
    let mut field_data = file.fields(data_set.child("FieldData"), None)?;
    for element in data_set.children_named("Piece") {
        field_data.extend(file.fields(element.child("FieldData"), None)?);
        let piece = read_piece(file, element)?;
        let empty = piece.points.is_empty() && piece.cells.is_empty();
        whole = match whole {
            None => Some(piece),
            Some(whole) if empty => Some(whole),
            Some(whole) if whole.points.is_empty() && whole.cells.is_empty() => Some(piece),
            Some(whole) => {
                // Before ids are raised: afterwards they would be found among another piece's points.
                piece.validate().and_then(|()| whole.validate()).map_err(|e| e.at(element.place()))?;
                Some(join(whole, piece).map_err(|e| e.at(element.place()))?)
            }
        };
    }
    let mut mesh = whole.unwrap_or_default();
    mesh.field_data = field_data;
    take_label_names(&mut mesh);
    Ok(mesh)
}

fn join(mut whole: Mesh, piece: Mesh) -> Result<Mesh> {
    let shift = whole.points.len();
    if shift + piece.points.len() > VertexId::MAX_COUNT {
        return Err(
            Error::input("all pieces together have too many points").remedy("read the pieces one by one")
        );
    }
    join_fields(&mut whole.point_data, piece.point_data, "point")?;
    join_fields(&mut whole.cell_data, piece.cell_data, "cell")?;
    whole.points.extend(piece.points);
    push_cells(&mut whole.cells, &piece.cells, shift as u32)?;
    Ok(whole)
}

fn join_fields(whole: &mut [Field], piece: Vec<Field>, what: &str) -> Result<()> {
    let unlike = || Error::input(format!("its {what} arrays are not those of the pieces before it"));
    if whole.len() != piece.len() {
        return Err(unlike().remedy("write the pieces with the same arrays, or read them one by one"));
    }
    for field in piece {
        let same = whole.iter_mut().find(|f| f.name == field.name && f.components == field.components);
        if !same.is_some_and(|f| append(&mut f.values, field.values)) {
            return Err(unlike()
                .at(format!("array {}", field.name))
                .remedy("write the pieces with the same arrays, or read them one by one"));
        }
    }
    Ok(())
}

/// Adds `more` to `cells`, ids raised by `shift`.
fn push_cells(cells: &mut Cells, more: &Cells, shift: u32) -> Result<()> {
    if cells.connectivity().items().len() + more.connectivity().items().len() > VertexId::MAX_COUNT {
        return Err(
            Error::input("all pieces together have too many cells").remedy("read the pieces one by one")
        );
    }
    let raised = |v: &VertexId| VertexId(v.0 + shift);
    let mut faces = more.polyhedron_faces().iter();
    for (_, kind, vertices) in more.iter() {
        let vertices = vertices.iter().map(raised);
        if kind != CellKind::POLYHEDRON {
            cells.push(kind, vertices);
            continue;
        }
        let mut list = Csr::default();
        faces.next().into_iter().flat_map(Csr::iter).for_each(|face| list.push(face.iter().map(raised)));
        cells.push_polyhedron(vertices, list);
    }
    Ok(())
}
