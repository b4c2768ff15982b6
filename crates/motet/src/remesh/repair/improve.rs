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
use crate::kernel::{Behind, Change, Complex, Fill, Hold, NO_TET};
use crate::ops::{Anywhere, Objective, Reach, defect};
use crate::remesh::input_mesh::Pose;
use crate::remesh::repair::Repair;
use crate::remesh::repair::ahead::Pass;
use crate::remesh::repair::score::adds_below;
use crate::remesh::repair::search::{Search, Tools};
use crate::remesh::repair::trial::{Found, Merit, Rules};
use crate::remesh::repair::tried::Settled;
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
        self.of(complex.quality(tet), self.pose.map(|pose| pose.quality(tet)))
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
            |pose: &Pose| cavity.iter().map(|&t| pose.quality(t)).fold(f64::INFINITY, f64::min);
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

/// The working state of one call of [`Repair::improve`].
#[derive(Debug)]
struct Progress {
    aim: Aim,
    /// The mean cost over the mesh.
    mean: f64,
    settled: Settled,
    inserted: Vec<TetId>,
}

impl Repair<'_> {
    /// Swaps and moves the tets of a zone, worst first, then the tets that were inserted, as long as they
    /// improve as a whole.
    pub(in crate::remesh) fn improve(&mut self, aim: Aim, mut zone: Vec<TetId>) -> Result<()> {
        if let Some(pose) = &mut self.pose {
            pose.update(&self.complex, &self.input, self.threads);
        }
        let mean = self.mean_cost(aim);
        let mut progress = Progress { aim, mean, settled: Settled::default(), inserted: Vec::new() };
        for _ in 0..ROUNDS {
            self.swap_low(&mut zone, &mut progress)?;
            self.move_low(&mut zone, &mut progress)?;
            zone = std::mem::take(&mut progress.inserted);
            if zone.is_empty() {
                break;
            }
        }
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

    /// The mean cost over the whole mesh.
    fn mean_cost(&self, aim: Aim) -> f64 {
        if let Some(outside) = self.outside {
            return outside.mean_defect;
        }
        let model = CostModel::new(aim, 0.0, self.pose.as_ref());
        let cost = |t: TetId| if self.complex.is_alive(t) { model.of_tet(&self.complex, t) } else { 0.0 };
        let sum: f64 = self.threads.map(self.complex.n_slots(), |t| cost(TetId::new(t))).into_iter().sum();
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
        self.make(&mut Swaps(progress), "improving tets", zone)
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
        self.make(&mut Moves(progress), "improving tets", &vertices)
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

impl Progress {
    /// The cost model of a mesh that is being repaired.
    fn model<'a>(&self, repair: &'a Repair) -> CostModel<'a> {
        CostModel::new(self.aim, self.mean, repair.pose.as_ref())
    }

    /// Commits a change that was found if the kernel allows it.
    fn make(&mut self, repair: &mut Repair, tools: &mut Tools, found: Found<f64>) {
        let trial = &mut tools.best;
        trial.set(found);
        if trial.commit(repair) {
            self.inserted.extend_from_slice(trial.inserted());
            if let Some(pose) = &mut repair.pose {
                pose.follow(&repair.complex, &repair.input, trial.vertex(), trial.inserted());
            }
        }
    }
}

/// A pass that makes the best swap at each tet.
struct Swaps<'a>(&'a mut Progress);

/// What came of an edge or a facet of a tet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    /// Nothing was searched for, since nothing would be found.
    Settled,
    /// No change gains enough.
    Failed,
    /// A change gains enough.
    Better,
}

/// What came of a tet.
#[derive(Debug, PartialEq)]
struct SwapFound {
    /// Of its edges, then its facets.
    outcomes: [Outcome; N_PLACES],
    /// The tets around the edges that failed, one edge after the other.
    shells: Vec<TetId>,
    best: Option<Found<f64>>,
}

/// The number of edges and facets of a tet.
const N_PLACES: usize = EDGES.len() + 4;

