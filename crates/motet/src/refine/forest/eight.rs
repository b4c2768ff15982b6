//! The eight parts of a divided tet: one at each corner, and four around a diagonal of the octahedron
//! between, which can be chosen in three ways.
//!
//! Local vertices 0 to 3 are the corners, and 4 + e is the middle of edge e; so 13 - v lies across the
//! octahedron from v. The order of vertices shows how shapes are inherited: a corner part has that of the
//! whole, vertex by vertex. Among the inner parts, the [`IMAGES`] are, vertex by vertex, point reflections of
//! the parts before them in the centre of the octahedron, and so have the opposite orientation.

use std::sync::OnceLock;

use super::patterns::volume;
use crate::geometry::tet::EDGES;

/// Which of the eight are images of the parts before them.
pub(in crate::refine) const IMAGES: [usize; 2] = [5, 7];

/// Which of the eight have shapes of their own.
pub(in crate::refine) const INNER: [usize; 2] = [4, 6];

/// The local vertices at the ends of the diagonal of a way.
pub(in crate::refine) fn ends(way: usize) -> [usize; 2] {
    [4 + way, 9 - way]
}

/// The eight parts of a way, by local vertices. All but the images are positive if the whole is.
pub(in crate::refine) fn eight(way: usize) -> &'static [[u8; 4]; 8] {
    static TABLE: OnceLock<[[[u8; 4]; 8]; 3]> = OnceLock::new();
    &TABLE.get_or_init(|| [0, 1, 2].map(eight_of))[way]
}

fn eight_of(way: usize) -> [[u8; 4]; 8] {
    let middle = |i: usize, j: usize| EDGES.iter().position(|&[a, b]| [a, b] == [i.min(j), i.max(j)]);
    let corner = |i: usize| [0, 1, 2, 3].map(|j| middle(i, j).map_or(i, |edge| 4 + edge) as u8);
    let [p, q] = ends(way).map(|v| v as u8);
    // The other middles, in order around the diagonal.
    let [x, y] = [ends((way + 1) % 3)[0], ends((way + 2) % 3)[0]].map(|v| v as u8);
    let [p, q] = if volume([p, q, x, y]) > 0 { [p, q] } else { [q, p] };
    let (first, second) = ([p, q, x, y], [p, q, y, 13 - x]);
    let image = |tet: [u8; 4]| tet.map(|v| 13 - v);
    [corner(0), corner(1), corner(2), corner(3), first, image(first), second, image(second)]
}

#[cfg(test)]
mod tests {
    use super::super::patterns::{FULL, patterns};
    use super::*;

    #[test]
    fn the_eight_are_what_the_search_finds() {
        let sorted = |tets: &[[u8; 4]]| {
            let mut tets: Vec<[u8; 4]> = tets.to_vec();
            tets.iter_mut().for_each(|tet| tet.sort_unstable());
            tets.sort_unstable();
            tets
        };
        let mut found: Vec<_> = patterns(FULL, 0).iter().map(|tets| sorted(tets)).collect();
        let mut named = [0, 1, 2].map(|way| sorted(eight(way)));
        found.sort_unstable();
        named.sort_unstable();
        assert_eq!(found, named);
    }

    #[test]
    fn only_images_face_the_other_way() {
        for way in 0..3 {
            for (k, tet) in eight(way).iter().enumerate() {
                assert_eq!(volume(*tet), if IMAGES.contains(&k) { -8 } else { 8 });
            }
        }
    }
}
