//! Decides which tets are divided and which edges split beyond what was requested, so that all fit and none
//! is badly shaped.
//!
//! The result depends only on what was requested: each sweep examines all tets in the state left by the
//! previous sweep. So neither the order of visiting, nor the number of threads, nor earlier divisions matter,
//! and withdrawing a request restores the previous mesh.

use super::Forest;
use super::bounds::ShapeBounds;
use super::eight::INNER;
use super::fills::Finder;
use super::patterns::{FACET_EDGES, FULL, patterns};
use crate::base::{EdgeId, Error, MaybeId, NodeId, Result, Threads};

/// A tet cut to fit its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::refine) struct Cut {
    pub(in crate::refine) node: NodeId,
    pub(in crate::refine) goal: Goal,
}

/// What a tet with some edges split needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::refine) struct Goal {
    /// The edges to split: unchanged if the tet fits, more if it needs more splits, all if it must be
    /// divided.
    pub(in crate::refine) mask: u8,
    /// The cuts of its facets and, where it fits, the index of the pattern that fills it.
    pub(in crate::refine) cuts: u8,
    pub(in crate::refine) way: u8,
}

impl Cut {
    /// The pieces, by local vertices.
    pub(in crate::refine) fn pieces(&self) -> &'static [[u8; 4]] {
        &patterns(self.goal.mask, self.goal.cuts)[usize::from(self.goal.way)]
    }
}

impl Goal {
    const FULL: Self = Self { mask: FULL, cuts: 0, way: 0 };
}

/// The verdict of a sweep on a tet with split edges.
#[derive(Clone, Copy, Debug)]
struct Verdict {
    /// The root or group of eight that was examined.
    place: u32,
    node: NodeId,
    mask: u8,
    goal: Goal,
}

/// How many roots and groups of eight a thread examines at a time.
const RUN: usize = 1024;

/// The result of closing.
#[derive(Debug, Default)]
pub(in crate::refine) struct Closed {
    /// Tets that are cut, in ascending order.
    pub(in crate::refine) cuts: Vec<Cut>,
    /// Number of tets divided without being requested.
    pub(in crate::refine) n_promoted: usize,
    pub(in crate::refine) n_sweeps: usize,
}

/// Divides what is requested, and everything that this entails.
///
/// # Errors
/// When the forest would have more tets than allowed.
pub(in crate::refine) fn close(
    forest: &mut Forest,
    bounds: ShapeBounds,
    threads: &Threads,
) -> Result<Closed> {
    forest.reset();
    let requested: Vec<NodeId> =
        (0..forest.nodes.len()).filter(|&node| forest.states[node].is_requested).map(NodeId::new).collect();
    forest.divide_all(&requested, bounds, threads)?;
    let mut eights = forest.eights();
    let mut closed = Closed::default();
    let mut verdicts = Vec::new();
    loop {
        closed.n_sweeps += 1;
        verdicts = sweep(forest, &eights, &verdicts, bounds, threads);
        let mut is_done = true;
        let mut promoted = Vec::new();
        for &Verdict { node, mask, goal, .. } in &verdicts {
            if goal.mask == FULL {
                promoted.push(node);
            } else if goal.mask != mask {
                let edges = forest.edges_of[node.index()];
                for (_, edge) in edges.into_iter().enumerate().filter(|(e, _)| goal.mask >> e & 1 == 1) {
                    forest.middle(edge);
                    forest.is_split[edge.index()] = true;
                }
            }
            is_done &= goal.mask == mask && mask != FULL;
        }
        forest.finish_middles(threads);
        forest.divide_all(&promoted, bounds, threads)?;
        closed.n_promoted += promoted.len();
        eights.extend(promoted.iter().filter_map(|node| forest.nodes[node.index()].first_child.get()));
        if is_done {
            closed.cuts =
                verdicts.iter().map(|verdict| Cut { node: verdict.node, goal: verdict.goal }).collect();
            closed.cuts.sort_unstable_by_key(|cut| cut.node);
            for cut in &closed.cuts {
                forest.states[cut.node.index()].n_pieces = cut.pieces().len() as u8;
            }
            return Ok(closed);
        }
    }
}