impl Pass for Swaps<'_> {
    type Candidate = TetId;
    type Found = SwapFound;

    fn search(&self, search: &mut Search, tet: TetId) -> SwapFound {
        let Self(progress) = self;
        let repair = search.repair;
        let mut found = SwapFound {
            outcomes: [Outcome::Settled; N_PLACES],
            shells: std::mem::take(&mut search.tools.settled_shells),
            best: None,
        };
        found.shells.clear();
        if !repair.is_low(tet, progress.aim.below) {
            return found;
        }
        for place in (0..N_PLACES).filter(|&place| !progress.is_settled(repair, tet, place)) {
            let is_better = match place.checked_sub(EDGES.len()) {
                None => search.weigh_edge(progress, tet, place, &mut found.shells),
                Some(facet) => search.weigh_facet(progress, tet, facet),
            };
            found.outcomes[place] = if is_better { Outcome::Better } else { Outcome::Failed };
        }
        found.best = search.tools.best.take(&repair.complex);
        found
    }

    fn is_current(&self, repair: &Repair, tet: TetId, found: &SwapFound, since: u32) -> bool {
        let Self(progress) = self;
        let is_settled_now = |place: usize| {
            found.outcomes[place] == Outcome::Better && progress.is_settled(repair, tet, place)
        };
        repair.is_unchanged(tet, since) && !(0..N_PLACES).any(is_settled_now)
    }

    /// What has been settled since was not searched for.
    fn update(&self, repair: &Repair, tet: TetId, found: &mut SwapFound) {
        let mut n_before = 0;
        for (place, outcome) in found.outcomes.iter_mut().enumerate() {
            if *outcome != Outcome::Failed {
                continue;
            }
            let is_settled = self.0.is_settled(repair, tet, place);
            if is_settled {
                *outcome = Outcome::Settled;
            }
            if place < EDGES.len() {
                let n = n_before + n_around(&found.shells[n_before..]) + 1;
                match is_settled {
                    true => _ = found.shells.drain(n_before..n),
                    false => n_before = n,
                }
            }
        }
        found.best.iter_mut().for_each(|best| best.renumber(&repair.complex));
    }

    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, tet: TetId, found: SwapFound) {
        let Self(progress) = self;
        progress.settle(repair, tet, &found);
        tools.settled_shells = found.shells;
        if let Some(best) = found.best {
            progress.make(repair, tools, best);
        }
    }
}

impl Progress {
    /// Whether a change at an edge or a facet of a tet failed, and would fail again.
    fn is_settled(&self, repair: &Repair, tet: TetId, place: usize) -> bool {
        let Repair { complex, changes, .. } = repair;
        match place.checked_sub(EDGES.len()) {
            None => self.settled.has_edge(changes, complex, tet, place),
            Some(facet) => self.settled.has_facet(changes, complex, tet, facet),
        }
    }

    /// Records the edges and facets of a tet at which no change gains enough.
    fn settle(&mut self, repair: &Repair, tet: TetId, found: &SwapFound) {
        let Repair { complex, changes, .. } = repair;
        let (vertices, settled) = (complex.vertices(tet), &mut self.settled);
        let mut shells = &found.shells[..];
        for place in (0..N_PLACES).filter(|&place| found.outcomes[place] == Outcome::Failed) {
            if let Some(facet) = place.checked_sub(EDGES.len()) {
                settled.settle_facet(changes, tet, facet);
                if let Behind::Tet(behind) = complex.behind(tet, facet) {
                    settled.settle_facet(changes, behind.tet(), behind.facet());
                }
            } else {
                let n = n_around(shells);
                settled.settle_edge(changes, complex, &shells[..n], EDGES[place].map(|i| vertices[i]));
                shells = &shells[n + 1..];
            }
        }
    }
}

/// The number of tets of the first shell in a list.
fn n_around(shells: &[TetId]) -> usize {
    shells.iter().position(|&tet| tet == NO_TET).unwrap_or(shells.len())
}

/// A pass that moves each vertex to where its tets are better.
struct Moves<'a>(&'a mut Progress);

impl Pass for Moves<'_> {
    type Candidate = VertexId;
    type Found = Option<Found<f64>>;

    fn search(&self, search: &mut Search, vertex: VertexId) -> Option<Found<f64>> {
        search.weigh_move(self.0, vertex);
        search.tools.best.take(search.complex())
    }

    fn is_current(&self, repair: &Repair, vertex: VertexId, _: &Self::Found, since: u32) -> bool {
        repair.changes.none_since(vertex, since)
    }

    fn update(&self, repair: &Repair, _: VertexId, found: &mut Self::Found) {
        found.iter_mut().for_each(|found| found.renumber(&repair.complex));
    }

    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, vertex: VertexId, found: Self::Found) {
        let Self(progress) = self;
        match found {
            Some(found) => progress.make(repair, tools, found),
            None => progress.settled.settle_vertex(&repair.changes, vertex),
        }
    }
}

