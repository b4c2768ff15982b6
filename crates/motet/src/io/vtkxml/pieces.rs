//! Joins several pieces of one file into one mesh.

use crate::base::{Csr, Error, Result, VertexId};
use crate::io::format::Notes;
use crate::io::labels::extract_label_names;
use crate::io::scalar::append;
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::io::weld::weld;
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// Reads every `Piece` of the data set with `read_piece`, joins them in the order of the file, and adds the
/// field data.
pub(super) fn read_pieces<'a>(
    file: &File<'a>,
    read_piece: impl Fn(&File<'a>, &Element<'a>) -> Result<Mesh>,
) -> Result<Mesh> {
    let data_set = file.data_set()?;
    let mut whole = JoinedPieces::default();
    let mut field_data = file.fields(data_set.child("FieldData"), None)?;
    for element in data_set.children_named("Piece") {
        field_data.extend(file.fields(element.child("FieldData"), None)?);
        whole.add(read_piece(file, element)?).map_err(|e| e.at(element.place()))?;
    }
    let (mut mesh, starts) = whole.into_parts();
    if starts.len() > 1 {
        mesh.validate()?;
        weld(&mut mesh, &starts, file.notes);
    }
    mesh.field_data = field_data;
    extract_label_names(&mut mesh);
    Ok(mesh)
}

/// The pieces joined so far, and the first point of each.
#[derive(Default)]
pub(super) struct JoinedPieces {
    mesh: Option<Mesh>,
    starts: Vec<usize>,
}

impl JoinedPieces {
    /// Adds a piece; the arrays of an empty piece are ignored.
    pub(super) fn add(&mut self, piece: Mesh) -> Result<()> {
        let is_empty = |mesh: &Mesh| mesh.points.is_empty() && mesh.cells.is_empty();
        self.mesh = match self.mesh.take() {
            Some(whole) if is_empty(&piece) => Some(whole),
            Some(whole) if !is_empty(&whole) => {
                // Must precede the shift of ids, after which invalid ids could match points of another piece.
                piece.validate()?;
                if self.starts.len() == 1 {
                    whole.validate()?;
                }
                self.starts.push(whole.points.len());
                Some(join(whole, piece)?)
            }
            _ => {
                self.starts = vec![0];
                Some(piece)
            }
        };
        Ok(())
    }

    /// The mesh, and the first point of each piece.
    pub(super) fn into_parts(self) -> (Mesh, Vec<usize>) {
        (self.mesh.unwrap_or_default(), self.starts)
    }
}

/// Keeps only the arrays that all non-empty meshes have, and adds a note on the others.
pub(super) fn common_arrays<'m>(meshes: impl Iterator<Item = &'m mut Mesh>, notes: &Notes) {
    let mut meshes: Vec<_> = meshes.filter(|mesh| !mesh.points.is_empty()).collect();
    for (what, of) in [("point", point_data as fn(&mut Mesh) -> &mut Vec<Field>), ("cell", cell_data)] {
        let kind = |f: &Field| (f.name.clone(), f.components, std::mem::discriminant(&f.values));
        let each: Vec<Vec<_>> = meshes.iter_mut().map(|mesh| of(mesh).iter().map(kind).collect()).collect();
        let is_common = |f: &Field| each.iter().all(|kinds| kinds.contains(&kind(f)));
        let mut skipped: Vec<String> = Vec::new();
        for mesh in &mut meshes {
            of(mesh).retain(|f| {
                let is_common = is_common(f);
                if !is_common && !skipped.contains(&f.name) {
                    skipped.push(f.name.clone());
                }
                is_common
            });
        }
        if !skipped.is_empty() {
            notes.add(format!("{what} arrays that not all blocks have are skipped: {}", skipped.join(", ")));
        }
    }
}

fn point_data(mesh: &mut Mesh) -> &mut Vec<Field> {
    &mut mesh.point_data
}

fn cell_data(mesh: &mut Mesh) -> &mut Vec<Field> {
    &mut mesh.cell_data
}

fn join(mut whole: Mesh, piece: Mesh) -> Result<Mesh> {
    let shift = whole.points.len();
    if shift + piece.points.len() > VertexId::MAX_COUNT {
        return Err(
            Error::input("all pieces together have too many points").remedy("read the pieces one at a time")
        );
    }
    join_fields(&mut whole.point_data, piece.point_data, "point")?;
    join_fields(&mut whole.cell_data, piece.cell_data, "cell")?;
    whole.points.extend(piece.points);
    push_cells(&mut whole.cells, &piece.cells, shift as u32)?;
    whole.label_names.regions.extend(piece.label_names.regions);
    whole.label_names.patches.extend(piece.label_names.patches);
    for field in piece.field_data {
        if !whole.field_data.iter().any(|f| f.name == field.name) {
            whole.field_data.push(field);
        }
    }
    Ok(whole)
}

fn join_fields(whole: &mut [Field], piece: Vec<Field>, what: &str) -> Result<()> {
    let unlike = || Error::input(format!("the {what} arrays differ from those of the previous pieces"));
    if whole.len() != piece.len() {
        return Err(unlike().remedy("write the pieces with the same arrays, or read them one at a time"));
    }
    for field in piece {
        let same = whole.iter_mut().find(|f| f.name == field.name && f.components == field.components);
        if !same.is_some_and(|f| append(&mut f.values, field.values)) {
            return Err(unlike()
                .at(format!("array {}", field.name))
                .remedy("write the pieces with the same arrays, or read them one at a time"));
        }
    }
    Ok(())
}

/// Appends `more` to `cells`, with `shift` added to its ids.
fn push_cells(cells: &mut Cells, more: &Cells, shift: u32) -> Result<()> {
    if cells.connectivity().items().len() + more.connectivity().items().len() > VertexId::MAX_COUNT {
        return Err(
            Error::input("all pieces together have too many cells").remedy("read the pieces one at a time")
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