/// Examines all tets that are not divided: roots, and parts of divided tets. `before` has the verdicts of the
/// previous sweep, which still hold for tets with the same edges split.
fn sweep(
    forest: &mut Forest,
    eights: &[NodeId],
    before: &[Verdict],
    bounds: ShapeBounds,
    threads: &Threads,
) -> Vec<Verdict> {
    let shared: &Forest = forest;
    let n_roots = shared.n_roots;
    let said = threads.in_runs(n_roots + eights.len(), RUN, |(): &mut (), run| {
        let mut finder = Finder::new(shared, bounds);
        let mut verdicts = Vec::new();
        let mut before = &before[before.partition_point(|verdict| (verdict.place as usize) < run.start)..];
        for place in run {
            let nodes = match place.checked_sub(n_roots) {
                None => place as u32..place as u32 + 1,
                Some(k) if shared.is_any_split_of(eights[k]) => eights[k].0..eights[k].0 + 8,
                Some(_) => continue,
            };
            let place = place as u32;
            for node in nodes.map(NodeId).filter(|node| !shared.states[node.index()].is_divided) {
                let mask = shared.mask(node);
                if mask == 0 {
                    continue;
                }
                let is_past = |verdict: &Verdict| (verdict.place, verdict.node) < (place, node);
                while let Some((_, rest)) = before.split_first().filter(|(first, _)| is_past(first)) {
                    before = rest;
                }
                let known = before.first().filter(|verdict| (verdict.node, verdict.mask) == (node, mask));
                let goal = match known {
                    _ if shared.must_be_divided(node, mask) => Goal::FULL,
                    Some(verdict) => verdict.goal,
                    None => goal(&mut finder, node, mask),
                };
                verdicts.push(Verdict { place, node, mask, goal });
            }
        }
        vec![(verdicts, finder.into_found())]
    });
    let mut verdicts = Vec::new();
    for (some, found) in said {
        verdicts.extend(some);
        forest.fills.extend(found);
    }
    verdicts
}

/// Finds what a tet needs to be cut well, from the reference alone. Pieces are compared with what dividing
/// would leave: compared with the whole, a tet with bad inner parts could never be cut well enough, and in a
/// mesh of such tets division would spread without end.
fn goal(finder: &mut Finder, leaf: NodeId, mask: u8) -> Goal {
    let Finder { forest, bounds, .. } = *finder;
    let class = forest.nodes[leaf.index()].shape.class();
    let (cuts, fill) = finder.cut(leaf, mask);
    let as_it_is = Goal { mask, cuts, way: fill.way };
    // What is good enough compared with the whole is also good enough compared with its parts.
    let whole = &forest.classes[class.index()];
    if fill.worst >= bounds.of(whole.root_eas, whole.eas) {
        return as_it_is;
    }
    let divided = finder.divided(class);
    let least = bounds.of(whole.root_eas, divided);
    if fill.worst >= least {
        return as_it_is;
    }
    // Prefer the fewest additional edges, then the best shape.
    for n in mask.count_ones() + 1..6 {
        let larger = (mask + 1..FULL).filter(|m| m & mask == mask && m.count_ones() == n);
        let worst = |m: u8| (m, finder.cut(leaf, m).1.worst);
        let best = larger.map(worst).reduce(|x, y| if y.1 > x.1 { y } else { x });
        if let Some((mask, _)) = best.filter(|(_, worst)| *worst >= least) {
            return Goal { mask, cuts: 0, way: 0 };
        }
    }
    Goal { mask: if divided > fill.worst { FULL } else { mask }, ..as_it_is }
}