impl Search<'_> {
    /// Weighs the removal of an edge of a tet, by its number in [`EDGES`]; returns whether it gains enough.
    /// If not, adds the tets around it to `shells`, and [`NO_TET`].
    fn weigh_edge(&mut self, progress: &Progress, tet: TetId, edge: usize, shells: &mut Vec<TetId>) -> bool {
        let repair = self.repair;
        let (complex, mut model) = (&repair.complex, progress.model(repair));
        let vertices = complex.vertices(tet);
        let edge = EDGES[edge].map(|i| vertices[i]);
        self.around(tet, edge, |search, shell| {
            // Walls change to repair tets, not to improve them.
            let may_go = repair.surface.is_none() || search.hold_on(shell, edge) == Hold::Free;
            let Tools { edge_removal, best, .. } = &mut *search.tools;
            let is_better = may_go
                && edge_removal.propose_for(complex, shell, edge, &mut model, &mut best.proposal)
                && search.weigh((Operation::EdgeRemoval, None), model);
            if !is_better {
                shells.extend_from_slice(&shell.tets);
                shells.push(NO_TET);
            }
            is_better
        })
    }

    /// Weighs the removal of a facet of a tet; returns whether it gains enough.
    fn weigh_facet(&mut self, progress: &Progress, tet: TetId, facet: usize) -> bool {
        let repair = self.repair;
        let complex = &repair.complex;
        let Behind::Tet(behind) = complex.behind(tet, facet) else { return false };
        let worst = complex.quality(tet).min(complex.quality(behind.tet()));
        let bar = worst.min(progress.aim.floor).next_down();
        let Tools { face_removal, best, .. } = &mut *self.tools;
        face_removal.propose(complex, tet, facet, bar, &mut best.proposal)
            && self.weigh((Operation::FaceRemoval, None), progress.model(repair))
    }

    /// Weighs the best move of a vertex.
    fn weigh_move(&mut self, progress: &Progress, vertex: VertexId) {
        let repair = self.repair;
        let (complex, mut model) = (&repair.complex, progress.model(repair));
        let pose = repair.pose.as_ref().map(|pose| |v: VertexId| pose.point(v));
        self.gather(vertex);
        let Tools { star, relaxation, best, .. } = &mut *self.tools;
        model.set_bars(complex, &star.tets);
        let (least, _) = model.of_cavity(complex, &star.tets);
        let is_proposed = relaxation.propose(
            (complex, pose.as_ref()),
            &star.tets,
            vertex,
            Reach { floor: model.bars[0], gain: least },
            &Anywhere,
            &mut best.proposal,
        );
        let moved = relaxation.place_in_pose().map(|place| (vertex, place));
        if is_proposed {
            self.weigh((Operation::Smoothing, moved), model);
        }
    }

    /// Keeps the proposal as the best change if it gains enough, and more than the best so far. `moved` is a
    /// vertex that moves, and its place in the other pose, if there is one. Returns whether the proposal
    /// gains enough.
    fn weigh(
        &mut self,
        (operation, moved): (Operation, Option<(VertexId, Point)>),
        mut model: CostModel,
    ) -> bool {
        let repair = self.repair;
        let (complex, trial) = (&repair.complex, &mut self.tools.best);
        let change = &trial.proposal;
        model.set_bars(complex, &change.cavity);
        let (least, before) = model.of_cavity(complex, &change.cavity);
        let gain = before - model.of_fill(change, moved);
        if gain <= least || repair.adds_low(change, model.aim) || repair.touches_kept(change) {
            return false;
        }
        // Sizes are checked only for a change that would be the best.
        if trial.score().is_some_and(|known| gain <= known) {
            return true;
        }
        let merit = Merit { operation, score: gain, bar: model.bars[0] };
        trial.offer(Rules::at_commit(complex).fit(repair.sizes()), |_, _| Some(merit))
    }
}
