//! Tets improved as a whole, with none left bad, by swaps and by moving vertices.
//!
//! [`Repair::run`] requires that the worst quality of what a change touches rises. By itself it leaves a mesh
//! in which most tets are hardly better than bad, and every step of a motion makes hundreds of them bad
//! again. Here a change is judged by the sum over its tets of their [defects](defect), each less the mean
//! over the mesh, so that neither many nor few tets are preferred. For a paddle that turns once in its box in
//! 72 steps (16,342 tets at first, mean EAS 0.715):
//!
//! | | tets | mean EAS | changed per step |
//! |---|---|---|---|
//! | repair alone | 37,023 | 0.370 | 10.3 % |
//! | with improvement, the strain in a band beside the paddle | 16,101 | 0.694 | 8.2 % |

use crate::base::{Point, Result, TetId, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::tet::EDGES;
use crate::kernel::{Behind, Change, Complex, Fill, Hold};
use crate::ops::{Anywhere, Objective, Reach, defect};
use crate::remesh::input_mesh::Pose;
use crate::remesh::repair::score::adds_below;
use crate::remesh::repair::trial::{Merit, Rules, Trial};
use crate::remesh::repair::tried::Settled;
use crate::remesh::repair::{Repair, Sizing};
use crate::remesh::report::Operation;

/// A change has to lower the sum of the defects of the tets it touches by this fraction. For the paddle
/// above, the mean EAS over all steps is never below 0.673 with 0.05 (7.0 % changed per step), 0.678 with
/// 0.02 (7.7 %), 0.684 with 0.01 (8.1 %), 0.686 with 0.005 (8.2 %), 0.680 with 0.002 (8.4 %).
const MIN_GAIN: f64 = 0.005;

/// How often the tets that were changed are examined again.
const ROUNDS: usize = 6;

/// What improvement aims at, and its limits.
#[derive(Clone, Copy, Debug)]
pub(in crate::remesh) struct Aim {
    /// Tets with at least this EAS are good enough.
    pub(in crate::remesh) below: f64,
    /// No tet may fall below this EAS; a tet already below it may not get worse.
    pub(in crate::remesh) floor: f64,
    /// Tets below this EAS are bad: no change adds one, even if the floor is higher.
    pub(in crate::remesh) limit: f64,
    /// How much more a change has to lower the sum of defects for each tet of the first mesh that it touches:
    /// each of these costs an interpolation, tets that have changed before cost nothing more.
    pub(in crate::remesh) cost: f64,
}

/// The cost of tets, and the gain of changes.
#[derive(Clone, Copy, Debug)]
struct CostModel<'a> {
    aim: Aim,
    /// The mean cost over the mesh.
    mean: f64,
    /// The mesh in the other pose, if there is one.
    pose: Option<&'a Pose>,
    /// Every new tet must be better than these, in the current pose and in the other one.
    bars: [f64; 2],
}

impl<'a> CostModel<'a> {
    fn new(aim: Aim, mean: f64, pose: Option<&'a Pose>) -> Self {
        Self { aim, mean, pose, bars: [f64::NEG_INFINITY; 2] }
    }

    /// The cost of an existing tet.
    fn of_tet(&self, complex: &Complex, tet: TetId) -> f64 {
        self.of(complex.quality(tet), self.pose.map(|pose| pose.quality(complex, tet)))
    }

    /// The cost of a tet with these qualities in the current and the other pose: the sum of its defects.
    /// Where walls slid past each other, tets need not be valid in the other pose; all invalid ones there
    /// cost the same.
    fn of(&self, here: f64, in_pose: Option<f64>) -> f64 {
        defect(here) + in_pose.map_or(0.0, |quality| defect(quality.max(0.0)))
    }

