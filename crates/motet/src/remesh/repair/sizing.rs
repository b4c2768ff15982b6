//! Edges brought to the requested sizes: long ones split, short ones collapsed, bad tets repaired, until
//! nothing changes.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use crate::base::{Point, Result, TetId, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};
use crate::kernel::{Complex, Hold, Shell};
use crate::ops::{collapse, split_edge};
use crate::remesh::lengths::locked_edges;
use crate::remesh::repair::ahead::Pass;
use crate::remesh::repair::search::{Search, Tools, has_edge};
use crate::remesh::repair::stages::{FIRST_STAGES, STAGES};
use crate::remesh::repair::trial::{Found, Merit, Rules};
use crate::remesh::repair::tried::Tried;
use crate::remesh::repair::{RAISES, Repair};
use crate::remesh::report::Operation;
use crate::remesh::sizes::{LONG, SHORT, SizeField, SizesIn};

/// Short edges are searched for once more if this fraction of them has been collapsed.
const ENOUGH: f64 = 0.02;

/// Where the mesh is being changed, edges shorter than this fraction of their size are collapsed: if only
/// those below [`SHORT`] were, a mesh that was finer would keep twice the tets that its sizes imply. Tets
/// that nothing has changed stay if their edges are neither too long nor too short, so a mesh that already
/// has its sizes stays as it is.
const DENSE: f64 = 0.7;

/// Edges whose ratios of length to size differ by no more than this factor count as equally long.
const ALIKE: f64 = 1.0 + 1e-9;
/// Tets below this quality are nearly flat: a tenth of the default limit for bad tets. Next to a longer edge
/// that stays, no split may make one, whatever was there.
const FLATTEST: f64 = 0.02;

/// The number of tets that a thread sweeps at a time.
const SWEEP: usize = 1 << 14;

/// The requested sizes, and the limits of the work.
#[derive(Debug)]
pub(in crate::remesh) struct Sizing {
    pub(in crate::remesh) field: SizeField,
    /// Whether long edges are split; if not, only short ones are collapsed, once.
    pub(in crate::remesh) splits: bool,
    /// No edge is split once the mesh has more than this many tets.
    pub(in crate::remesh) max_tets: usize,
}

/// An edge, its length divided by its size, and a tet that has it or had it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    ratio: f64,
    ends: [VertexId; 2],
    tet: TetId,
}

impl Eq for Edge {}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Edge {
    /// The longest edge is the greatest; among equally long ones, the one with the lowest vertices.
    fn cmp(&self, other: &Self) -> Ordering {
        self.ratio.total_cmp(&other.ratio).then(other.ends.cmp(&self.ends)).then(other.tet.cmp(&self.tet))
    }
}

