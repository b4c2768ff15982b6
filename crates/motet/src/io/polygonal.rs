//! Kinds of faces, and the four sections of VTK's polygonal data.

use crate::mesh::CellKind;

/// The sections by their names in XML and in legacy files, in the order in which VTK counts the cells.
pub(super) const SECTIONS: [(&str, &str); 4] =
    [("Verts", "VERTICES"), ("Lines", "LINES"), ("Polys", "POLYGONS"), ("Strips", "TRIANGLE_STRIPS")];

/// The kind of a face with this many corners.
pub(super) fn kind_of_face(n_vertices: usize) -> CellKind {
    match n_vertices {
        0 => CellKind::EMPTY,
        1 => CellKind::VERTEX,
        2 => CellKind::LINE,
        3 => CellKind::TRIANGLE,
        4 => CellKind::QUAD,
        _ => CellKind::POLYGON,
    }
}

/// The kind of a cell in a section, following VTK.
pub(super) fn kind_in_section(section: usize, n_vertices: usize) -> CellKind {
    match (section, n_vertices) {
        (_, 0) => CellKind::EMPTY,
        (0, 1) => CellKind::VERTEX,
        (0, _) => CellKind::POLY_VERTEX,
        (1, 2) => CellKind::LINE,
        (1, _) => CellKind::POLY_LINE,
        (2, 3) => CellKind::TRIANGLE,
        (2, 4) => CellKind::QUAD,
        (2, _) => CellKind::POLYGON,
        _ => CellKind::TRIANGLE_STRIP,
    }
}

/// The section that holds cells of this kind, if any.
pub(super) fn section_of(kind: CellKind) -> Option<usize> {
    match kind {
        CellKind::VERTEX | CellKind::POLY_VERTEX => Some(0),
        CellKind::LINE | CellKind::POLY_LINE => Some(1),
        CellKind::TRIANGLE | CellKind::POLYGON | CellKind::PIXEL | CellKind::QUAD => Some(2),
        CellKind::TRIANGLE_STRIP => Some(3),
        _ => None,
    }
}