    /// The amount by which a change has to lower the cost of a cavity, and that cost: the sum over its tets,
    /// each less the mean.
    fn of_cavity(&self, complex: &Complex, cavity: &[TetId]) -> (f64, f64) {
        let sum: f64 = cavity.iter().map(|&t| self.of_tet(complex, t)).sum();
        let n_touched = cavity.iter().filter(|&&t| complex.is_original(t)).count();
        let least = MIN_GAIN * sum + self.aim.cost * n_touched as f64;
        (least, sum - self.mean * cavity.len() as f64)
    }

    /// The cost of the fill of a change, each tet's less the mean; infinite if a tet is not acceptable.
    /// `moved`: a vertex that moves, and its position in the other pose.
    fn of_fill(&self, change: &Change, moved: Option<(VertexId, Point)>) -> f64 {
        let of = |tet: &Fill| self.of_new(tet.vertices, tet.quality, moved) - self.mean;
        change.fill.iter().map(of).sum()
    }

    /// The cost of a new tet; infinite if it is not above the bars.
    fn of_new(&self, vertices: [VertexId; 4], quality: f64, moved: Option<(VertexId, Point)>) -> f64 {
        if quality <= self.bars[0] {
            return f64::INFINITY;
        }
        let in_pose = self.pose.map(|pose| {
            eas(vertices.map(|v| match moved {
                Some((moved, place)) if moved == v => place,
                _ => pose.point(v),
            }))
        });
        match in_pose {
            Some(in_pose) if in_pose <= self.bars[1] => f64::INFINITY,
            _ => self.of(quality, in_pose),
        }
    }

    /// Sets the limits for the tets that replace a cavity.
    fn set_bars(&mut self, complex: &Complex, cavity: &[TetId]) {
        let bar = |worst: f64| worst.min(self.aim.floor).next_down();
        let worst_in_pose =
            |pose: &Pose| cavity.iter().map(|&t| pose.quality(complex, t)).fold(f64::INFINITY, f64::min);
        self.bars = [bar(complex.worst_of(cavity)), bar(self.pose.map_or(f64::NEG_INFINITY, worst_in_pose))];
    }
}

/// Minimizes the sum of the costs.
impl Objective for CostModel<'_> {
    const NOTHING: f64 = 0.0;

    fn limit(&mut self, complex: &Complex, cavity: &[TetId], n_fill: usize) -> f64 {
        self.set_bars(complex, cavity);
        let (least, before) = self.of_cavity(complex, cavity);
        before + self.mean * n_fill as f64 - least
    }

    #[inline]
    fn cost(&self, vertices: [VertexId; 4], quality: f64) -> f64 {
        self.of_new(vertices, quality, None)
    }

    #[inline]
    fn both(&self, a: f64, b: f64) -> f64 {
        a + b
    }
}

/// The search for the best change at a tet, and the constraints on it.
#[derive(Debug)]
struct Search {
    /// Changes are compared by how much they lower the cost.
    trial: Trial,
    /// The requested sizes, if any: no change may make an edge too long or too short.
    sizing: Option<Sizing>,
}

/// The working state of one call of [`Repair::improve`].
#[derive(Debug)]
struct Progress {
    aim: Aim,
    /// The mean cost over the mesh.
    mean: f64,
    search: Search,
    settled: Settled,
    inserted: Vec<TetId>,
}

impl Repair {
    /// Swaps and moves the tets of a zone, worst first, then the tets that were inserted, as long as they
    /// improve as a whole.
    pub(in crate::remesh) fn improve(&mut self, aim: Aim, mut zone: Vec<TetId>) -> Result<()> {
        if let Some(pose) = &mut self.pose {
            pose.update(&self.complex);
        }
        let mean = self.mean_cost(aim);
        let search = Search { trial: Trial::new(), sizing: self.sizing.take() };
        let mut progress = Progress { aim, mean, search, settled: Settled::default(), inserted: Vec::new() };
        for _ in 0..ROUNDS {
            self.swap_low(&mut zone, &mut progress)?;
            self.move_low(&mut zone, &mut progress)?;
            zone = std::mem::take(&mut progress.inserted);
            if zone.is_empty() {
                break;
            }
        }
        self.sizing = progress.search.sizing;
        Ok(())
    }

