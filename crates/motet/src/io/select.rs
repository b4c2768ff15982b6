//! Restriction of a mesh to what a format can hold, with messages about the rest.

use std::borrow::Cow;

use crate::base::{CellId, VertexId};
use crate::mesh::{Boundary, CellKind, Cells, Field, Mesh, corners};

/// The mesh with only those cells whose kind satisfies `holds`, and messages about the others.
pub(super) fn keep_cells<'m>(
    mesh: &'m Mesh,
    format: &str,
    holds: impl Fn(CellKind) -> bool,
) -> (Cow<'m, Mesh>, Vec<String>) {
    let counts = mesh.cells.counts();
    let lost: Vec<String> = counts
        .iter()
        .filter(|(kind, _)| !holds(*kind))
        .map(|(kind, n)| {
            format!("{n} cells of kind {} are not written: {format} has no such cells", kind.label())
        })
        .collect();
    if lost.is_empty() {
        return (Cow::Borrowed(mesh), lost);
    }
    (Cow::Owned(restricted_to_kinds(mesh, holds)), lost)
}

/// The mesh with only those cells whose kind satisfies `holds`, and with all its points.
pub(super) fn restricted_to_kinds(mesh: &Mesh, holds: impl Fn(CellKind) -> bool) -> Mesh {
    restricted_to_cells(mesh, |cell| holds(mesh.cells.kind(cell)))
}

/// The mesh with only those cells for which `keeps` is true, and with all its points.
pub(super) fn restricted_to_cells(mesh: &Mesh, keeps: impl Fn(CellId) -> bool) -> Mesh {
    let kept: Vec<usize> = (0..mesh.cells.len()).filter(|&i| keeps(CellId::new(i))).collect();
    let mut cells = Cells::new();
    let mut all_faces = mesh.cells.polyhedron_faces().iter();
    for (cell, kind, vertices) in mesh.cells.iter() {
        // The faces of all polyhedra are stored in order, including those of polyhedra that are dropped.
        let faces = if kind == CellKind::POLYHEDRON { all_faces.next() } else { None };
        let vertices = vertices.iter().copied();
        match (keeps(cell), kind) {
            (false, _) => {}
            (true, CellKind::POLYHEDRON) => {
                cells.push_polyhedron(vertices, faces.cloned().unwrap_or_default())
            }
            (true, _) => cells.push(kind, vertices),
        }
    }
    Mesh {
        points: mesh.points.clone(),
        cells,
        point_data: mesh.point_data.clone(),
        cell_data: mesh.cell_data.iter().map(|f| f.pick(kept.iter().copied())).collect(),
        field_data: mesh.field_data.clone(),
        label_names: mesh.label_names.clone(),
    }
}

/// The surface of a mesh, for formats of surfaces only: the mesh itself if it has cells of dimension 2, else
/// the boundary of its volume cells; and messages about what is not written.
pub(super) fn surface_of<'m>(mesh: &'m Mesh, format: &str) -> (Cow<'m, Mesh>, Vec<String>) {
    let has = |dim| mesh.cells.kinds().iter().any(|kind| kind.dim() == Some(dim));
    if has(2) || !has(3) {
        return (Cow::Borrowed(mesh), Vec::new());
    }
    let mut boundary = Boundary::of(&mesh.cells);
    boundary.turn_outward(&mesh.cells, &mesh.points);
    let facets = boundary.kinds.iter().zip(boundary.facets.iter()).map(|(kind, vertices)| {
        let ring = corners(*kind, vertices);
        let kind = match (*kind, ring.len()) {
            (CellKind::POLYGON, _) => CellKind::POLYGON,
            (_, 3) => CellKind::TRIANGLE,
            _ => CellKind::QUAD,
        };
        (kind, ring)
    });
    let cell_rows: Vec<usize> = boundary.cells.iter().map(|c| c.index()).collect();
    let mut surface = facet_mesh(mesh, &boundary.vertices, facets, &cell_rows);
    surface.field_data.clone_from(&mesh.field_data);
    surface.label_names.clone_from(&mesh.label_names);
    let note = format!(
        "{format} holds surfaces only: the boundary of the volume cells is written, their interior is not"
    );
    (Cow::Owned(surface), vec![note])
}

/// A mesh of facets with only the points `used`, in ascending order; cell arrays take the rows `cell_rows`.
pub(super) fn facet_mesh<'m>(
    mesh: &Mesh,
    used: &[VertexId],
    facets: impl IntoIterator<Item = (CellKind, &'m [VertexId])>,
    cell_rows: &[usize],
) -> Mesh {
    let place = |v: &VertexId| VertexId::new(used.partition_point(|u| u < v));
    let mut cells = Cells::new();
    facets.into_iter().for_each(|(kind, vertices)| cells.push(kind, vertices.iter().map(place)));
    let point_rows: Vec<usize> = used.iter().map(|v| v.index()).collect();
    Mesh {
        points: point_rows.iter().map(|&i| mesh.points[i]).collect(),
        cells,
        point_data: mesh.point_data.iter().map(|f| f.pick(point_rows.iter().copied())).collect(),
        cell_data: mesh.cell_data.iter().map(|f| f.pick(cell_rows.iter().copied())).collect(),
        ..Mesh::default()
    }
}

/// A message about arrays that a format cannot hold; `None` if there are no such arrays.
pub(super) fn lost_arrays<'f>(
    format: &str,
    what: &str,
    fields: impl IntoIterator<Item = &'f Field>,
) -> Option<String> {
    let names: Vec<&str> = fields.into_iter().map(|f| f.name.as_str()).collect();
    (!names.is_empty())
        .then(|| format!("{what} arrays are not written ({format} has none): {}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::VertexId;

    #[test]
    fn cell_arrays_follow_the_kept_cells() {
        let mut cells = Cells::new();
        cells.push(CellKind::LINE, [0, 1].map(VertexId));
        cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
        let mut mesh = Mesh::new(vec![[0.0; 3]; 3], cells);
        mesh.set_cell_field(Field { name: "v".into(), components: 2, values: vec![1u8, 2, 3, 4].into() });
        let (kept, lost) = keep_cells(&mesh, "X", |kind| kind == CellKind::TRIANGLE);
        assert_eq!(kept.cells.len(), 1);
        assert_eq!(kept.cell_data[0].values, vec![3u8, 4].into());
        assert_eq!(lost, ["1 cells of kind line are not written: X has no such cells"]);
    }
}