impl Repair<'_> {
    /// Brings edges to their sizes and repairs the bad tets, alternately, until nothing changes; returns the
    /// bad tets that are left.
    ///
    /// A short edge is often kept by a neighbouring tet that is hardly better than bad: when no more edges
    /// can be collapsed, the surroundings of the short ones are improved.
    pub(in crate::remesh) fn bring_to_sizes(&mut self, sizing: Sizing, rounds: usize) -> Result<Vec<TetId>> {
        let splits = sizing.splits;
        // Splits next to a flat tet make more flat ones, and sizes are not reached near them.
        if splits && !self.complex.below(FLATTEST, self.threads).is_empty() {
            self.run(self.below(self.target), rounds)?;
        }
        self.sizing = Some(sizing);
        if !splits {
            self.collapse_short()?;
            return self.run(self.below(self.target), rounds);
        }
        let (mut raises, mut before) = (RAISES.iter(), usize::MAX);
        self.tried = Tried::of(self.target);
        self.split_by_levels()?;
        for _ in 0..rounds {
            let n_made = self.split_long()? + self.collapse_short()?;
            self.repair_once()?;
            let short = self.short_edges(SHORT);
            if n_made as f64 > ENOUGH * short.len() as f64 {
                continue;
            }
            if raises.len() == 0 && short.len() < before {
                (raises, before) = (RAISES.iter(), short.len());
            }
            let Some(more) = raises.next().filter(|_| !short.is_empty()) else { break };
            let tets: Vec<TetId> = short.iter().map(|edge| edge.tet).collect();
            self.improve_around(&tets, self.target + more)?;
        }
        let mut left = self.run(self.below(self.target), rounds)?;
        // A bad tet is worse than a short edge.
        if !left.is_empty() {
            self.sizing.iter_mut().for_each(|sizing| sizing.field.may_shorten = true);
            left = self.run(left, rounds)?;
        }
        Ok(left)
    }

    /// If edges are several times too long: splits only the longest, repairs, and halves the length above
    /// which edges are split, again and again, down to twice the final one. Halves of flat tets are flat: a
    /// coarse mesh that is split to the end at once has bad tets nearly everywhere.
    fn split_by_levels(&mut self) -> Result<()> {
        let long = self.edges(|_, ratio, _| ratio > LONG);
        let longest = long.iter().map(|edge| edge.ratio).fold(LONG, f64::max);
        let n_levels = (longest / LONG).log2().ceil() as i32;
        for level in (1..n_levels).rev() {
            self.sizing.iter_mut().for_each(|sizing| sizing.field.long_limit = LONG * 2f64.powi(level));
            self.split_long()?;
            self.repair_once()?;
        }
        self.sizing.iter_mut().for_each(|sizing| sizing.field.long_limit = LONG);
        Ok(())
    }

    /// Repairs each bad tet once with the first stages, and the remaining ones once with all.
    fn repair_once(&mut self) -> Result<()> {
        let mut bad = self.below(self.target);
        for n_stages in [FIRST_STAGES, STAGES.len()] {
            self.n_stages = n_stages;
            self.round(&mut bad)?;
        }
        Ok(())
    }

    /// Splits edges that are too long at their midpoints, longest first, until none is left that may be
    /// split; returns how many were split.
    fn split_long(&mut self) -> Result<usize> {
        let Some(sizing) = &self.sizing else { return Ok(0) };
        let (too_long, max_tets) = (sizing.field.long_limit, sizing.max_tets);
        let long = self.edges(|_, ratio, _| ratio > too_long);
        let mut splits = Splits { too_long, max_tets, long: BinaryHeap::from(long), n_made: 0 };
        while !splits.long.is_empty() {
            let mut longest_first = std::mem::take(&mut splits.long).into_sorted_vec();
            longest_first.reverse();
            self.make(&mut splits, "splitting long edges", &longest_first)?;
        }
        Ok(splits.n_made)
    }

    /// Collapses edges that are too short, shortest first, if that makes no edge too long and no tet that is
    /// bad and worse than the worst that was there; returns how many were collapsed.
    fn collapse_short(&mut self) -> Result<usize> {
        let Some(splits) = self.sizing.as_ref().map(|sizing| sizing.splits) else { return Ok(0) };
        let mut n_collapsed = 0;
        // When all edges were last tried: elsewhere a refused collapse would be refused again.
        let mut last_tried = None;
        loop {
            let dense = if splits { DENSE } else { SHORT };
            let mut short = self.short_edges(dense);
            let n_short = short.len();
            if let Some(time) = last_tried {
                short.retain(|edge| !edge.ends.iter().all(|&v| self.changes.none_since(v, time)));
            }
            last_tried = Some(self.changes.now());
            let mut collapses = Collapses { n_made: 0 };
            self.make(&mut collapses, "collapsing short edges", &short)?;
            n_collapsed += collapses.n_made;
            if collapses.n_made as f64 <= ENOUGH * n_short as f64 {
                return Ok(n_collapsed);
            }
        }
    }

    /// Edges that may be collapsed and are too short, or shorter than `dense` times their size in a tet that
    /// has changed; shortest first.
    fn short_edges(&mut self, dense: f64) -> Vec<Edge> {
        let is_short = |complex: &Complex, ratio: f64, tet: TetId| {
            ratio < SHORT || ratio < dense && !complex.is_original(tet)
        };
        let mut short = self.edges(is_short);
        let is_removable = |v: &VertexId| match self.complex.hold(*v) {
            Hold::Free => true,
            Hold::Surface | Hold::Edge => self.surface.is_some(),
            Hold::Fixed => false,
        };
        short.retain(|edge| edge.ends.iter().any(is_removable));
        short.sort_unstable();
        short
    }

    /// The edges for which `is_such` holds, given their ratio of length to size and one of their tets,
    /// without those of locked tets; each once, ordered by vertices. None without sizes.
    fn edges(&mut self, is_such: impl Fn(&Complex, f64, TetId) -> bool + Sync) -> Vec<Edge> {
        let Self { complex, input, sizing, .. } = self;
        let Some(Sizing { field, .. }) = sizing else { return Vec::new() };
        field.learn(complex, input, complex.tets());
        let sizes = SizesIn { field, input, complex };
        let of_tets = |(): &mut (), range: Range<usize>| {
            let mut edges = Vec::new();
            for tet in range.map(TetId::new).filter(|&t| complex.is_alive(t)) {
                let vertices = complex.vertices(tet);
                for (ratio, [i, j]) in sizes.of_tet(tet).into_iter().zip(EDGES) {
                    if is_such(complex, ratio, tet) {
                        edges.push(Edge { ratio, ends: sorted_ids([vertices[i], vertices[j]]), tet });
                    }
                }
            }
            edges
        };
        let mut edges = self.threads.in_runs(complex.n_slots(), SWEEP, of_tets);
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.tet));
        edges.dedup_by_key(|edge| edge.ends);
        let locked = locked_edges(complex);
        edges.retain(|edge| locked.binary_search(&edge.ends).is_err());
        edges
    }

    /// Whether both ends of an edge are vertices of the mesh.
    fn has_ends(&self, edge: Edge) -> bool {
        edge.ends.iter().all(|&v| self.complex.is_used(v))
    }
}

