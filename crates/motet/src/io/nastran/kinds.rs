//! Elements: their names, nodes and kinds of cells.

use crate::mesh::CellKind;

/// A kind of element.
pub(super) struct Element {
    /// The name written first, then others read.
    pub(super) names: &'static [&'static str],
    /// Whether the second field is a property; the nodes follow.
    has_property: bool,
    /// The kinds of cells with corner nodes only and, if the element may have them, with middle nodes.
    kinds: &'static [CellKind],
}

const ELEMENTS: &[Element] = &[
    element(&["CTETRA"], &[CellKind::TETRA, CellKind::QUADRATIC_TETRA]),
    element(&["CPYRAM", "CPYRA"], &[CellKind::PYRAMID, CellKind::QUADRATIC_PYRAMID]),
    element(&["CPENTA"], &[CellKind::WEDGE, CellKind::QUADRATIC_WEDGE]),
    element(&["CHEXA"], &[CellKind::HEXAHEDRON, CellKind::QUADRATIC_HEXAHEDRON]),
    element(&["CTRIA3", "CTRIAR"], &[CellKind::TRIANGLE]),
    element(&["CTRIA6"], &[CellKind::TRIANGLE, CellKind::QUADRATIC_TRIANGLE]),
    element(&["CQUAD4", "CQUADR", "CSHEAR"], &[CellKind::QUAD]),
    element(&["CQUAD8"], &[CellKind::QUAD, CellKind::QUADRATIC_QUAD]),
    element(&["CROD", "CBAR", "CBEAM", "CTUBE"], &[CellKind::LINE]),
    Element { names: &["PLOTEL", "CONROD"], has_property: false, kinds: &[CellKind::LINE] },
];

const fn element(names: &'static [&'static str], kinds: &'static [CellKind]) -> Element {
    Element { names, has_property: true, kinds }
}

/// For each node of the file its position in VTK's order, where that differs.
const ORDERS: &[(CellKind, &[usize])] = &[
    (CellKind::QUADRATIC_WEDGE, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11]),
    (CellKind::QUADRATIC_HEXAHEDRON, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15]),
];

impl Element {
    /// The element with this name.
    pub(super) fn named(name: &str) -> Option<&'static Self> {
        ELEMENTS.iter().find(|element| element.names.contains(&name))
    }

    /// How cells of a kind are written, if they are.
    pub(super) fn written_as(kind: CellKind) -> Option<&'static Self> {
        ELEMENTS.iter().find(|element| element.kinds.contains(&kind))
    }

    /// The number of the first field with a node.
    pub(super) fn first_node(&self) -> usize {
        if self.has_property { 3 } else { 2 }
    }

    /// The kind of a cell whose nodes are there or not; `Err` has the number of corners and of all nodes.
    pub(super) fn kind(&self, has_node: impl Fn(usize) -> bool) -> Result<CellKind, [usize; 2]> {
        let counts = [self.kinds.first(), self.kinds.last()]
            .map(|kind| kind.and_then(|kind| kind.n_vertices()).unwrap_or(0));
        let [n_corners, n_all] = counts;
        let has_middles = (n_corners..n_all).any(&has_node);
        let kind = if has_middles { self.kinds.last() } else { self.kinds.first() };
        let n = if has_middles { n_all } else { n_corners };
        kind.copied().filter(|_| (0..n).all(&has_node)).ok_or(counts)
    }
}

/// For each node of the file its position in VTK's order; `None` where both are the same.
pub(super) fn order(kind: CellKind) -> Option<&'static [usize]> {
    ORDERS.iter().find(|(known, _)| *known == kind).map(|(_, order)| *order)
}
