//! The facets of each kind of cell, as local indices of its vertices in their order.

use crate::mesh::CellKind;

/// One facet of a kind of cell.
///
/// ```text
///        3            facets of a tet: 0 1 3 | 1 2 3 | 2 0 3 | 0 2 1
///       /|\           Seen from outside every ring runs counter-clockwise,
///      / | \          when the cell itself has positive volume. Order of
///     0 -|- 2         facets and of their vertices is VTK's own, except that
///      \ | /          a voxel's facets are rings too, not pixels.
///       \|/
///        1
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacetShape {
    /// The kind of surface cell that the facet is.
    pub kind: CellKind,
    /// Number of its corners; they come first among its vertices, as a ring.
    pub n_corners: usize,
    /// Local indices of its vertices in the cell: the corners, then the middle nodes.
    pub nodes: &'static [u8],
}

impl FacetShape {
    /// Local indices of its corners in the cell, as a ring.
    pub fn corners(&self) -> &'static [u8] {
        &self.nodes[..self.n_corners]
    }
}

const fn shape(kind: CellKind, n_corners: usize, nodes: &'static [u8]) -> FacetShape {
    FacetShape { kind, n_corners, nodes }
}
const fn tri(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::TRIANGLE, 3, nodes)
}
const fn quad(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::QUAD, 4, nodes)
}
const fn polygon(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::POLYGON, nodes.len(), nodes)
}
const fn tri6(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::QUADRATIC_TRIANGLE, 3, nodes)
}
const fn quad6(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::QUADRATIC_LINEAR_QUAD, 4, nodes)
}
const fn quad8(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::QUADRATIC_QUAD, 4, nodes)
}
const fn quad9(nodes: &'static [u8]) -> FacetShape {
    shape(CellKind::BIQUADRATIC_QUAD, 4, nodes)
}

const TETRA: &[FacetShape] = &[tri(&[0, 1, 3]), tri(&[1, 2, 3]), tri(&[2, 0, 3]), tri(&[0, 2, 1])];
const VOXEL: &[FacetShape] = &[
    quad(&[0, 4, 6, 2]),
    quad(&[1, 3, 7, 5]),
    quad(&[0, 1, 5, 4]),
    quad(&[2, 6, 7, 3]),
    quad(&[0, 2, 3, 1]),
    quad(&[4, 5, 7, 6]),
];
const HEXAHEDRON: &[FacetShape] = &[
    quad(&[0, 4, 7, 3]),
    quad(&[1, 2, 6, 5]),
    quad(&[0, 1, 5, 4]),
    quad(&[3, 7, 6, 2]),
    quad(&[0, 3, 2, 1]),
    quad(&[4, 5, 6, 7]),
];
const WEDGE: &[FacetShape] =
    &[tri(&[0, 2, 1]), tri(&[3, 4, 5]), quad(&[0, 1, 4, 3]), quad(&[1, 2, 5, 4]), quad(&[2, 0, 3, 5])];
const PYRAMID: &[FacetShape] =
    &[quad(&[0, 3, 2, 1]), tri(&[0, 1, 4]), tri(&[1, 2, 4]), tri(&[2, 3, 4]), tri(&[3, 0, 4])];
