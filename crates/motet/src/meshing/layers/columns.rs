//! Columns on the vertices of walls, and the prisms between them.
//!
//! ```text
//!   a2----c2
//!   | \  / |
//!   |  b2  |
//!   a1-|--c1
//!   | \b1/ |
//!   a--|--c   wall
//!    \ b /
//! ```
//!
//! A column has a place for each level, the wall's own vertex the lowest. Where one has fewer levels than
//! those beside it, or none, its last place stands for all levels above: the prisms there are pyramids (one
//! corner that does not rise), tets (two), or nothing (three).

use super::neighbors::NONE;
use super::skin::Skin;
use super::thickness::Heights;
use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, scale};
use crate::mesh::CellKind;

/// A place in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Site {
    /// The vertex of the skin at the foot of the column.
    pub(super) foot: VertexId,
    pub(super) level: u32,
}

/// Columns of given heights.
pub(super) struct Columns<'a> {
    skin: &'a Skin,
    heights: &'a Heights,
    /// The heights of the levels of each stack.
    levels: Vec<Vec<f64>>,
}

impl<'a> Columns<'a> {
    pub(super) fn new(skin: &'a Skin, heights: &'a Heights) -> Self {
        Self { skin, heights, levels: skin.stacks.iter().map(super::Stack::levels).collect() }
    }

    /// The number of levels of a column above its foot.
    pub(super) fn count(&self, vertex: VertexId) -> u32 {
        self.heights.count(self.skin, vertex) as u32
    }

    /// The position of a site.
    pub(super) fn at(&self, Site { foot, level }: Site) -> Point {
        let w = foot.index();
        let foot = self.skin.points[w];
        let stack = self.heights.stack_of[w];
        if level == 0 || stack == NONE {
            return foot;
        }
        let levels = &self.levels[stack as usize];
        let share = self.heights.heights[w] / levels[levels.len() - 1];
        add(foot, scale(self.heights.lifts[w], levels[level as usize] * share))
    }

    /// The topmost site of a column.
    pub(super) fn top(&self, vertex: VertexId) -> Site {
        Site { foot: vertex, level: self.count(vertex) }
    }

    /// The prisms on a triangle of the skin, from the wall inward.
    pub(super) fn prisms(&self, triangle: u32) -> impl Iterator<Item = Prism> + '_ {
        let corners = self.skin.triangles[triangle as usize];
        let counts = corners.map(|v| if self.skin.has_stack(triangle) { self.count(v) } else { 0 });
        let at_level =
            move |level: u32| [0, 1, 2].map(|k| Site { foot: corners[k], level: level.min(counts[k]) });
        let most = counts.into_iter().max().unwrap_or(0);
        (0..most).map(move |level| Prism { bottom: at_level(level), top: at_level(level + 1) })
    }

    /// The sides of the prisms at edge `k` of a triangle of the skin, oriented as the surface beyond the
    /// edge: out of the body.
    pub(super) fn sides(&self, triangle: u32, k: usize) -> impl Iterator<Item = [Site; 4]> + '_ {
        let prisms = self.prisms(triangle);
        let next = (k + 1) % 3;
        prisms.map(move |p| [p.bottom[next], p.bottom[k], p.top[k], p.top[next]])
    }
}

/// The cell between two levels of three columns. Corners run counter-clockwise seen from outside the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Prism {
    pub(super) bottom: [Site; 3],
    pub(super) top: [Site; 3],
}

impl Prism {
    /// All tets on four of its corners that can be part of it, however its sides are divided, in positive
    /// orientation.
    pub(super) fn tets(&self) -> impl Iterator<Item = [Site; 4]> {
        let ([a, b, c], [d, e, f]) = (self.bottom, self.top);
        let round = [([a, b, c], [d, e, f]), ([b, c, a], [e, f, d]), ([c, a, b], [f, d, e])];
        let all = round.map(|([i, j, k], [over_i, over_j, over_k])| {
            [[i, k, j, over_i], [over_i, over_j, over_k, i], [i, j, over_i, over_k], [i, j, over_j, over_k]]
        });
        all.into_iter().flatten().filter(|tet| (1..4).all(|i| !tet[..i].contains(&tet[i])))
    }

    /// The mesh cell that it is, with its vertices in VTK's order; `None` if top and bottom coincide.
    pub(super) fn cell(&self) -> Option<(CellKind, Vec<Site>)> {
        let ([a, b, c], [d, e, f]) = (self.bottom, self.top);
        Some(match [a == d, b == e, c == f] {
            [false, false, false] => (CellKind::WEDGE, vec![a, c, b, d, f, e]),
            [true, false, false] => (CellKind::PYRAMID, vec![c, f, e, b, a]),
            [false, true, false] => (CellKind::PYRAMID, vec![a, d, f, c, b]),
            [false, false, true] => (CellKind::PYRAMID, vec![b, e, d, a, c]),
            [false, true, true] => (CellKind::TETRA, vec![a, c, b, d]),
            [true, false, true] => (CellKind::TETRA, vec![a, c, b, e]),
            [true, true, false] => (CellKind::TETRA, vec![a, c, b, f]),
            [true, true, true] => return None,
        })
    }
}

/// A ring of sites without duplicates: four, three or fewer.
pub(super) fn distinct(ring: [Site; 4]) -> Vec<Site> {
    let mut found: Vec<Site> = Vec::with_capacity(4);
    ring.into_iter().for_each(|site| {
        if !found.contains(&site) {
            found.push(site)
        }
    });
    found
}
