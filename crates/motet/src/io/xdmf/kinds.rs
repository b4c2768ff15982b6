//! Topologies: their names, numbers and kinds of cells.

use crate::mesh::CellKind;

/// A topology.
pub(super) struct Topology {
    /// The name written, and other names read; all regardless of case.
    pub(super) names: &'static [&'static str],
    /// The number in mixed topologies.
    pub(super) number: u32,
    /// The kind of cell, and the kind for another number of nodes than that has.
    pub(super) kinds: [CellKind; 2],
}

const fn topology(names: &'static [&'static str], number: u32, kind: CellKind) -> Topology {
    Topology { names, number, kinds: [kind, kind] }
}

const TOPOLOGIES: &[Topology] = &[
    Topology { names: &["Polyvertex"], number: 1, kinds: [CellKind::VERTEX, CellKind::POLY_VERTEX] },
    Topology { names: &["Polyline"], number: 2, kinds: [CellKind::LINE, CellKind::POLY_LINE] },
    topology(&["Polygon"], 3, CellKind::POLYGON),
    topology(&["Triangle"], 4, CellKind::TRIANGLE),
    topology(&["Quadrilateral"], 5, CellKind::QUAD),
    topology(&["Tetrahedron"], 6, CellKind::TETRA),
    topology(&["Pyramid"], 7, CellKind::PYRAMID),
    topology(&["Wedge"], 8, CellKind::WEDGE),
    topology(&["Hexahedron"], 9, CellKind::HEXAHEDRON),
    topology(&["Edge_3"], 0x22, CellKind::QUADRATIC_LINE),
    topology(&["Quadrilateral_9", "Quad_9"], 0x23, CellKind::BIQUADRATIC_QUAD),
    topology(&["Triangle_6", "Tri_6"], 0x24, CellKind::QUADRATIC_TRIANGLE),
    topology(&["Quadrilateral_8", "Quad_8"], 0x25, CellKind::QUADRATIC_QUAD),
    topology(&["Tetrahedron_10", "Tet_10"], 0x26, CellKind::QUADRATIC_TETRA),
];

impl Topology {
    /// The topology with this name.
    pub(super) fn named(name: &str) -> Option<&'static Self> {
        TOPOLOGIES.iter().find(|t| t.names.iter().any(|known| known.eq_ignore_ascii_case(name)))
    }

    /// The topology with this number.
    pub(super) fn numbered(number: u32) -> Option<&'static Self> {
        TOPOLOGIES.iter().find(|t| t.number == number)
    }

    /// The topology of cells of a kind.
    pub(super) fn of(kind: CellKind) -> Option<&'static Self> {
        TOPOLOGIES.iter().find(|t| t.kinds.contains(&kind))
    }

    /// Whether the number of nodes varies from cell to cell, so that mixed topologies tell it.
    pub(super) fn has_count(&self) -> bool {
        self.number <= 3
    }

    /// The kind of a cell with this number of nodes; `None` if there is none.
    pub(super) fn kind(&self, n_nodes: usize) -> Option<CellKind> {
        self.kinds
            .into_iter()
            .find(|kind| kind.n_vertices().is_none_or(|n| n == n_nodes))
            .filter(|_| n_nodes > 0)
    }

    /// The number of nodes of each cell, unless it varies.
    pub(super) fn n_nodes(&self) -> Option<usize> {
        if self.has_count() { None } else { self.kinds[0].n_vertices() }
    }
}
