//! Which tets before and after a step lie in which.

use super::super::choose::estimate;
use super::super::forest::{Extracted, Forest};
use crate::base::{MaybeId, NodeId, Point, TetId, Threads};
use crate::geometry::overlap::Solid;
use crate::geometry::tet::centroid;
use crate::geometry::vector::distance;

/// How many tets a thread examines at a time.
const RUN: usize = 4096;

/// The tets before and after a step, by the tets of the forest that they are or are pieces of.
pub(super) struct Ancestry<'a> {
    forest: &'a Forest,
    was: &'a Extracted,
    is: &'a Extracted,
    /// For each tet of the forest, the range of its pieces in the mesh before: the first, and one past the
    /// last.
    old: Vec<[u32; 2]>,
    /// Whether these ranges contain no other tets.
    pub(super) is_grouped: bool,
    /// The old tets that lie in a coarser tet of the new mesh, with the tet of the forest that this is, by
    /// rising ids.
    within: Vec<(NodeId, TetId)>,
}

/// The old tets that have something in common with a new tet.
enum Relatives<'a> {
    /// It lies in one tet of the forest, of which these are the pieces, a range.
    Around([u32; 2]),
    /// They lie in the tet of the forest that it is a piece of.
    Within(&'a [(NodeId, TetId)]),
}

impl Relatives<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Around([first, end]) => (end - first) as usize,
            Self::Within(old) => old.len(),
        }
    }

    fn get(&self, i: usize) -> TetId {
        match self {
            Self::Around([first, _]) => TetId(first + i as u32),
            Self::Within(old) => old[i].1,
        }
    }

    fn iter(&self) -> impl Iterator<Item = TetId> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }
}

impl<'a> Ancestry<'a> {
    pub(super) fn new(forest: &'a Forest, [was, is]: [&'a Extracted; 2], threads: &Threads) -> Self {
        let n_nodes = was.nodes.iter().map(|node| node.index() + 1).max().unwrap_or(0);
        let (mut old, mut is_grouped) = (vec![[0, 0]; n_nodes], true);
        for (node, t) in was.nodes.iter().zip(0..) {
            let [first, end] = &mut old[node.index()];
            is_grouped &= *end == 0 || *end == t;
            *first = if *end == 0 { t } else { *first };
            *end = t + 1;
        }
        let is_divided = |node: NodeId| forest.states[node.index()].is_divided;
        let mut within = threads.in_runs(was.nodes.len(), RUN, |(): &mut (), run| {
            let coarser = |t: usize| {
                // Most tets lie in divided ones only.
                forest.parent(was.nodes[t]).filter(|&parent| !is_divided(parent))?;
                let around = forest.ancestors(was.nodes[t]).skip(1).filter(|&node| !is_divided(node));
                around.last().map(|node| (node, TetId::new(t)))
            };
            run.filter_map(coarser).collect()
        });
        within.sort_unstable();
        Self { forest, was, is, old, is_grouped, within }
    }

    fn relatives(&self, t: TetId) -> Relatives<'_> {
        let node = self.is.nodes[t.index()];
        let pieces = |node: NodeId| self.old.get(node.index()).copied().filter(|old| old[1] > 0);
        match self.forest.ancestors(node).find_map(pieces) {
            Some(old) => Relatives::Around(old),
            None => {
                let first = self.within.partition_point(|(other, _)| *other < node);
                let n = self.within[first..].partition_point(|(other, _)| *other == node);
                Relatives::Within(&self.within[first..first + n])
            }
        }
    }

    /// The old tet that has the same vertices in the same order; `None` if there is none.
    pub(super) fn same(&self, t: TetId) -> MaybeId<TetId> {
        let name = |out: &Extracted, t: TetId| out.mesh.tets[t.index()].map(|v| out.vertices[v.index()]);
        let is = name(self.is, t);
        self.relatives(t).iter().find(|&old| name(self.was, old) == is).into()
    }

    /// Replaces `parts` by the old tets that make up a new tet, with their volumes, which need not sum to
    /// that of the tet.
    pub(super) fn parts(&self, t: TetId, parts: &mut Vec<(TetId, f64)>) {
        parts.clear();
        let relatives = self.relatives(t);
        if let Relatives::Around([first, end]) = relatives
            && end == first + 1
        {
            parts.push((TetId(first), 1.0));
            return;
        }
        let solid = Solid::new(corners(self.is, t));
        parts.extend(relatives.iter().filter_map(|old| {
            let other = Solid::new(corners(self.was, old));
            solid.real_overlap(&other).map(|volume| (old, volume))
        }));
        if !parts.is_empty() {
            return;
        }
        // Points that moved may leave no overlap: then take the nearest candidate.
        let centre = centroid(corners(self.is, t));
        let far = |old: &TetId| distance(centroid(corners(self.was, *old)), centre);
        let nearest = relatives.iter().min_by(|x, y| far(x).total_cmp(&far(y)));
        parts.push((nearest.unwrap_or_default(), 1.0));
    }
}

pub(super) fn corners(out: &Extracted, t: TetId) -> [Point; 4] {
    estimate::corners(&out.mesh, out.mesh.tets[t.index()])
}
