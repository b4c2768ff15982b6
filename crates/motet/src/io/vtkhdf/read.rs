//! Reads the mesh of a file, or of one of its steps.

use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::hdf::{Group, open};
use crate::io::labels::extract_label_names;
use crate::io::polygonal::kind_in_section;
use crate::io::polyhedra::cells_with_polyhedra;
use crate::io::surplus_points::trim;
use crate::io::vtkhdf::SECTIONS;
use crate::io::vtkhdf::frame::{Frame, Steps, counts};
use crate::io::vtkhdf::lists::{Part, Source};
use crate::io::weld::weld;
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let root = root_of(&open(input.bytes)?)?;
    let Some(steps) = Steps::of(&root)? else { return mesh_of(&root, &Frame::whole(&root)?, input.notes) };
    let n = steps.times.len();
    if n > 1 {
        input
            .notes
            .add(format!("the file has {n} steps: only the first is read (time {:?})", steps.times[0]));
    }
    mesh_of(&root, &Frame::of_step(&root, &steps, 0)?, input.notes)
}

/// The root group of the data, after checks of its version and type.
pub(super) fn root_of(file: &Group) -> Result<Group> {
    let root = file.group("VTKHDF")?.ok_or_else(|| {
        Error::input("is an HDF5 file without a group VTKHDF")
            .remedy("give the file the extension of its format")
    })?;
    let version = root.ints("Version").unwrap_or_default();
    if !matches!(version.first(), Some(1 | 2)) {
        return Err(Error::input(format!("expected VTKHDF version 1 or 2, found {version:?}")).at("/VTKHDF"));
    }
    let other = match root.text("Type") {
        Some("UnstructuredGrid" | "PolyData") => return Ok(root),
        other => other.unwrap_or("data without a type").to_owned(),
    };
    Err(Error::input(format!("expected a mesh of points and cells, found {other}"))
        .at("/VTKHDF")
        .remedy(match other.as_str() {
            "PartitionedDataSetCollection" | "MultiBlockDataSet" => {
                "in ParaView, apply `Merge Blocks` and save the data as .vtkhdf or .vtu"
            }
            _ => "in ParaView, apply `Append Datasets` (or vtkAppendFilter) and save the data as .vtkhdf or .vtu",
        }))
}

/// Reads the mesh of a frame.
pub(super) fn mesh_of(root: &Group, frame: &Frame<'_>, notes: &Notes) -> Result<Mesh> {
    let n_points = counts(root, "NumberOfPoints", &frame.parts)?;
    let first_point = frame.first_point()?;
    let points = read_points(root, first_point, &n_points)?;
    let (cells, first_cell) = match root.text("Type") {
        Some("PolyData") => read_sections(root, frame, &n_points)?,
        _ => read_grid(root, frame, &n_points, notes)?,
    };
    let mut mesh = Mesh {
        point_data: read_arrays(root, frame, "PointData", first_point, points.len(), notes)?,
        cell_data: read_arrays(root, frame, "CellData", first_cell, cells.len(), notes)?,
        field_data: read_field_data(root, frame, notes)?,
        points,
        cells,
        ..Mesh::default()
    };
    if n_points.len() > 1 {
        mesh.validate()?;
        let starts = n_points.iter().scan(0, |end, n| Some(std::mem::replace(end, *end + n)));
        weld(&mut mesh, &starts.collect::<Vec<_>>(), notes);
    }
    extract_label_names(&mut mesh);
    Ok(mesh)
}

fn sum(counts: &[usize]) -> usize {
    counts.iter().fold(0, |sum, n| sum.saturating_add(*n))
}

fn read_points(root: &Group, first: usize, counts: &[usize]) -> Result<Vec<Point>> {
    let array = root.required_array("Points")?;
    let n = sum(counts);
    if n > VertexId::MAX_COUNT {
        return Err(array.error(format!("{n} points are more than a mesh can hold")));
    }
    if array.components() != 3 {
        return Err(array.error(format!("expected 3 coordinates per point, found {}", array.components())));
    }
    match array.values(first..first.saturating_add(n))? {
        Values::F64(flat) => {
            Ok(bytemuck::allocation::try_cast_vec(flat)
                .unwrap_or_else(|(_, f)| f.as_chunks::<3>().0.to_vec()))
        }
        other => {
            let flat = other.to_f64().ok_or_else(|| array.error("coordinates are not numbers"))?;
            Ok(flat.as_chunks::<3>().0.to_vec())
        }
    }
}