/// A pass that splits long edges at their midpoints.
struct Splits {
    /// Edges longer than this multiple of their size are too long.
    too_long: f64,
    /// No edge is split once the mesh has more than this many tets.
    max_tets: usize,
    /// Long edges that splits have made.
    long: BinaryHeap<Edge>,
    n_made: usize,
}

impl Pass for Splits {
    type Candidate = Edge;
    type Found = Option<Found<()>>;

    fn search(&self, search: &mut Search, edge: Edge) -> Option<Found<()>> {
        let complex = search.complex();
        if complex.n_tets() > self.max_tets {
            return None;
        }
        // An edge is removed only by its own split.
        let tet = search.tet_at(edge)?;
        search.around(tet, edge.ends, |search, shell| search.split(shell, edge.ends));
        search.tools.first.take(complex)
    }

    fn is_current(&self, repair: &Repair, edge: Edge, _: &Self::Found, since: u32) -> bool {
        let is_old = |v: VertexId| repair.changes.none_since(v, since);
        // A tet at the edge changes at both ends. From which tet a walk begins depends on the first end.
        let [first, second] = edge.ends;
        repair.complex.n_tets() <= self.max_tets
            && repair.has_ends(edge)
            && (is_old(first) || is_old(second) && has_edge(&repair.complex, edge.tet, edge.ends))
    }

    fn update(&self, repair: &Repair, _: Edge, found: &mut Self::Found) {
        found.iter_mut().for_each(|found| found.renumber(&repair.complex));
    }

    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, _: Edge, found: Self::Found) {
        let Some(found) = found else { return };
        let (middle, trial) = (repair.complex.next_vertex(), &mut tools.first);
        trial.set(found);
        if !trial.commit(repair) {
            return;
        }
        self.n_made += 1;
        let Some(sizes) = repair.sizes() else { return };
        for &tet in trial.inserted() {
            for other in repair.complex.vertices(tet).into_iter().filter(|&v| v != middle) {
                let ends = sorted_ids([middle, other]);
                let ratio = sizes.of_edge(ends);
                if ratio > self.too_long {
                    self.long.push(Edge { ratio, ends, tet });
                }
            }
        }
    }

    fn first(&mut self, candidate: Edge) -> Option<Edge> {
        if self.long.peek().is_some_and(|longest| *longest > candidate) { self.long.pop() } else { None }
    }
}

/// A pass that collapses short edges.
struct Collapses {
    n_made: usize,
}

impl Pass for Collapses {
    type Candidate = Edge;
    type Found = Option<Found<f64>>;

    fn search(&self, search: &mut Search, edge: Edge) -> Option<Found<f64>> {
        // An earlier collapse may have removed this edge.
        let tet = search.tet_at(edge)?;
        search.collapse_to_size(tet, edge.ends);
        search.tools.best.take(search.complex())
    }

    fn is_current(&self, repair: &Repair, edge: Edge, _: &Self::Found, since: u32) -> bool {
        repair.has_ends(edge) && edge.ends.iter().all(|&v| repair.changes.none_since(v, since))
    }

    fn update(&self, repair: &Repair, _: Edge, found: &mut Self::Found) {
        found.iter_mut().for_each(|found| found.renumber(&repair.complex));
    }

    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, _: Edge, found: Self::Found) {
        let Some(found) = found else { return };
        tools.best.set(found);
        if tools.best.commit(repair) {
            self.n_made += 1;
        }
    }
}