    /// The tets that share a vertex with an inserted tet.
    pub(in crate::remesh) fn near_changes(&self) -> Vec<TetId> {
        let mut is_near = vec![false; self.complex.n_vertex_slots()];
        for tet in self.complex.tets().filter(|&t| !self.complex.is_original(t)) {
            self.complex.vertices(tet).into_iter().for_each(|v| is_near[v.index()] = true);
        }
        let touches = |&t: &TetId| self.complex.vertices(t).into_iter().any(|v| is_near[v.index()]);
        self.complex.tets().filter(touches).collect()
    }

    fn mean_cost(&self, aim: Aim) -> f64 {
        let model = CostModel::new(aim, 0.0, self.pose.as_ref());
        let sum: f64 = self.complex.tets().map(|t| model.of_tet(&self.complex, t)).sum();
        sum / self.complex.n_tets().max(1) as f64
    }

    fn is_low(&self, tet: TetId, below: f64) -> bool {
        self.complex.is_alive(tet) && !self.complex.is_locked(tet) && self.complex.quality(tet) < below
    }

    /// Makes the best swap at each low-quality tet of a zone, worst first.
    fn swap_low(&mut self, zone: &mut Vec<TetId>, progress: &mut Progress) -> Result<()> {
        let below = progress.aim.below;
        zone.retain(|&t| self.is_low(t, below));
        self.sort(zone);
        for (i, &tet) in zone.iter().enumerate() {
            if self.is_low(tet, below) {
                self.watch.report_and_check("improving tets", i, zone.len())?;
                self.weigh_swaps(tet, progress);
                self.make_best(progress);
            }
        }
        Ok(())
    }

    /// Moves each vertex of the low-quality tets of a zone, and of inserted ones, once if that improves them,
    /// starting with the worst tet.
    fn move_low(&mut self, zone: &mut Vec<TetId>, progress: &mut Progress) -> Result<()> {
        zone.extend_from_slice(&progress.inserted);
        zone.retain(|&t| self.is_low(t, progress.aim.below));
        self.sort(zone);
        let mut is_listed = vec![false; self.complex.n_vertex_slots()];
        let mut vertices: Vec<VertexId> = zone.iter().flat_map(|&t| self.complex.vertices(t)).collect();
        vertices.retain(|v| !std::mem::replace(&mut is_listed[v.index()], true));
        vertices.retain(|&v| {
            self.complex.hold(v) == Hold::Free && !progress.settled.has_vertex(&self.changes, v)
        });
        for (i, &vertex) in vertices.iter().enumerate() {
            self.watch.report_and_check("improving tets", i, vertices.len())?;
            if self.weigh_move(vertex, progress) {
                self.make_best(progress);
            } else {
                progress.settled.settle_vertex(&self.changes, vertex);
            }
        }
        Ok(())
    }

    /// Commits the best change found, if there is one and the kernel allows it, and forgets it.
    fn make_best(&mut self, progress: &mut Progress) {
        let Progress { search: Search { trial, .. }, inserted, .. } = progress;
        if trial.commit(&mut self.complex, &mut self.operations, Some(&mut self.changes)) {
            inserted.extend_from_slice(trial.inserted());
            if let Some(pose) = &mut self.pose {
                pose.follow(&self.complex, trial.vertex(), trial.inserted());
            }
        }
    }