/// Reads the vertex lists of the cells of a group; also returns its first cell. `column` is the index of the
/// group among the groups of cells.
fn read_lists(
    group: &Group,
    frame: &Frame<'_>,
    column: usize,
    n_points: &[usize],
) -> Result<(Csr<u32>, usize)> {
    let n_lists = counts(group, "NumberOfCells", &frame.parts)?;
    let n_ids = counts(group, "NumberOfConnectivityIds", &frame.parts)?;
    let first = frame.start("CellOffsets", column, || frame.rows_before(group, "NumberOfCells"))?;
    let source = Source {
        group,
        offsets: "Offsets",
        first_offset: first.saturating_add(frame.parts.start),
        ids: "Connectivity",
        first_id: frame
            .start("ConnectivityIdOffsets", column, || frame.rows_before(group, "NumberOfConnectivityIds"))?,
    };
    Ok((source.read(&parts(&n_lists, &n_ids, n_points))?, first))
}

fn parts(n_lists: &[usize], n_ids: &[usize], n_targets: &[usize]) -> Vec<Part> {
    let counts = n_lists.iter().zip(n_ids).zip(n_targets);
    counts.map(|((&n_lists, &n_ids), &n_targets)| Part { n_lists, n_ids, n_targets }).collect()
}

/// Reads the cells of an unstructured grid; also returns its first cell.
fn read_grid(root: &Group, frame: &Frame<'_>, n_points: &[usize], notes: &Notes) -> Result<(Cells, usize)> {
    let (lists, first) = read_lists(root, frame, 0, n_points)?;
    let types = root.required_array("Types")?;
    let numbers = types.ints(first..first.saturating_add(lists.len()))?;
    let kinds: Option<Vec<CellKind>> = numbers.iter().map(|&n| u8::try_from(n).ok().map(CellKind)).collect();
    let kinds = kinds.ok_or_else(|| types.error("a cell type is not between 0 and 255"))?;
    let mut offsets = lists.offsets().to_vec();
    let mut vertices: Vec<VertexId> = lists.items().iter().map(|&v| VertexId(v)).collect();
    trim(&kinds, &mut offsets, &mut vertices, notes);
    let cells = match kinds.contains(&CellKind::POLYHEDRON) {
        false => Cells::from_parts(kinds, offsets, vertices),
        true => {
            let faces = read_faces(root, frame, first, n_points, &kinds)?;
            cells_with_polyhedra(&kinds, offsets, vertices, faces)
        }
    };
    Ok((cells.map_err(|e| e.at(root.path()))?, first))
}

