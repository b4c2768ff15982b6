//! Element types: the numbers of I-DEAS ("finite element descriptors") and the order of nodes.

use crate::mesh::CellKind;

/// A kind of cell, the descriptor written for it, and for each node of the file its position in VTK's order.
type Element = (CellKind, i64, &'static [usize]);

const ELEMENTS: &[Element] = &[
    (CellKind::LINE, 21, &[0, 1]),
    (CellKind::QUADRATIC_LINE, 24, &[0, 2, 1]),
    (CellKind::TRIANGLE, 91, &[0, 1, 2]),
    (CellKind::QUADRATIC_TRIANGLE, 92, &[0, 3, 1, 4, 2, 5]),
    (CellKind::QUAD, 94, &[0, 1, 2, 3]),
    (CellKind::QUADRATIC_QUAD, 95, &[0, 4, 1, 5, 2, 6, 3, 7]),
    (CellKind::TETRA, 111, &[0, 1, 2, 3]),
    (CellKind::WEDGE, 112, &[0, 1, 2, 3, 4, 5]),
    (CellKind::QUADRATIC_WEDGE, 113, &[0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11]),
    (CellKind::HEXAHEDRON, 115, &[0, 1, 2, 3, 4, 5, 6, 7]),
    (
        CellKind::QUADRATIC_HEXAHEDRON,
        116,
        &[0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15],
    ),
    (CellKind::QUADRATIC_TETRA, 118, &[0, 4, 1, 5, 2, 6, 7, 8, 9, 3]),
];

/// Whether elements with this descriptor are rods or beams, whose section has a record of its own.
pub(super) fn is_beam(descriptor: i64) -> bool {
    matches!(descriptor, 11 | 21..=24)
}

/// The element with this descriptor and number of nodes; `None` if it is no cell here. Plane, plate,
/// membrane, axisymmetric and shell elements of the same number of nodes are the same cell.
pub(super) fn element(descriptor: i64, n_nodes: usize) -> Option<&'static Element> {
    let dim = match descriptor {
        11 | 21..=24 => 1,
        41..=46 | 51..=56 | 61..=66 | 71..=76 | 81..=86 | 91..=96 => 2,
        111..=118 => 3,
        _ => return None,
    };
    ELEMENTS.iter().find(|(kind, _, order)| kind.dim() == Some(dim) && order.len() == n_nodes)
}

/// How cells of a kind are written, if they are.
pub(super) fn written_as(kind: CellKind) -> Option<&'static Element> {
    ELEMENTS.iter().find(|(known, ..)| *known == kind)
}
