//! The positions of higher-order nodes of quadratic cells, and conversions between node orders.
//!
//! A node between two corners is the midpoint of their edge, one between four lies on a face, one between
//! eight in the middle of a hexahedron. The nodes of each format are listed by these sets of corners; equal
//! sets are equal nodes.
//!
//! Corners need no list: all formats here go around the base, then around the top in the same direction. The
//! corners 0, 1, 2 of a wedge run counterclockwise as seen from 3, 4, 5: the orientation to which Gmsh,
//! Medit, Verdict and recent VTK (9.4 and later) assign a positive volume. The documentation of older VTK
//! releases had the opposite orientation.

use crate::mesh::CellKind;

/// For each node after the corners, the corners that it lies between.
pub(super) type Nodes = &'static [&'static [u8]];

/// VTK's order, for the kinds for which other formats differ.
const VTK: &[(CellKind, Nodes)] = &[
    (CellKind::QUADRATIC_TETRA, &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]]),
    (CellKind::QUADRATIC_HEXAHEDRON, VTK_HEXAHEDRON.split_at(12).0),
    (CellKind::TRIQUADRATIC_HEXAHEDRON, VTK_HEXAHEDRON),
    (CellKind::QUADRATIC_WEDGE, VTK_WEDGE.split_at(9).0),
    (CellKind::BIQUADRATIC_QUADRATIC_WEDGE, VTK_WEDGE),
    (CellKind::QUADRATIC_PYRAMID, VTK_PYRAMID.split_at(8).0),
    (CellKind::LAGRANGE_PYRAMID, VTK_PYRAMID),
];

const VTK_HEXAHEDRON: Nodes = &[
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[0, 3, 4, 7],
    &[1, 2, 5, 6],
    &[0, 1, 4, 5],
    &[2, 3, 6, 7],
    &[0, 1, 2, 3],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];

const VTK_WEDGE: Nodes = &[
    &[0, 1],
    &[1, 2],
    &[2, 0],
    &[3, 4],
    &[4, 5],
    &[5, 3],
    &[0, 3],
    &[1, 4],
    &[2, 5],
    &[0, 1, 3, 4],
    &[1, 2, 4, 5],
    &[2, 0, 5, 3],
];

const VTK_PYRAMID: Nodes =
    &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4], &[0, 1, 2, 3]];

/// For each node of a cell in VTK's order, its position in the order `theirs`; the identity for kinds without
/// a row in `VTK`.
pub(super) fn vtk_to_other(kind: CellKind, n_vertices: usize, theirs: Nodes) -> Vec<usize> {
    let Some((_, vtk)) = VTK.iter().find(|(k, _)| *k == kind) else {
        return (0..n_vertices).collect();
    };
    let n_corners = n_vertices - vtk.len();
    let place = |node: &[u8]| theirs.iter().position(|t| corners(t) == corners(node));
    let further = vtk.iter().map(|node| n_corners + place(node).expect("the tables list the same nodes"));
    (0..n_corners).chain(further).collect()
}

fn corners(node: &[u8]) -> u32 {
    node.iter().fold(0, |set, &c| set | 1 << c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converting_to_the_same_order_is_the_identity() {
        for &(kind, nodes) in VTK {
            let n = kind.n_vertices().unwrap_or(14);
            assert_eq!(vtk_to_other(kind, n, nodes), (0..n).collect::<Vec<_>>(), "{}", kind.label());
        }
    }

    #[test]
    fn gmsh_swaps_two_edge_nodes_of_a_tet() {
        let gmsh: Nodes = &[&[0, 1], &[1, 2], &[2, 0], &[3, 0], &[2, 3], &[1, 3]];
        assert_eq!(vtk_to_other(CellKind::QUADRATIC_TETRA, 10, gmsh), [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]);
    }
}
