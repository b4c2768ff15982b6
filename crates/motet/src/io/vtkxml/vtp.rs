//! Polygonal data (`.vtp`): vertices, lines, polygons, strips.

use crate::base::{CellId, Csr, Error, Result, VertexId};
use crate::io::format::WriteOptions;
use crate::io::labels::label_fields;
use crate::io::output::Output;
use crate::io::polygonal::{SECTIONS, kind_in_section, section_of};
use crate::io::scalar::select_rows;
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::io::vtkxml::pieces::read_pieces;
use crate::io::vtkxml::vtu::read_points;
use crate::io::vtkxml::writer::{Data, Writer, ends, plain};
use crate::mesh::{CellKind, Cells, Field, Mesh};

const KIND: &str = "PolyData";

pub(super) fn read(file: &File<'_>) -> Result<Mesh> {
    read_pieces(file, read_piece)
}

fn read_piece<'a>(file: &File<'a>, piece: &Element<'a>) -> Result<Mesh> {
    let n_points = piece.required_count("NumberOfPoints")?;
    let cells = read_cells(file, piece)?;
    Ok(Mesh {
        points: read_points(file, piece, n_points)?,
        point_data: file.fields(piece.child("PointData"), Some(n_points))?,
        cell_data: file.fields(piece.child("CellData"), Some(cells.len()))?,
        cells,
        ..Mesh::default()
    })
}

fn read_cells(file: &File<'_>, piece: &Element<'_>) -> Result<Cells> {
    let mut cells = Cells::new();
    for (section, (name, _)) in SECTIONS.iter().enumerate() {
        let n = piece.count(&format!("NumberOf{name}"))?.unwrap_or(0);
        if n == 0 {
            continue;
        }
        let Some(element) = piece.child(name) else {
            return Err(Error::input(format!("{n} {name} declared, but the element is missing"))
                .at(piece.place())
                .remedy("the file is damaged: write it again"));
        };
        let offsets = file.required_array(element, "offsets")?.offsets(n)?;
        let ids = file.required_array(element, "connectivity")?.ids(None)?;
        let n_ids = ids.len();
        if cells.connectivity().items().len() + n_ids > VertexId::MAX_COUNT {
            return Err(Error::input("more vertex ids than a mesh can hold").at(element.place()));
        }
        let vertices = bytemuck::allocation::cast_vec::<u32, VertexId>(ids);
        let lists = Csr::new(offsets, vertices).ok_or_else(|| {
            Error::input(format!("the offsets do not ascend from 0 to {n_ids}, the number of ids"))
                .at(element.place())
                .remedy("the file is damaged: write it again")
        })?;
        lists.iter().for_each(|list| cells.push(kind_in_section(section, list.len()), list.iter().copied()));
    }
    Ok(cells)
}

/// The cells of a mesh by section, and what sorting them changes.
struct Sections {
    lists: [Csr<VertexId>; 4],
    /// The cells in the order of the file; `None` if it is the order of the mesh.
    order: Option<Vec<usize>>,
    lost: Vec<String>,
}

impl Sections {
    fn of(cells: &Cells) -> Result<Self> {
        let mut sorted: [Vec<usize>; 4] = Default::default();
        let mut unsupported = Vec::new();
        for (cell, kind, _) in cells.iter() {
            match section_of(kind) {
                Some(section) => sorted[section].push(cell.index()),
                None => unsupported.push(kind),
            }
        }
        if unsupported.len() == cells.len() && !cells.is_empty() {
            return Err(Error::input(format!(
                "polygonal data cannot hold cells of kind {}, and the mesh has no others",
                unsupported[0].label()
            ))
            .remedy("write a .vtu, or extract the surface of the mesh first"));
        }
        let mut lost = lost_by_kind(unsupported);
        let lists = sorted.each_ref().map(|of_section| {
            let mut lists = Csr::default();
            of_section.iter().for_each(|&cell| lists.push(corners(cells, CellId::new(cell))));
            lists
        });
        let order = sorted.concat();
        let moved = order.windows(2).any(|w| w[0] > w[1]);
        if moved {
            lost.push(
                "the order of the cells is not kept: polygonal data store vertices, lines, polygons, then strips"
                    .into(),
            );
        }
        let order = (moved || order.len() != cells.len()).then_some(order);
        Ok(Self { lists, order, lost })
    }

    /// A cell array in the order of the file.
    fn sorted(&self, field: &Field) -> Field {
        match &self.order {
            None => field.clone(),
            Some(order) => {
                Field { values: select_rows(&field.values, field.components, order), ..field.clone() }
            }
        }
    }
}

fn corners(cells: &Cells, cell: CellId) -> impl Iterator<Item = VertexId> {
    let v = cells.vertices(cell);
    // The vertices of a pixel are numbered row by row, those of a quad around it.
    let pixel = cells.kind(cell) == CellKind::PIXEL;
    (0..v.len()).map(move |i| if pixel { v[[0, 1, 3, 2][i]] } else { v[i] })
}

fn lost_by_kind(mut kinds: Vec<CellKind>) -> Vec<String> {
    kinds.sort_unstable();
    kinds
        .chunk_by(|a, b| a == b)
        .map(|same| {
            format!(
                "{} cells of kind {} are not written: polygonal data have no such cells",
                same.len(),
                same[0].label()
            )
        })
        .collect()
}

/// Writes a mesh; returns what the format could not hold.
pub(super) fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let sections = Sections::of(&mesh.cells)?;
    let (label_cells, label_names) = label_fields(mesh);
    let cell_data: Vec<Field> =
        mesh.cell_data.iter().chain(&label_cells).map(|f| sections.sorted(f)).collect();
    let mut writer = Writer::new(KIND, options, output);
    let field_data: Vec<&Field> = mesh.field_data.iter().chain(&label_names).collect();
    if !field_data.is_empty() {
        writer.fields("FieldData", &field_data, true)?;
    }
    let counts: String = SECTIONS
        .iter()
        .zip(&sections.lists)
        .map(|((name, _), l)| format!(" NumberOf{name}=\"{}\"", l.len()))
        .collect();
    writer.open(&format!("Piece NumberOfPoints=\"{}\"{counts}", mesh.points.len()));
    writer.fields("PointData", &mesh.point_data.iter().collect::<Vec<_>>(), false)?;
    writer.fields("CellData", &cell_data.iter().collect::<Vec<_>>(), false)?;
    writer.open("Points");
    writer.array("Points", 3, None, Data::Points(&mesh.points))?;
    writer.close("Points");
    for ((name, _), lists) in SECTIONS.iter().zip(&sections.lists) {
        writer.open(name);
        writer.array("connectivity", 1, None, Data::Ids(plain(lists.items())))?;
        writer.array("offsets", 1, None, Data::Ids(ends(lists)))?;
        writer.close(name);
    }
    writer.close("Piece");
    let mut lost = writer.finish(KIND)?;
    lost.extend(sections.lost.iter().cloned());
    Ok(lost)
}
