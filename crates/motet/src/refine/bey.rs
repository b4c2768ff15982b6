//! Bey's rule: which diagonal, by the order of a tet's vertices alone.
//!
//! The eight are given orders of their own, so that however deep, no more than three shapes come of one (Bey 1995, *Tetrahedral grid refinement*). An order follows from the way down from
//! the root, so it is worked out again where it is needed.

use super::forest::{Forest, NONE};
use super::patterns::{FULL, ends, patterns};
use crate::geometry::tet::EDGES;

/// The vertices of the eight: `[i, i]` is vertex `i` of the whole, `[i, j]` the middle between two.
const CHILDREN: [[[usize; 2]; 4]; 8] = [
    [[0, 0], [0, 1], [0, 2], [0, 3]],
    [[0, 1], [1, 1], [1, 2], [1, 3]],
    [[0, 2], [1, 2], [2, 2], [2, 3]],
    [[0, 3], [1, 3], [2, 3], [3, 3]],
    [[0, 1], [0, 2], [0, 3], [1, 3]],
    [[0, 1], [0, 2], [1, 2], [1, 3]],
    [[0, 2], [0, 3], [1, 3], [2, 3]],
    [[0, 2], [1, 2], [1, 3], [2, 3]],
];

/// Which of the three ways to divide a tet.
pub(super) fn way(forest: &Forest, node: u32) -> usize {
    along(order(forest, node))
}

/// The way along the diagonal between the middles of the edges 0-2 and 1-3.
fn along(order: [usize; 4]) -> usize {
    let diagonal = [local(order, [0, 2]), local(order, [1, 3])];
    (0..3).find(|&way| ends(way) == diagonal || ends(way) == [diagonal[1], diagonal[0]]).unwrap_or(0)
}

/// Of a tet's vertices, which is Bey's first, second, third and fourth.
fn order(forest: &Forest, node: u32) -> [usize; 4] {
    let parent = forest.nodes[node as usize].parent;
    if parent == NONE {
        return [0, 1, 2, 3];
    }
    let above = order(forest, parent);
    let place = (node - forest.nodes[parent as usize].first_child) as usize;
    let tet = patterns(FULL, 0)[along(above)][place].map(usize::from);
    let names = |child: &[[usize; 2]; 4]| child.map(|name| local(above, name));
    let child = CHILDREN.iter().map(names).find(|child| child.iter().all(|v| tet.contains(v)));
    child.unwrap_or(tet).map(|v| tet.iter().position(|other| *other == v).unwrap_or(0))
}

/// The local vertex of a name.
fn local(order: [usize; 4], [i, j]: [usize; 2]) -> usize {
    let (i, j) = (order[i], order[j]);
    match EDGES.iter().position(|&[a, b]| [a, b] == [i, j] || [a, b] == [j, i]) {
        Some(edge) => 4 + edge,
        None => i,
    }
}
