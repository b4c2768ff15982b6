//! Inserts a point among tets that need not be Delaunay. The tets removed are those that contain the point,
//! and those wholly visible from it whose sphere contains it, provided nothing of the surface is lost.

use super::sites::Sites;
use crate::base::{TetId, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::kernel::{HalfFacet, Tets};

/// The edges and facets that must not be lost.
pub(super) trait Protected {
    fn has_edge(&self, edge: [VertexId; 2]) -> bool;
    fn has_facet(&self, face: [VertexId; 3]) -> bool;
}

/// Buffers reused from one insertion to the next.
#[derive(Default)]
pub(super) struct Split {
    cavity: Vec<TetId>,
    shell: Vec<(HalfFacet, [VertexId; 3])>,
    seams: Vec<([VertexId; 2], HalfFacet)>,
}

impl Split {
    /// Inserts `vertex`, which lies in or near `among`, and also removes the tets of `wanted` if possible.
    /// Returns whether it succeeded.
    pub(super) fn insert(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        vertex: VertexId,
        (among, wanted): (&[TetId], &[TetId]),
        kept: &impl Protected,
    ) -> bool {
        let holds = |&tet: &TetId| holds(tets, sites, tet, vertex);
        let mut core: Vec<TetId> = among.iter().copied().filter(holds).collect();
        if core.is_empty() {
            let all: Vec<TetId> = tets.iter().map(|(tet, _)| tet).collect();
            core = all.into_iter().filter(holds).collect();
        }
        reach_all(tets, sites, vertex, &mut core);
        let mut with: Vec<TetId> = core.iter().chain(wanted).copied().collect();
        with.sort_unstable();
        with.dedup();
        for (start, grows) in [(&with, true), (&with, false), (&core, true), (&core, false)] {
            if self.dig(tets, sites, vertex, start, grows, kept) {
                self.cavity.iter().for_each(|&tet| tets.remove(tet));
                tets.cone(vertex, self.shell.iter().copied(), &mut self.seams);
                return true;
            }
        }
        false
    }

    /// Finds the tets to remove. Returns whether the vertex sees all facets around them, and nothing is lost.
    fn dig(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        vertex: VertexId,
        start: &[TetId],
        grows: bool,
        kept: &impl Protected,
    ) -> bool {
        tets.begin();
        self.cavity.clear();
        self.shell.clear();
        self.cavity.extend(start);
        start.iter().for_each(|&tet| _ = tets.mark(tet));
        let sees = |[a, b, c]: [VertexId; 3]| sites.orient3d([a, b, c, vertex]) > 0;
        let mut next = 0;
        while let Some(&tet) = self.cavity.get(next).filter(|_| grows) {
            next += 1;
            for other in Tets::facets(tet).map(|half| tets.across(half)) {
                let is_in = other.is_none() || tets.is_marked(other.tet());
                if is_in
                    || kept.has_facet(tets.inward(other))
                    || !sites.is_inside(tets.vertices(other.tet()), vertex)
                {
                    continue;
                }
                let is_free = |half: &HalfFacet| {
                    let behind = tets.across(*half);
                    behind.is_none() || !tets.is_marked(behind.tet())
                };
                if Tets::facets(other.tet())
                    .iter()
                    .filter(|half| is_free(half))
                    .all(|&half| sees(tets.inward(half)))
                {
                    tets.mark(other.tet());
                    self.cavity.push(other.tet());
                }
            }
        }
        for half in self.cavity.iter().flat_map(|&tet| Tets::facets(tet)) {
            let other = tets.across(half);
            if other.is_none() || !tets.is_marked(other.tet()) {
                if !sees(tets.inward(half)) {
                    return false;
                }
                self.shell.push((other, tets.inward(half)));
            } else if kept.has_facet(tets.inward(half)) {
                return false;
            }
        }
        !self.shell.is_empty() && self.loses_nothing(tets, kept)
    }

    fn loses_nothing(&self, tets: &Tets, kept: &impl Protected) -> bool {
        let mut around: Vec<[VertexId; 2]> =
            self.shell.iter().flat_map(|&(_, [a, b, c])| [[a, b], [b, c], [c, a]].map(sorted_ids)).collect();
        around.sort_unstable();
        around.dedup();
        let mut corners: Vec<VertexId> = around.as_flattened().to_vec();
        corners.sort_unstable();
        corners.dedup();
        self.cavity.iter().map(|&tet| tets.vertices(tet)).all(|v| {
            v.iter().all(|v| corners.binary_search(v).is_ok())
                && EDGES.iter().all(|&[i, j]| {
                    let edge = sorted_ids([v[i], v[j]]);
                    around.binary_search(&edge).is_ok() || !kept.has_edge(edge)
                })
        })
    }
}

/// The facets around a set of tets, seen from inside.
pub(super) fn faces_around(tets: &mut Tets, within: &[TetId]) -> Vec<[VertexId; 3]> {
    tets.begin();
    within.iter().for_each(|&tet| _ = tets.mark(tet));
    let is_outer = |half: &HalfFacet| {
        let other = tets.across(*half);
        other.is_none() || !tets.is_marked(other.tet())
    };
    let all = within.iter().flat_map(|&tet| Tets::facets(tet)).filter(is_outer);
    all.map(|half| tets.inward(half)).collect()
}

/// The part of (0, 1) in which all of the linear functions are positive, given by their values at 0 and 1.
pub(super) fn positive_part(functions: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    let [mut low, mut high] = [0.0f64, 1.0f64];
    for [at_0, at_1] in functions {
        let root = at_0 / (at_0 - at_1);
        if at_1 > at_0 && root.is_finite() {
            low = low.max(root);
        } else if at_1 < at_0 && root.is_finite() {
            high = high.min(root);
        }
    }
    (low < high).then_some([low, high])
}

/// A number near the middle of two, with few digits, so that values computed from it have few as well.
pub(super) fn round_between([low, high]: [f64; 2]) -> f64 {
    let step = 2f64.powi((0.25 * (high - low)).log2().floor() as i32);
    let middle = low + 0.5 * (high - low);
    let round = (middle / step).round() * step;
    if low < round && round < high { round } else { middle }
}

/// Adds the tets across facets on which the vertex lies.
fn reach_all(tets: &Tets, sites: &Sites, vertex: VertexId, core: &mut Vec<TetId>) {
    let mut next = 0;
    while let Some(&tet) = core.get(next) {
        next += 1;
        for half in Tets::facets(tet) {
            let ([a, b, c], other) = (tets.inward(half), tets.across(half));
            let is_new = !other.is_none() && !core.contains(&other.tet());
            if is_new && sites.orient3d([a, b, c, vertex]) == 0 {
                core.push(other.tet());
            }
        }
    }
}

/// Whether a vertex lies in a tet or on its boundary.
fn holds(tets: &Tets, sites: &Sites, tet: TetId, vertex: VertexId) -> bool {
    Tets::facets(tet).into_iter().all(|half| {
        let [a, b, c] = tets.inward(half);
        sites.orient3d([a, b, c, vertex]) >= 0
    })
}
