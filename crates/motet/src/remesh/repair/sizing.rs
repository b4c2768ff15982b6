//! Edges brought to the requested sizes: long ones split, short ones collapsed, bad tets repaired, until
//! nothing changes.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::base::{Point, Result, TetId, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};
use crate::kernel::{Hold, Shell};
use crate::ops::{collapse, split_edge};
use crate::remesh::lengths::locked_edges;
use crate::remesh::repair::stages::{FIRST_STAGES, STAGES};
use crate::remesh::repair::trial::{Merit, Rules, Trial};
use crate::remesh::repair::tried::Tried;
use crate::remesh::repair::{RAISES, Repair};
use crate::remesh::report::Operation;
use crate::remesh::sizes::{LONG, SHORT, SizeField};

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

impl Repair {
    /// Brings edges to their sizes and repairs the bad tets, alternately, until nothing changes; returns the
    /// bad tets that are left.
    ///
    /// A short edge is often kept by a neighbouring tet that is hardly better than bad: when no more edges
    /// can be collapsed, the surroundings of the short ones are improved.
    pub(in crate::remesh) fn bring_to_sizes(&mut self, sizing: Sizing, rounds: usize) -> Result<Vec<TetId>> {
        let splits = sizing.splits;
        // Splits next to a flat tet make more flat ones, and sizes are not reached near them.
        if splits && !self.complex.below(FLATTEST).is_empty() {
            self.run(self.below(self.target), rounds)?;
        }
        self.sizing = Some(sizing);
        if !splits {
            self.with_sizing(Self::collapse_short)?;
            return self.run(self.below(self.target), rounds);
        }
        let (mut raises, mut before) = (RAISES.iter(), usize::MAX);
        self.tried = Tried::of(self.target);
        self.split_by_levels()?;
        for _ in 0..rounds {
            let n_made = self.with_sizing(Self::split_long)? + self.with_sizing(Self::collapse_short)?;
            self.repair_once()?;
            let short =
                self.with_sizing(|repair, sizing| Ok(repair.short_edges(&mut sizing.field, SHORT)))?;
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
        let longest = self.with_sizing(|repair, sizing| {
            let long = repair.edges(&mut sizing.field, |ratio, _| ratio > LONG);
            Ok(long.iter().map(|edge| edge.ratio).fold(LONG, f64::max))
        })?;
        let n_levels = (longest / LONG).log2().ceil() as i32;
        for level in (1..n_levels).rev() {
            self.sizing.iter_mut().for_each(|sizing| sizing.field.long_limit = LONG * 2f64.powi(level));
            self.with_sizing(Self::split_long)?;
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

    fn with_sizing<T: Default>(
        &mut self,
        work: impl FnOnce(&mut Self, &mut Sizing) -> Result<T>,
    ) -> Result<T> {
        let Some(mut sizing) = self.sizing.take() else { return Ok(T::default()) };
        let done = work(self, &mut sizing);
        self.sizing = Some(sizing);
        done
    }

    /// Splits edges that are too long at their midpoints, longest first, until none is left that may be
    /// split; returns how many were split.
    fn split_long(&mut self, sizing: &mut Sizing) -> Result<usize> {
        let too_long = sizing.field.long_limit;
        let mut long = BinaryHeap::from(self.edges(&mut sizing.field, |ratio, _| ratio > too_long));
        let (mut n_split, mut trial) = (0, Trial::new());
        while let Some(edge) = long.pop() {
            if self.complex.n_tets() > sizing.max_tets {
                break;
            }
            self.watch.report_and_check("splitting long edges", n_split, n_split + long.len())?;
            // An edge is removed only by its own split.
            let Some(tet) = self.tet_at(edge) else { continue };
            let Some(middle) = self.split(tet, edge.ends, &mut sizing.field, &mut trial) else { continue };
            n_split += 1;
            for &tet in trial.inserted() {
                for other in self.complex.vertices(tet).into_iter().filter(|&v| v != middle) {
                    let ends = [middle.min(other), middle.max(other)];
                    let ratio = sizing.field.of_edge(&self.complex, ends);
                    if ratio > too_long {
                        long.push(Edge { ratio, ends, tet });
                    }
                }
            }
        }
        Ok(n_split)
    }

    /// Splits an edge at its midpoint if the new tets are good enough; returns the new vertex. On a smooth
    /// patch, the vertex is placed on the first surface, at the point closest to the midpoint, if the walls
    /// may lie there.
    fn split(
        &mut self,
        tet: TetId,
        ends: [VertexId; 2],
        field: &mut SizeField,
        trial: &mut Trial<()>,
    ) -> Option<VertexId> {
        self.around(tet, ends, |repair, shell| repair.split_around(shell, ends, field, trial))
    }

    /// Splits an edge with the tets `shell` around it; see [`Self::split`].
    fn split_around(
        &mut self,
        shell: &Shell,
        ends: [VertexId; 2],
        field: &mut SizeField,
        trial: &mut Trial<()>,
    ) -> Option<VertexId> {
        let [a, b] = ends;
        if !self.complex.may_divide(a, b) || self.surface.is_none() && !shell.is_free() {
            return None;
        }
        let hold: Hold = self.hold_on(shell, ends);
        let middle = scale(add(self.complex.point(a), self.complex.point(b)), 0.5);
        let vertex = self.complex.next_vertex();
        let bar = self.bar_of_split(shell, ends, field);
        for (point, is_middle) in [(self.on_surface(shell, middle, hold), false), (Some(middle), true)] {
            let Some(point) = point else { continue };
            let (complex, surface) = (&self.complex, self.surface.as_ref());
            if !split_edge(complex, shell, ends, (point, hold), bar, &mut trial.proposal) {
                continue;
            }
            let rules = Rules::at_commit(complex);
            let rules = if is_middle { rules.in_place(surface) } else { rules.near(surface) };
            trial.offer(rules, |_, _| Some(Merit { operation: Operation::SplitEdge, score: (), bar }));
            if trial.commit(&mut self.complex, &mut self.operations, Some(&mut self.changes)) {
                return Some(vertex);
            }
        }
        None
    }

    /// The point of the first surface closest to the midpoint of an edge of a smooth patch, if it differs
    /// from the midpoint; `shell` are the tets around the edge.
    fn on_surface(&self, shell: &Shell, middle: Point, hold: Hold) -> Option<Point> {
        let surface = self.surface.as_ref()?;
        let place = shell.walls.first().filter(|_| hold == Hold::Surface)?;
        let patch = self.complex.wall(shell.wall_at(&self.complex, *place)).patch;
        surface.on_patch(patch, middle).filter(|point| *point != middle)
    }

    /// The quality that the tets of a split must exceed, for an edge with the tets `shell` around it.
    ///
    /// The longest edge of all may always be split. If a longer one stays, because it is held or its halves
    /// would give only flat tets, splits of the others would make flatter and flatter tets: then no new tet
    /// may be bad and worse than the worst that was there, and none nearly flat whatever was there.
    fn bar_of_split(&self, shell: &Shell, ends: [VertexId; 2], field: &mut SizeField) -> f64 {
        let tets = &shell.tets;
        let ratio = field.of_edge(&self.complex, ends);
        let mut edges = tets.iter().flat_map(|&t| {
            let vertices = self.complex.vertices(t);
            EDGES.map(|edge| edge.map(|i| vertices[i]))
        });
        if self.surface.is_some() && edges.all(|[a, b]| field.of_edge(&self.complex, [a, b]) <= ratio * ALIKE)
        {
            return 0.0;
        }
        let floor = if self.surface.is_some() { FLATTEST } else { 0.0 };
        self.complex.worst_of(tets).min(self.target).next_down().max(floor)
    }

    /// Collapses edges that are too short, shortest first, if that makes no edge too long and no tet that is
    /// bad and worse than the worst that was there; returns how many were collapsed.
    fn collapse_short(&mut self, sizing: &mut Sizing) -> Result<usize> {
        let (mut n_collapsed, mut trial) = (0, Trial::new());
        // Whether a tet at a vertex was inserted since all edges were last tried: elsewhere a refused
        // collapse would be refused again.
        let mut is_changed = vec![true; self.complex.n_vertex_slots()];
        loop {
            let dense = if sizing.splits { DENSE } else { SHORT };
            let short = self.short_edges(&mut sizing.field, dense);
            let was_changed = std::mem::replace(&mut is_changed, vec![false; self.complex.n_vertex_slots()]);
            let mut n_now = 0;
            for (i, &edge) in short.iter().enumerate() {
                if !edge.ends.iter().any(|v| was_changed[v.index()]) {
                    continue;
                }
                self.watch.report_and_check("collapsing short edges", i, short.len())?;
                // An earlier collapse may have removed this edge.
                let Some(tet) = self.tet_at(edge) else { continue };
                if self.collapse_to_size(tet, edge.ends, &mut sizing.field, &mut trial) {
                    n_now += 1;
                    let vertices = trial.inserted().iter().flat_map(|&t| self.complex.vertices(t));
                    vertices.for_each(|v| is_changed[v.index()] = true);
                }
            }
            n_collapsed += n_now;
            if n_now as f64 <= ENOUGH * short.len() as f64 {
                return Ok(n_collapsed);
            }
        }
    }

    /// Edges that may be collapsed and are too short, or shorter than `dense` times their size in a tet that
    /// has changed; shortest first.
    fn short_edges(&self, field: &mut SizeField, dense: f64) -> Vec<Edge> {
        let is_short =
            |ratio: f64, tet: TetId| ratio < SHORT || ratio < dense && !self.complex.is_original(tet);
        let mut short = self.edges(field, is_short);
        let is_removable = |v: &VertexId| match self.complex.hold(*v) {
            Hold::Free => true,
            Hold::Surface | Hold::Edge => self.surface.is_some(),
            Hold::Fixed => false,
        };
        short.retain(|edge| edge.ends.iter().any(is_removable));
        short.sort_unstable();
        short
    }

    /// Collapses an edge in the better of the two directions, if one is allowed.
    fn collapse_to_size(
        &mut self,
        tet: TetId,
        [a, b]: [VertexId; 2],
        field: &mut SizeField,
        trial: &mut Trial,
    ) -> bool {
        for [removed, kept] in [[a, b], [b, a]] {
            if !self.may_collapse(tet, removed, kept) {
                continue;
            }
            self.star.gather(&self.complex, removed);
            let bar = self.complex.worst_of(&self.star.tets).min(self.target);
            // Of two equally good ones, the second is taken.
            let bar = trial.score().map_or(bar.max(0.0), |best| best.max(bar)).next_down();
            if collapse(&self.complex, &self.star.tets, removed, kept, bar, &mut trial.proposal) {
                let rules = Rules::of(&self.complex).near(self.surface.as_ref()).not_longer(field);
                trial.offer(rules, |proposal, _| {
                    Some(Merit { operation: Operation::Collapse, score: proposal.worst(), bar })
                });
            }
        }
        trial.commit(&mut self.complex, &mut self.operations, Some(&mut self.changes))
    }

    /// The edges for which `is_such` holds, given their ratio of length to size and one of their tets,
    /// without those of locked tets; each once, ordered by vertices.
    fn edges(&self, field: &mut SizeField, is_such: impl Fn(f64, TetId) -> bool) -> Vec<Edge> {
        let mut edges = Vec::new();
        for tet in self.complex.tets() {
            let vertices = self.complex.vertices(tet);
            let ratios = field.of_tet(vertices, self.complex.corners(tet));
            for (ratio, [i, j]) in ratios.into_iter().zip(EDGES) {
                if is_such(ratio, tet) {
                    edges.push(Edge { ratio, ends: sorted_ids([vertices[i], vertices[j]]), tet });
                }
            }
        }
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.tet));
        edges.dedup_by_key(|edge| edge.ends);
        let locked = locked_edges(&self.complex);
        edges.retain(|edge| locked.binary_search(&edge.ends).is_err());
        edges
    }

    /// A tet that has this edge; `None` if none does any more.
    fn tet_at(&mut self, Edge { ends, tet, .. }: Edge) -> Option<TetId> {
        let has =
            |t: TetId| self.complex.is_alive(t) && ends.iter().all(|v| self.complex.vertices(t).contains(v));
        if has(tet) {
            return Some(tet);
        }
        if !self.complex.is_used(ends[0]) {
            return None;
        }
        self.star.gather(&self.complex, ends[0]);
        self.star.tets.iter().copied().find(|&t| has(t))
    }
}
