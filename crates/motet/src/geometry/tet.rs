//! The tetrahedron: local numbering, volume, centroid, barycentric coordinates.
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
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::{add, cross, dot, scale, sub};
use crate::geometry::{triangle, weights};

/// Vertices of facet `i`, the one opposite vertex `i`, counter-clockwise seen from outside a positive tet.
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

/// The centroid.
pub fn centroid([a, b, c, d]: [Point; 4]) -> Point {
    scale(add(add(a, b), add(c, d)), 0.25)
}

/// Barycentric coordinates of `p`; they sum to 1 up to rounding. Not finite where the volume is zero.
pub fn barycentric(tet: [Point; 4], p: Point) -> [f64; 4] {
    let total = volume_6(tet);
    [0, 1, 2, 3].map(|i| {
        let mut part = tet;
        part[i] = p;
        volume_6(part) / total
    })
}

/// Whether `p` lies in the tet or on its surface, for either orientation. The answer is exact; false where
/// the volume is zero.
pub fn holds(tet: [Point; 4], p: Point) -> bool {
    let side = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d);
    let orientation = side(tet);
    orientation != 0
        && (0..4).all(|i| {
            let mut part = tet;
            part[i] = p;
            side(part) * orientation >= 0
        })
}

/// Weights of the vertices, each in [0, 1] with sum 1, that give the point of the tet closest to `p`: `p`
/// itself where the tet [`holds`] it, else the nearest of the closest points of the four facets. Works for
/// either orientation; a tet without volume is treated as its facets.
pub fn closest(tet: [Point; 4], p: Point) -> [f64; 4] {
    if holds(tet, p) {
        let [a, b, c, d] = tet;
        if let Some(found) = weights(tet, p) {
            return found;
        }
        if let Some([wb, wa, wc, wd]) = weights([b, a, c, d], p) {
            return [wa, wb, wc, wd];
        }
    }
    let mut best = (f64::INFINITY, [1.0, 0.0, 0.0, 0.0]);
    for facet in FACETS {
        let corners = facet.map(|i| tet[i]);
        let on_facet = triangle::closest(corners, p);
        let offset = sub(triangle::at(corners, on_facet), p);
        let distance_squared = dot(offset, offset);
        if distance_squared < best.0 {
            let mut found = [0.0; 4];
            facet.iter().zip(on_facet).for_each(|(&i, w)| found[i] = w);
            best = (distance_squared, found);
        }
    }
    best.1
}

/// The point with these weights of the vertices.
#[inline]
pub fn at([a, b, c, d]: [Point; 4], weights: [f64; 4]) -> Point {
    add(add(scale(a, weights[0]), scale(b, weights[1])), add(scale(c, weights[2]), scale(d, weights[3])))
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
    fn the_closest_point_of_a_tet_is_the_point_itself_or_lies_on_a_facet() {
        let inverted = [UNIT[1], UNIT[0], UNIT[2], UNIT[3]];
        let flat = [UNIT[0], UNIT[1], UNIT[2], [0.5, 0.5, 0.0]];
        for tet in [UNIT, inverted] {
            assert_eq!(at(tet, closest(tet, [0.25, 0.25, 0.125])), [0.25, 0.25, 0.125]);
            assert_eq!(at(tet, closest(tet, [0.25, 0.25, -1.0])), [0.25, 0.25, 0.0]);
            assert_eq!(at(tet, closest(tet, [-1.0, -1.0, 0.5])), [0.0, 0.0, 0.5]);
            assert!(holds(tet, [0.5, 0.5, 0.0]) && !holds(tet, [0.5, 0.5, -1e-300]));
        }
        assert_eq!(at(flat, closest(flat, [0.25, 0.25, 3.0])), [0.25, 0.25, 0.0]);
        assert!(!holds(flat, [0.25, 0.25, 0.0]));
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
