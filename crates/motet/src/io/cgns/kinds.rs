//! Element types: their numbers in files, the cell kind of each, and the order of its nodes.

use crate::io::node_order::{Nodes, vtk_to_other};
use crate::mesh::CellKind;

/// A section with elements of several types.
pub(super) const MIXED: i64 = 20;
/// A section of polygons.
pub(super) const NGON: i64 = 22;
/// A section of polyhedra, each a list of polygons.
pub(super) const NFACE: i64 = 23;

/// An element type with a fixed number of nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElementType {
    pub(super) number: i64,
    pub(super) name: &'static str,
    pub(super) n_nodes: usize,
    /// `None` for types of order three and four without a cell kind here.
    pub(super) kind: Option<CellKind>,
}

const fn row(number: i64, name: &'static str, n_nodes: usize, kind: CellKind) -> ElementType {
    ElementType { number, name, n_nodes, kind: Some(kind) }
}

const fn unsupported(number: i64, name: &'static str, n_nodes: usize) -> ElementType {
    ElementType { number, name, n_nodes, kind: None }
}

/// Element types in the order of SIDS, "ElementType_t".
const TYPES: &[ElementType] = &[
    row(2, "NODE", 1, CellKind::VERTEX),
    row(3, "BAR_2", 2, CellKind::LINE),
    row(4, "BAR_3", 3, CellKind::QUADRATIC_LINE),
    row(5, "TRI_3", 3, CellKind::TRIANGLE),
    row(6, "TRI_6", 6, CellKind::QUADRATIC_TRIANGLE),
    row(7, "QUAD_4", 4, CellKind::QUAD),
    row(8, "QUAD_8", 8, CellKind::QUADRATIC_QUAD),
    row(9, "QUAD_9", 9, CellKind::BIQUADRATIC_QUAD),
    row(10, "TETRA_4", 4, CellKind::TETRA),
    row(11, "TETRA_10", 10, CellKind::QUADRATIC_TETRA),
    row(12, "PYRA_5", 5, CellKind::PYRAMID),
    row(13, "PYRA_14", 14, CellKind::LAGRANGE_PYRAMID),
    row(14, "PENTA_6", 6, CellKind::WEDGE),
    row(15, "PENTA_15", 15, CellKind::QUADRATIC_WEDGE),
    row(16, "PENTA_18", 18, CellKind::BIQUADRATIC_QUADRATIC_WEDGE),
    row(17, "HEXA_8", 8, CellKind::HEXAHEDRON),
    row(18, "HEXA_20", 20, CellKind::QUADRATIC_HEXAHEDRON),
    row(19, "HEXA_27", 27, CellKind::TRIQUADRATIC_HEXAHEDRON),
    row(21, "PYRA_13", 13, CellKind::QUADRATIC_PYRAMID),
    row(24, "BAR_4", 4, CellKind::CUBIC_LINE),
    unsupported(25, "TRI_9", 9),
    unsupported(26, "TRI_10", 10),
    unsupported(27, "QUAD_12", 12),
    unsupported(28, "QUAD_16", 16),
    unsupported(29, "TETRA_16", 16),
    unsupported(30, "TETRA_20", 20),
    unsupported(31, "PYRA_21", 21),
    unsupported(32, "PYRA_29", 29),
    unsupported(33, "PYRA_30", 30),
    unsupported(34, "PENTA_24", 24),
    unsupported(35, "PENTA_38", 38),
    unsupported(36, "PENTA_40", 40),
    unsupported(37, "HEXA_32", 32),
    unsupported(38, "HEXA_56", 56),
    unsupported(39, "HEXA_64", 64),
    unsupported(40, "BAR_5", 5),
    unsupported(41, "TRI_12", 12),
    unsupported(42, "TRI_15", 15),
    unsupported(43, "QUAD_P4_16", 16),
    unsupported(44, "QUAD_25", 25),
    unsupported(45, "TETRA_22", 22),
    unsupported(46, "TETRA_34", 34),
    unsupported(47, "TETRA_35", 35),
    unsupported(48, "PYRA_P4_29", 29),
    unsupported(49, "PYRA_50", 50),
    unsupported(50, "PYRA_55", 55),
    unsupported(51, "PENTA_33", 33),
    unsupported(52, "PENTA_66", 66),
    unsupported(53, "PENTA_75", 75),
    unsupported(54, "HEXA_44", 44),
    unsupported(55, "HEXA_98", 98),
    unsupported(56, "HEXA_125", 125),
];

impl ElementType {
    /// The type with this number.
    pub(super) fn of(number: i64) -> Option<Self> {
        TYPES.iter().find(|t| t.number == number).copied()
    }

    /// The type that cells of a kind with this number of vertices are written as.
    pub(super) fn of_kind(kind: CellKind, n_vertices: usize) -> Option<Self> {
        TYPES.iter().find(|t| t.kind == Some(kind) && t.n_nodes == n_vertices).copied()
    }

    /// For each node in VTK's order, its position in CGNS's order.
    pub(super) fn vtk_to_cgns(self) -> Vec<usize> {
        let order = |theirs| vtk_to_other(self.kind.unwrap_or(CellKind::EMPTY), self.n_nodes, theirs);
        match self.number {
            15 => order(WEDGE.split_at(9).0),
            16 => order(WEDGE),
            18 => order(HEXAHEDRON.split_at(12).0),
            19 => order(HEXAHEDRON),
            // The other types have the same order in both.
            _ => (0..self.n_nodes).collect(),
        }
    }
}

/// SIDS, "Unstructured Grid Element Numbering Conventions", "Pentahedral Elements".
const WEDGE: Nodes = &[
    &[0, 1],
    &[1, 2],
    &[2, 0],
    &[0, 3],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[4, 5],
    &[5, 3],
    &[0, 1, 3, 4],
    &[1, 2, 4, 5],
    &[2, 0, 5, 3],
];

/// SIDS, "Unstructured Grid Element Numbering Conventions", "Hexahedral Elements".
const HEXAHEDRON: Nodes = &[
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 1, 2, 3],
    &[0, 1, 4, 5],
    &[1, 2, 5, 6],
    &[2, 3, 6, 7],
    &[0, 3, 4, 7],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_has_its_number_of_nodes_and_an_order_of_all_of_them() {
        for t in TYPES {
            assert_eq!(ElementType::of(t.number), Some(*t));
            let in_name = t.name.rsplit('_').next().unwrap();
            assert_eq!(in_name.parse().unwrap_or(1), t.n_nodes, "{}", t.name);
            let Some(kind) = t.kind else { continue };
            assert!(kind.n_vertices().is_none_or(|n| n == t.n_nodes), "{}", t.name);
            assert_eq!(ElementType::of_kind(kind, t.n_nodes), Some(*t));
            let mut order = t.vtk_to_cgns();
            order.sort_unstable();
            assert_eq!(order, (0..t.n_nodes).collect::<Vec<_>>());
        }
        assert_eq!(ElementType::of(MIXED), None);
    }
}
