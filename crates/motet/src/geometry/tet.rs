//! The tetrahedron: its local numbering, volume, centre, barycentric coordinates.
//!
//! ```text
//!        d          (a, b, c, d) is positive when (b - a) x (c - a) . (d - a) > 0:
//!       /|\         seen from d, a b c runs counter-clockwise.
//!      / | \        Facet i lies opposite vertex i.
//!     a--|--c
//!      \ | /
//!       \|/
//!        b
//! ```

use crate::base::Point;
use crate::geometry::vector::{add, cross, dot, scale, sub};

/// Vertices of facet `i`, the one opposite vertex `i`, counter-clockwise seen
/// from outside a positive tet.
pub const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The two vertices of each edge; edges `e` and `5 - e` are opposite.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Six times the signed volume: the triple product.
#[inline]
pub fn volume_6([a, b, c, d]: [Point; 4]) -> f64 {
    dot(cross(sub(b, a), sub(c, a)), sub(d, a))
}

/// The signed volume.
#[inline]
pub fn volume(tet: [Point; 4]) -> f64 {
    volume_6(tet) / 6.0
}

/// The centre of gravity.
pub fn centroid([a, b, c, d]: [Point; 4]) -> Point {
    scale(add(add(a, b), add(c, d)), 0.25)
}

/// Weights of the vertices that give `p`; they sum to 1 up to rounding. Not
/// finite where the volume is zero.
pub fn barycentric(tet: [Point; 4], p: Point) -> [f64; 4] {
    let total = volume_6(tet);
    [0, 1, 2, 3].map(|i| {
        let mut part = tet;
        part[i] = p;
        volume_6(part) / total
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [Point; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn facet_i_lies_opposite_vertex_i_and_faces_away_from_it() {
        for (i, facet) in FACETS.iter().enumerate() {
            assert!(!facet.contains(&i));
            let [a, b, c] = facet.map(|v| UNIT[v]);
            assert!(dot(cross(sub(b, a), sub(c, a)), sub(UNIT[i], a)) < 0.0);
        }
    }

    #[test]
    fn opposite_edges_share_no_vertex() {
        for (e, [i, j]) in EDGES.iter().enumerate() {
            assert!(!EDGES[5 - e].contains(i) && !EDGES[5 - e].contains(j));
        }
    }

    #[test]
    fn weights_give_the_point_back() {
        let p = [0.2, -0.7, 0.4];
        let w = barycentric(UNIT, p);
        let back = (0..4).fold([0.0; 3], |sum, i| add(sum, scale(UNIT[i], w[i])));
        assert!((0..3).all(|k| (back[k] - p[k]).abs() < 1e-15));
        assert_eq!(volume(UNIT), 1.0 / 6.0);
    }
}