const PENTAGONAL_PRISM: &[FacetShape] = &[
    polygon(&[0, 4, 3, 2, 1]),
    polygon(&[5, 6, 7, 8, 9]),
    quad(&[0, 1, 6, 5]),
    quad(&[1, 2, 7, 6]),
    quad(&[2, 3, 8, 7]),
    quad(&[3, 4, 9, 8]),
    quad(&[4, 0, 5, 9]),
];
const HEXAGONAL_PRISM: &[FacetShape] = &[
    polygon(&[0, 5, 4, 3, 2, 1]),
    polygon(&[6, 7, 8, 9, 10, 11]),
    quad(&[0, 1, 7, 6]),
    quad(&[1, 2, 8, 7]),
    quad(&[2, 3, 9, 8]),
    quad(&[3, 4, 10, 9]),
    quad(&[4, 5, 11, 10]),
    quad(&[5, 0, 6, 11]),
];
const QUADRATIC_TETRA: &[FacetShape] = &[
    tri6(&[0, 1, 3, 4, 8, 7]),
    tri6(&[1, 2, 3, 5, 9, 8]),
    tri6(&[2, 0, 3, 6, 7, 9]),
    tri6(&[0, 2, 1, 6, 5, 4]),
];
const QUADRATIC_HEXAHEDRON: &[FacetShape] = &[
    quad8(&[0, 4, 7, 3, 16, 15, 19, 11]),
    quad8(&[1, 2, 6, 5, 9, 18, 13, 17]),
    quad8(&[0, 1, 5, 4, 8, 17, 12, 16]),
    quad8(&[3, 7, 6, 2, 19, 14, 18, 10]),
    quad8(&[0, 3, 2, 1, 11, 10, 9, 8]),
    quad8(&[4, 5, 6, 7, 12, 13, 14, 15]),
];
const QUADRATIC_WEDGE: &[FacetShape] = &[
    tri6(&[0, 2, 1, 8, 7, 6]),
    tri6(&[3, 4, 5, 9, 10, 11]),
    quad8(&[0, 1, 4, 3, 6, 13, 9, 12]),
    quad8(&[1, 2, 5, 4, 7, 14, 10, 13]),
    quad8(&[2, 0, 3, 5, 8, 12, 11, 14]),
];
const QUADRATIC_PYRAMID: &[FacetShape] = &[
    quad8(&[0, 3, 2, 1, 8, 7, 6, 5]),
    tri6(&[0, 1, 4, 5, 10, 9]),
    tri6(&[1, 2, 4, 6, 11, 10]),
    tri6(&[2, 3, 4, 7, 12, 11]),
    tri6(&[3, 0, 4, 8, 9, 12]),
];
const TRIQUADRATIC_HEXAHEDRON: &[FacetShape] = &[
    quad9(&[0, 4, 7, 3, 16, 15, 19, 11, 20]),
    quad9(&[1, 2, 6, 5, 9, 18, 13, 17, 21]),
    quad9(&[0, 1, 5, 4, 8, 17, 12, 16, 22]),
    quad9(&[3, 7, 6, 2, 19, 14, 18, 10, 23]),
    quad9(&[0, 3, 2, 1, 11, 10, 9, 8, 24]),
    quad9(&[4, 5, 6, 7, 12, 13, 14, 15, 25]),
];
const QUADRATIC_LINEAR_WEDGE: &[FacetShape] = &[
    tri6(&[0, 2, 1, 8, 7, 6]),
    tri6(&[3, 4, 5, 9, 10, 11]),
    quad6(&[0, 1, 4, 3, 6, 9]),
    quad6(&[1, 2, 5, 4, 7, 10]),
    quad6(&[2, 0, 3, 5, 8, 11]),
];
const BIQUADRATIC_QUADRATIC_WEDGE: &[FacetShape] = &[
    tri6(&[0, 2, 1, 8, 7, 6]),
    tri6(&[3, 4, 5, 9, 10, 11]),
    quad9(&[0, 1, 4, 3, 6, 13, 9, 12, 15]),
    quad9(&[1, 2, 5, 4, 7, 14, 10, 13, 16]),
    quad9(&[2, 0, 3, 5, 8, 12, 11, 14, 17]),
];
const BIQUADRATIC_QUADRATIC_HEXAHEDRON: &[FacetShape] = &[
    quad9(&[0, 4, 7, 3, 16, 15, 19, 11, 20]),
    quad9(&[1, 2, 6, 5, 9, 18, 13, 17, 21]),
    quad9(&[0, 1, 5, 4, 8, 17, 12, 16, 22]),
    quad9(&[3, 7, 6, 2, 19, 14, 18, 10, 23]),
    quad8(&[0, 3, 2, 1, 11, 10, 9, 8]),
    quad8(&[4, 5, 6, 7, 12, 13, 14, 15]),
];

/// The facets of a kind of volume cell, in VTK's order; `None` for kinds of other dimensions, for polyhedra
/// (which store their own faces) and for kinds whose facets are not known here (Lagrange cells of any order).
pub fn facet_shapes(kind: CellKind) -> Option<&'static [FacetShape]> {
    Some(match kind {
        CellKind::TETRA => TETRA,
        CellKind::VOXEL => VOXEL,
        CellKind::HEXAHEDRON => HEXAHEDRON,
        CellKind::WEDGE => WEDGE,
        CellKind::PYRAMID => PYRAMID,
        CellKind::PENTAGONAL_PRISM => PENTAGONAL_PRISM,
        CellKind::HEXAGONAL_PRISM => HEXAGONAL_PRISM,
        CellKind::QUADRATIC_TETRA => QUADRATIC_TETRA,
        CellKind::QUADRATIC_HEXAHEDRON => QUADRATIC_HEXAHEDRON,
        CellKind::QUADRATIC_WEDGE => QUADRATIC_WEDGE,
        CellKind::QUADRATIC_PYRAMID => QUADRATIC_PYRAMID,
        CellKind::TRIQUADRATIC_HEXAHEDRON => TRIQUADRATIC_HEXAHEDRON,
        CellKind::QUADRATIC_LINEAR_WEDGE => QUADRATIC_LINEAR_WEDGE,
        CellKind::BIQUADRATIC_QUADRATIC_WEDGE => BIQUADRATIC_QUADRATIC_WEDGE,
        CellKind::BIQUADRATIC_QUADRATIC_HEXAHEDRON => BIQUADRATIC_QUADRATIC_HEXAHEDRON,
        _ => return None,
    })
}