/// Reads the faces of each polyhedron.
fn read_faces(
    root: &Group,
    frame: &Frame<'_>,
    first_cell: usize,
    n_points: &[usize],
    kinds: &[CellKind],
) -> Result<Vec<Csr<VertexId>>> {
    let of = |name| counts(root, name, &frame.parts);
    let n_faces = of("NumberOfFaces")?;
    let first_face = |name| frame.rows_before(root, name);
    let corners = Source {
        group: root,
        offsets: "FaceOffsets",
        first_offset: frame
            .start("FaceOffsetsOffsets", 0, || first_face("NumberOfFaces"))?
            .saturating_add(frame.parts.start),
        ids: "FaceConnectivity",
        first_id: frame.start("FaceConnectivityOffsets", 0, || first_face("NumberOfFaceConnectivityIds"))?,
    };
    let of_cells = Source {
        group: root,
        offsets: "PolyhedronOffsets",
        first_offset: first_cell.saturating_add(frame.parts.start),
        ids: "PolyhedronToFaces",
        first_id: frame
            .start("PolyhedronToFaceIdOffsets", 0, || first_face("NumberOfPolyhedronToFaceIds"))?,
    };
    let corners = corners.read(&parts(&n_faces, &of("NumberOfFaceConnectivityIds")?, n_points))?;
    let n_cells = counts(root, "NumberOfCells", &frame.parts)?;
    let of_cells = of_cells.read(&parts(&n_cells, &of("NumberOfPolyhedronToFaceIds")?, &n_faces))?;
    let polyhedra = of_cells.iter().zip(kinds).filter(|(_, kind)| **kind == CellKind::POLYHEDRON);
    let mut budget = corners.items().len().saturating_mul(2);
    let faces_of = |(list, _): (&[u32], _)| {
        let mut faces = Csr::default();
        for &face in list {
            let corners = corners.list(face as usize);
            // At most two polyhedra share a face; without this check the file would not bound the uses of a
            // face.
            budget = budget.checked_sub(corners.len()).ok_or_else(|| {
                Error::input("polyhedra refer to faces more than twice").at("/VTKHDF/PolyhedronToFaces")
            })?;
            faces.push(corners.iter().map(|&v| VertexId(v)));
        }
        Ok(faces)
    };
    polyhedra.map(faces_of).collect()
}

/// Reads the cells of polygonal data, in each part vertices, lines, polygons and strips, as in cell arrays;
/// also returns the first cell.
fn read_sections(root: &Group, frame: &Frame<'_>, n_points: &[usize]) -> Result<(Cells, usize)> {
    let mut sections = Vec::new();
    let (mut first_cell, mut n_ids) = (0usize, 0usize);
    for (section, name) in SECTIONS.iter().enumerate() {
        let Some(group) = root.group(name)? else { continue };
        let (lists, first) = read_lists(&group, frame, section, n_points)?;
        first_cell = first_cell.saturating_add(first);
        n_ids += lists.items().len();
        if n_ids > VertexId::MAX_COUNT {
            return Err(Error::input("more vertex ids than a mesh can hold").at(group.path()));
        }
        sections.push((section, lists, counts(&group, "NumberOfCells", &frame.parts)?));
    }
    let mut cells = Cells::new();
    let mut next = [0; SECTIONS.len()];
    for part in 0..frame.parts.len() {
        for (section, lists, counts) in &sections {
            let rows = next[*section]..next[*section] + counts[part];
            for list in rows.clone().map(|i| lists.list(i)) {
                cells.push(kind_in_section(*section, list.len()), list.iter().map(|&v| VertexId(v)));
            }
            next[*section] = rows.end;
        }
    }
    Ok((cells, first_cell))
}

/// Reads the arrays of a group with a row for each point or cell.
fn read_arrays(
    root: &Group,
    frame: &Frame<'_>,
    kind: &str,
    default: usize,
    n: usize,
    notes: &Notes,
) -> Result<Vec<Field>> {
    let Some(group) = root.group(kind)? else { return Ok(Vec::new()) };
    let mut fields = Vec::new();
    for name in group.arrays() {
        let array = group.required_array(name)?;
        if !array.is_supported() {
            notes.add(format!("{} contains neither numbers nor text: skipped", array.path()));
            continue;
        }
        let first = frame.first_value(kind, name, default)?;
        let values = array.values(first..first.saturating_add(n))?;
        fields.push(Field { name: name.clone(), components: array.components(), values });
    }
    Ok(fields)
}

/// Reads the field data arrays.
fn read_field_data(root: &Group, frame: &Frame<'_>, notes: &Notes) -> Result<Vec<Field>> {
    let Some(group) = root.group("FieldData")? else { return Ok(Vec::new()) };
    let mut fields = Vec::new();
    for name in group.arrays() {
        let array = group.required_array(name)?;
        if !array.is_supported() {
            notes.add(format!("{} contains neither numbers nor text: skipped", array.path()));
            continue;
        }
        let (rows, components) = frame.field_rows(name, &array)?;
        fields.push(Field { name: name.clone(), components, values: array.values(rows)? });
    }
    Ok(fields)
}
