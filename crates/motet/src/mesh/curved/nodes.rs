//! The middle nodes of quadratic cells, and the corners that each lies between.

use crate::mesh::CellKind;
use crate::mesh::facets::facet_shapes;

/// A node that is not a corner, and the corners that it lies between: two of an edge, four of a face, eight
/// of a hexahedron.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Middle {
    /// Local index of the node in the cell.
    pub node: usize,
    /// Local indices of the corners, in rising order.
    pub corners: Vec<usize>,
}

/// The middle nodes of a kind of quadratic volume cell, in rising order; none for other kinds.
pub fn middles(kind: CellKind) -> Vec<Middle> {
    let mut found: Vec<Middle> = Vec::new();
    let mut add = |node: u8, corners: &[u8]| {
        let mut corners: Vec<usize> = corners.iter().map(|&c| usize::from(c)).collect();
        corners.sort_unstable();
        found.push(Middle { node: usize::from(node), corners });
    };
    for facet in facet_shapes(kind).unwrap_or_default() {
        let (ring, others) = facet.nodes.split_at(facet.n_corners);
        let n = ring.len();
        // A facet that is straight in one direction has two middle nodes, which are also on triangles.
        if others.len() < n {
            continue;
        }
        (0..n).for_each(|i| add(others[i], &[ring[i], ring[(i + 1) % n]]));
        others.get(n).into_iter().for_each(|&centre| add(centre, ring));
    }
    if kind == CellKind::TRIQUADRATIC_HEXAHEDRON {
        add(26, &[0, 1, 2, 3, 4, 5, 6, 7]);
    }
    found.sort_unstable_by_key(|middle| middle.node);
    found.dedup_by_key(|middle| middle.node);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::curved::is_curved_kind;

    #[test]
    fn every_node_is_a_corner_or_a_middle() {
        for &kind in CellKind::NAMED.iter().filter(|kind| is_curved_kind(**kind)) {
            let n_corners = middles(kind)[0].node;
            let nodes: Vec<usize> = middles(kind).iter().map(|m| m.node).collect();
            assert_eq!(Some(n_corners + nodes.len()), kind.n_vertices(), "{kind:?}");
            assert_eq!(nodes, (n_corners..n_corners + nodes.len()).collect::<Vec<_>>());
            assert!(middles(kind).iter().all(|m| m.corners.iter().all(|&c| c < n_corners)));
        }
        assert!(middles(CellKind::TETRA).is_empty() && middles(CellKind::QUADRATIC_TRIANGLE).is_empty());
    }
}
