//! Kinds of elements, and the order of their nodes.

use crate::mesh::CellKind;

/// A kind of cell, and for each node in VTK's order its position in Netgen's.
type Element = (CellKind, &'static [usize]);

const ELEMENTS: &[Element] = &[
    (CellKind::VERTEX, &[0]),
    (CellKind::LINE, &[0, 1]),
    (CellKind::TRIANGLE, &[0, 1, 2]),
    (CellKind::QUAD, &[0, 1, 2, 3]),
    (CellKind::QUADRATIC_TRIANGLE, &[0, 1, 2, 5, 3, 4]),
    (CellKind::QUADRATIC_QUAD, &[0, 1, 2, 3, 4, 7, 5, 6]),
    (CellKind::TETRA, &[0, 2, 1, 3]),
    (CellKind::PYRAMID, &[0, 3, 2, 1, 4]),
    (CellKind::WEDGE, &[0, 2, 1, 3, 5, 4]),
    (CellKind::HEXAHEDRON, &[0, 3, 2, 1, 4, 7, 6, 5]),
    (CellKind::QUADRATIC_TETRA, &[0, 2, 1, 3, 5, 7, 4, 6, 9, 8]),
    (CellKind::QUADRATIC_LINEAR_WEDGE, &[0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10]),
    (CellKind::QUADRATIC_PYRAMID, &[0, 3, 2, 1, 4, 7, 6, 8, 5, 9, 12, 11, 10]),
    (CellKind::QUADRATIC_HEXAHEDRON, &[0, 3, 2, 1, 4, 7, 6, 5, 10, 9, 11, 8, 14, 13, 15, 12, 16, 19, 18, 17]),
];

/// Maximum number of nodes of an element.
pub(super) const MAX_NODES: usize = 20;

/// The element of a dimension with a number of nodes.
pub(super) fn element(dim: usize, n_nodes: usize) -> Option<&'static Element> {
    ELEMENTS.iter().find(|(kind, order)| kind.dim() == Some(dim) && order.len() == n_nodes)
}

/// The order of the nodes of cells of a kind, if Netgen has such cells.
pub(super) fn order_of(kind: CellKind) -> Option<&'static [usize]> {
    ELEMENTS.iter().find(|(known, _)| *known == kind).map(|(_, order)| *order)
}
