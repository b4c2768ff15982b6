//! Gmsh's element types and the correspondence of their nodes with VTK's order.

use crate::io::node_order::{Nodes, vtk_to_other};
use crate::mesh::CellKind;

/// An element type.
#[derive(Debug)]
pub(super) struct ElementType {
    /// Gmsh's number of the type.
    pub(super) number: i32,
    /// The cell kind of the elements.
    pub(super) kind: CellKind,
    /// For each node in VTK's order, its position in Gmsh's order.
    pub(super) vtk_to_gmsh: Vec<usize>,
}

/// Nodes of second-order elements as drawn in the Gmsh reference manual ("Node ordering").
const HEXAHEDRON: Nodes = &[
    &[0, 1],
    &[0, 3],
    &[0, 4],
    &[1, 2],
    &[1, 5],
    &[2, 3],
    &[2, 6],
    &[3, 7],
    &[4, 5],
    &[4, 7],
    &[5, 6],
    &[6, 7],
    &[0, 1, 2, 3],
    &[0, 1, 4, 5],
    &[0, 3, 4, 7],
    &[1, 2, 5, 6],
    &[2, 3, 6, 7],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];
const PRISM: Nodes = &[
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[3, 5],
    &[4, 5],
    &[0, 1, 3, 4],
    &[0, 2, 3, 5],
    &[1, 2, 4, 5],
];
const PYRAMID: Nodes =
    &[&[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 4], &[2, 3], &[2, 4], &[3, 4], &[0, 1, 2, 3]];
const TETRAHEDRON: Nodes = &[&[0, 1], &[1, 2], &[2, 0], &[3, 0], &[2, 3], &[1, 3]];

/// Every type that is read and written. A pyramid of 14 nodes has no kind of its own in VTK: it becomes an
/// arbitrary-order one.
const TYPES: &[(i32, CellKind, usize, Nodes)] = &[
    (15, CellKind::VERTEX, 1, &[]),
    (1, CellKind::LINE, 2, &[]),
    (2, CellKind::TRIANGLE, 3, &[]),
    (3, CellKind::QUAD, 4, &[]),
    (4, CellKind::TETRA, 4, &[]),
    (5, CellKind::HEXAHEDRON, 8, &[]),
    (6, CellKind::WEDGE, 6, &[]),
    (7, CellKind::PYRAMID, 5, &[]),
    (8, CellKind::QUADRATIC_LINE, 3, &[]),
    (9, CellKind::QUADRATIC_TRIANGLE, 6, &[]),
    (16, CellKind::QUADRATIC_QUAD, 8, &[]),
    (10, CellKind::BIQUADRATIC_QUAD, 9, &[]),
    (11, CellKind::QUADRATIC_TETRA, 10, TETRAHEDRON),
    (17, CellKind::QUADRATIC_HEXAHEDRON, 20, HEXAHEDRON),
    (12, CellKind::TRIQUADRATIC_HEXAHEDRON, 27, HEXAHEDRON),
    (18, CellKind::QUADRATIC_WEDGE, 15, PRISM),
    (13, CellKind::BIQUADRATIC_QUADRATIC_WEDGE, 18, PRISM),
    (19, CellKind::QUADRATIC_PYRAMID, 13, PYRAMID),
    (14, CellKind::LAGRANGE_PYRAMID, 14, PYRAMID),
    (26, CellKind::CUBIC_LINE, 4, &[]),
];

/// All types, with their node orders.
pub(super) fn element_types() -> Vec<ElementType> {
    let order =
        |&(number, kind, n, nodes)| ElementType { number, kind, vtk_to_gmsh: vtk_to_other(kind, n, nodes) };
    TYPES.iter().map(order).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_is_a_permutation() {
        for t in element_types() {
            let mut sorted = t.vtk_to_gmsh.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..t.vtk_to_gmsh.len()).collect::<Vec<_>>(), "{}", t.kind.label());
            assert_eq!(sorted.len(), t.kind.n_vertices().unwrap_or(14), "{}", t.kind.label());
        }
    }
}