    fn weigh_swaps(&mut self, tet: TetId, Progress { aim, mean, search, settled, .. }: &mut Progress) {
        let mut model = CostModel::new(*aim, *mean, self.pose.as_ref());
        let vertices = self.complex.vertices(tet);
        let mut shell = self.shells.pop().unwrap_or_default();
        for (place, edge) in EDGES.map(|e| e.map(|i| vertices[i])).into_iter().enumerate() {
            if settled.has_edge(&self.changes, &self.complex, tet, place) {
                continue;
            }
            shell.walk(&self.complex, tet, edge[0], edge[1]);
            // Walls change to repair tets, not to improve them.
            let may_go = self.surface.is_none() || self.hold_on(&shell, edge) == Hold::Free;
            let is_better = may_go
                && self.edge_removal.propose_for(
                    &self.complex,
                    &shell,
                    edge,
                    &mut model,
                    &mut search.trial.proposal,
                )
                && self.weigh((Operation::EdgeRemoval, None), model, search);
            if !is_better {
                settled.settle_edge(&self.changes, &self.complex, &shell.tets, edge);
            }
        }
        self.shells.push(shell);
        for facet in 0..4 {
            if settled.has_facet(&self.changes, &self.complex, tet, facet) {
                continue;
            }
            let behind = match self.complex.behind(tet, facet) {
                Behind::Tet(half) => half,
                Behind::Wall(_) => {
                    settled.settle_facet(&self.changes, tet, facet);
                    continue;
                }
            };
            let worst = self.complex.quality(tet).min(self.complex.quality(behind.tet()));
            let bar = worst.min(aim.floor).next_down();
            let proposal = &mut search.trial.proposal;
            let is_better = self.face_removal.propose(&self.complex, tet, facet, bar, proposal)
                && self.weigh((Operation::FaceRemoval, None), model, search);
            if !is_better {
                settled.settle_facet(&self.changes, tet, facet);
                settled.settle_facet(&self.changes, behind.tet(), behind.facet());
            }
        }
    }

    fn weigh_move(&mut self, vertex: VertexId, Progress { aim, mean, search, .. }: &mut Progress) -> bool {
        let mut model = CostModel::new(*aim, *mean, self.pose.as_ref());
        let pose = self.pose.as_ref().map(|pose| |v: VertexId| pose.point(v));
        self.star.gather(&self.complex, vertex);
        let star = &self.star.tets;
        model.set_bars(&self.complex, star);
        let (least, _) = model.of_cavity(&self.complex, star);
        let is_proposed = self.relaxation.propose(
            (&self.complex, pose.as_ref()),
            star,
            vertex,
            Reach { floor: model.bars[0], gain: least },
            &Anywhere,
            &mut search.trial.proposal,
        );
        let moved = self.relaxation.place_in_pose().map(|place| (vertex, place));
        is_proposed && self.weigh((Operation::Smoothing, moved), model, search)
    }

    /// Keeps the proposal as the best change if it gains enough, and more than the best so far. `moved` is a
    /// vertex that moves, and its place in the other pose, if there is one. Returns whether the proposal
    /// gains enough.
    fn weigh(
        &self,
        (operation, moved): (Operation, Option<(VertexId, Point)>),
        mut model: CostModel,
        Search { trial, sizing }: &mut Search,
    ) -> bool {
        let change = &trial.proposal;
        model.set_bars(&self.complex, &change.cavity);
        let (least, before) = model.of_cavity(&self.complex, &change.cavity);
        let gain = before - model.of_fill(change, moved);
        if gain <= least || self.adds_low(change, model.aim) || self.touches_kept(change) {
            return false;
        }
        // Sizes are checked only for a change that would be the best.
        if trial.score().is_some_and(|known| gain <= known) {
            return true;
        }
        let field = sizing.as_mut().map(|sizing| &mut sizing.field);
        let merit = Merit { operation, score: gain, bar: model.bars[0] };
        trial.offer(Rules::at_commit(&self.complex).fit(field), |_, _| Some(merit))
    }

    /// Whether a change leaves more tets below the floor or the limit than it found without raising the worst
    /// quality: next to a tet that walls force, others could become bad, too. If the worst quality rises, as
    /// where walls leave little space for a while, two tets that are hardly bad are better than one that is
    /// nearly flat.
    fn adds_low(&self, change: &Change, aim: Aim) -> bool {
        let adds = |bar: f64| adds_below(&self.complex, change, bar);
        let raises_worst = || change.worst() > self.complex.worst_of(&change.cavity);
        (adds(aim.floor) || aim.limit < aim.floor && adds(aim.limit)) && !raises_worst()
    }
}
