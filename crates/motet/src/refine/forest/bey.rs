//! Bey's rule: the diagonal follows from the order of a tet's vertices alone.
//!
//! The inner parts are given vertex orders of their own, so that at any depth at most three shapes arise from
//! one tet (Bey 1995, *Tetrahedral grid refinement*). The order follows from the path from the root, so it is
//! recomputed where a class needs it.

use super::Forest;
use super::classes::{ClassId, inner_part};
use super::eight::ends;
use crate::geometry::tet::EDGES;

/// The vertices of the four inner parts: `[i, j]` is the middle between vertices `i` and `j` of the whole.
const CHILDREN: [[[usize; 2]; 4]; 4] = [
    [[0, 1], [0, 2], [0, 3], [1, 3]],
    [[0, 1], [0, 2], [1, 2], [1, 3]],
    [[0, 2], [0, 3], [1, 3], [2, 3]],
    [[0, 2], [1, 2], [1, 3], [2, 3]],
];

/// Returns which of the three ways divides tets of a class. Corner parts have the order of the whole. An
/// image has the reversed order of its original, which gives the same way.
pub(super) fn way(forest: &Forest, class: ClassId) -> usize {
    let steps = forest.steps_to_class(class);
    way_along(
        steps.into_iter().fold([0, 1, 2, 3], |order, (way, inner)| below(order, inner_part(way, inner))),
    )
}

/// The way along the diagonal between the middles of edges 0-2 and 1-3.
fn way_along(order: [usize; 4]) -> usize {
    let diagonal = [local(order, [0, 2]), local(order, [1, 3])];
    (0..3).find(|&way| ends(way) == diagonal || ends(way) == [diagonal[1], diagonal[0]]).unwrap_or(0)
}

/// Returns which vertices of an inner part are Bey's first to fourth, given this order for the whole.
fn below(order: [usize; 4], part: &[u8; 4]) -> [usize; 4] {
    let part = part.map(usize::from);
    let names = |child: &[[usize; 2]; 4]| child.map(|name| local(order, name));
    let child = CHILDREN.iter().map(names).find(|child| child.iter().all(|v| part.contains(v)));
    child.unwrap_or(part).map(|v| part.iter().position(|other| *other == v).unwrap_or(0))
}

/// The local vertex of a pair `[i, j]`: a middle, or a corner if `i` equals `j`.
fn local(order: [usize; 4], [i, j]: [usize; 2]) -> usize {
    let (i, j) = (order[i], order[j]);
    match EDGES.iter().position(|&[a, b]| [a, b] == [i, j] || [a, b] == [j, i]) {
        Some(edge) => 4 + edge,
        None => i,
    }
}