impl Forest {
    /// Divides tets, and splits their edges.
    ///
    /// # Errors
    /// When the forest would have more tets than allowed.
    fn divide_all(&mut self, tets: &[NodeId], bounds: ShapeBounds, threads: &Threads) -> Result<()> {
        let is_new = |node: &NodeId| self.nodes[node.index()].first_child.is_none();
        let new: Vec<NodeId> = tets.iter().copied().filter(is_new).collect();
        let Some((last, _)) = tets.split_last() else { return Ok(()) };
        self.check_limit(8 * (new.len() - usize::from(is_new(last))))?;
        for node in tets.iter().map(|node| node.index()) {
            self.states[node].is_divided = true;
            for edge in self.edges_of[node] {
                self.is_split[edge.index()] = true;
            }
        }
        let ways = self.decide(&new, bounds, threads);
        self.divide(&ways, threads);
        Ok(())
    }

    /// Rejects growth beyond the limit once there are `n` more tets.
    fn check_limit(&self, n: usize) -> Result<()> {
        if self.nodes.len() + n < self.max_nodes {
            return Ok(());
        }
        Err(Error::options(format!("more than {} tets would be divided or created", self.max_nodes))
            .remedy("mark fewer tets, or limit the generation"))
    }

    /// Resets the state: nothing is divided, and no edge is split except the pinned ones.
    fn reset(&mut self) {
        self.is_split.fill(false);
        for &edge in &self.pinned {
            self.is_split[edge.index()] = true;
        }
        let mut n_new = 0;
        for (state, node) in self.states.iter_mut().zip(&*self.nodes) {
            (state.is_divided, state.n_pieces) = (false, 0);
            n_new += usize::from(state.is_requested && node.first_child.is_none());
        }
        self.nodes.reserve(n_new);
        self.states.reserve(n_new);
        self.edges_of.reserve(n_new);
    }

    /// For each divided tet the first of its eight parts, unless all of these are divided.
    fn eights(&self) -> Vec<NodeId> {
        // The roots are followed by groups of eight with a common parent.
        let eights = (self.first_part()..self.nodes.len()).step_by(8).zip(&self.parents);
        let is_there = |(first, parent): &(usize, &NodeId)| {
            self.states[parent.index()].is_divided
                && !self.states[*first..*first + 8].iter().all(|state| state.is_divided)
        };
        eights.filter(is_there).map(|(first, _)| NodeId::new(first)).collect()
    }

    /// Whether an edge of a group of eight is split. The corner parts have all edges but the diagonal, which
    /// is the first edge of the first inner part.
    #[inline]
    fn is_any_split_of(&self, eight: NodeId) -> bool {
        let first = eight.index();
        let mut is_any = self.is_split[self.edges_of[first + INNER[0]][0].index()];
        for edges in &self.edges_of[first..first + 4] {
            for &edge in edges {
                is_any |= self.is_split[edge.index()];
            }
        }
        is_any
    }

    /// Whether a tet must be divided: all its edges are split, or one is split that exists only when it is
    /// divided, namely half of a split edge, or an edge between the middles of two edges of a facet.
    fn must_be_divided(&self, leaf: NodeId, mask: u8) -> bool {
        if mask == FULL {
            return true;
        }
        let edges = &self.edges_of[leaf.index()];
        let is_split = |edge: MaybeId<EdgeId>| edge.get().is_some_and(|edge| self.is_split[edge.index()]);
        let half_is_split = |edge: EdgeId| {
            self.halves(edge).is_some_and(|halves| halves.map(MaybeId::from).into_iter().any(is_split))
        };
        if (0..6).any(|e| mask >> e & 1 == 1 && half_is_split(edges[e])) {
            return true;
        }
        // Only a divided tet has edges within a facet, which requires all three edges around to be split,
        // unless the inner edges are edges of roots.
        let least = if self.pinned.is_empty() { 3 } else { 2 };
        for &[a, b, c] in &FACET_EDGES {
            if (mask >> a & 1) + (mask >> b & 1) + (mask >> c & 1) < least {
                continue;
            }
            let middle = |e: usize| self.edges[edges[e].index()].middle.get();
            if let [Some(a), Some(b), Some(c)] = [middle(a), middle(b), middle(c)]
                && let Some([x, y, z]) = self.inner_edges([a, b, c])
                && (is_split(x) || is_split(y) || is_split(z))
            {
                return true;
            }
        }
        false
    }
}