impl Search<'_> {
    /// Searches for a split of an edge at its midpoint, with the tets `shell` around it, whose tets are good
    /// enough. On a smooth patch, the vertex is placed on the first surface, at the point closest to the
    /// midpoint, if the walls may lie there.
    fn split(&mut self, shell: &Shell, ends: [VertexId; 2]) {
        let Repair { complex, surface, .. } = self.repair;
        let [a, b] = ends;
        if !complex.may_divide(a, b) || surface.is_none() && !shell.is_free() {
            return;
        }
        let hold: Hold = self.hold_on(shell, ends);
        let middle = scale(add(complex.point(a), complex.point(b)), 0.5);
        let bar = self.bar_of_split(shell, ends);
        let on_surface = self.on_surface(shell, middle, hold);
        let trial = &mut self.tools.first;
        let merit = Merit { operation: Operation::SplitEdge, score: (), bar };
        if let Some(point) = on_surface
            && split_edge(complex, shell, ends, (point, hold), bar, &mut trial.proposal)
            && trial.offer(Rules::of(complex).near(surface.as_ref()), |_, _| Some(merit))
        {
            return;
        }
        if split_edge(complex, shell, ends, (middle, hold), bar, &mut trial.proposal) {
            trial.offer(Rules::at_commit(complex).in_place(surface.as_ref()), |_, _| Some(merit));
        }
    }

    /// The point of the first surface closest to the midpoint of an edge of a smooth patch, if it differs
    /// from the midpoint; `shell` are the tets around the edge.
    fn on_surface(&self, shell: &Shell, middle: Point, hold: Hold) -> Option<Point> {
        let Repair { complex, surface, .. } = self.repair;
        let place = shell.walls.first().filter(|_| hold == Hold::Surface)?;
        let patch = complex.wall(shell.wall_at(complex, *place)).patch;
        surface.as_ref()?.on_patch(patch, middle).filter(|point| *point != middle)
    }

    /// The quality that the tets of a split must exceed, for an edge with the tets `shell` around it.
    ///
    /// The longest edge of all may always be split. If a longer one stays, because it is held or its halves
    /// would give only flat tets, splits of the others would make flatter and flatter tets: then no new tet
    /// may be bad and worse than the worst that was there, and none nearly flat whatever was there.
    fn bar_of_split(&self, shell: &Shell, ends: [VertexId; 2]) -> f64 {
        let Repair { complex, surface, target, .. } = self.repair;
        let ratio = |ends: [VertexId; 2]| self.repair.sizes().map_or(1.0, |sizes| sizes.of_edge(ends));
        let of_this = ratio(ends);
        let mut edges = shell.tets.iter().flat_map(|&t| {
            let vertices = complex.vertices(t);
            EDGES.map(|edge| edge.map(|i| vertices[i]))
        });
        if surface.is_some() && edges.all(|edge| ratio(edge) <= of_this * ALIKE) {
            return 0.0;
        }
        let floor = if surface.is_some() { FLATTEST } else { 0.0 };
        complex.worst_of(&shell.tets).min(*target).next_down().max(floor)
    }

    /// Searches for the better of the two collapses of an edge.
    fn collapse_to_size(&mut self, tet: TetId, [a, b]: [VertexId; 2]) {
        let repair = self.repair;
        let complex = &repair.complex;
        let Some(sizes) = repair.sizes() else { return };
        for [removed, kept] in [[a, b], [b, a]] {
            if !self.may_collapse(tet, removed, kept) {
                continue;
            }
            self.gather(removed);
            let Tools { star, best, .. } = &mut *self.tools;
            let bar = complex.worst_of(&star.tets).min(repair.target);
            // Of two equally good ones, the second is taken.
            let bar = best.score().map_or(bar.max(0.0), |best| best.max(bar)).next_down();
            if collapse(complex, &star.tets, removed, kept, bar, &mut best.proposal) {
                let rules = Rules::of(complex).near(repair.surface.as_ref()).not_longer(sizes);
                best.offer(rules, |proposal, _| {
                    Some(Merit { operation: Operation::Collapse, score: proposal.worst(), bar })
                });
            }
        }
    }

    /// A tet that has this edge; `None` if none does any more.
    fn tet_at(&mut self, Edge { ends, tet, .. }: Edge) -> Option<TetId> {
        let complex = self.complex();
        if has_edge(complex, tet, ends) {
            return Some(tet);
        }
        if !complex.is_used(ends[0]) {
            return None;
        }
        self.gather(ends[0]);
        self.tools.star.tets.iter().copied().find(|&t| has_edge(complex, t, ends))
    }
}
