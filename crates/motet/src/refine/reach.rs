//! Refines generation after generation until a mesh is as wanted: what is wished, what is divided or taken
//! back, and the result.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;

use super::choose::wish::{Wish, check_expected, coarser, marked};
use super::choose::{Condition, Criterion, Limits, Target, wishes_of_all};
use super::refinement::{Refinement, Summary};
use super::shapes::Shapes;
use super::true_surface::OnSurface;
use super::whole::MeshRefinement;
use crate::base::{Error, Result, TetId, Threads};
use crate::mesh::history::{Changed, History, Rules};
use crate::mesh::{Qualities, TetPart};

/// The goal of a refinement.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// What to divide: every tet that at least one of them marks.
    pub criteria: Vec<Criterion>,
    /// Whether divisions are first taken back where no criterion marks; by one level if there is no criterion
    /// at all.
    pub coarsen: bool,
    /// Divisions are first taken back where one of these holds on all eight parts and no criterion marks.
    pub coarsen_where: Vec<Condition>,
    /// The largest number of generations. `None`: one, but as many as needed (at most 20) for criteria that
    /// [last](Criterion::lasts). Where divisions are taken back and no criterion says how far, the number of
    /// levels taken back, at least one.
    pub generations: Option<u32>,
    /// Limits beyond which no tet is divided.
    pub limits: Limits,
    /// The true surface, on which new boundary points are put.
    pub surface: Option<Arc<Target>>,
    /// Whether [`Reached::history`] is kept.
    pub keeps_history: bool,
}

/// The result of a refinement.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    /// Whether all edges are as short as wanted.
    pub is_reached: bool,
    /// What stopped the refinement before that; `None` if the goal was reached.
    pub stopped_by: Option<Stop>,
    /// The mesh as given, then after each generation.
    pub steps: Vec<Step>,
    /// The history from the given mesh to the final one, if requested.
    pub history: Option<History>,
    /// What was put on the true surface, if there is one.
    pub on_surface: Option<OnSurface>,
    /// The largest deviation between the volumes of new and old tets in any step and region, relative to the
    /// volume that changed.
    pub volume_deviation: f64,
}

impl Reached {
    /// Explains why edges are longer than requested; `None` if they are not.
    pub fn not_reached(&self) -> Option<String> {
        self.stopped_by.map(|stop| format!("not all edges are as short as requested: {stop}"))
    }
}

/// What stops a refinement before all edges are as short as wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Stop {
    /// The requested number of generations was reached.
    Generations,
    /// The limits allow no more; see [`Limits`].
    Limits,
    /// Cells other than tets, triangles and lines hold edges that would have to be split.
    Held,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Generations => "the number of generations was reached (--generations)",
            Self::Limits => "a limit was reached (--limit-...)",
            Self::Held => {
                "some edges belong to cells other than tets, triangles and lines, and cannot be split"
            }
        })
    }
}

/// The mesh after a generation.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Step {
    /// `came` for the mesh as given, the number of the generation, or `back` where divisions were taken back.
    pub step: String,
    /// Number of tets.
    pub tets: usize,
    /// Number of points.
    pub points: usize,
    /// Number of tets that a criterion marked.
    pub marked: usize,
    /// Number of tets divided without being marked, so that all fit.
    pub promoted: usize,
    /// Number of tets cut to fit their neighbours.
    pub cut: usize,
    /// Number of tets left as they are because of cells of other kinds, or divisions kept because a tet would
    /// be inverted.
    pub held: usize,
    /// The worst EAS.
    pub worst_eas: f64,
    /// The mean EAS.
    pub mean_eas: f64,
    /// The worst mean ratio.
    pub worst_mean_ratio: f64,
    /// The mean of the mean ratios.
    pub mean_mean_ratio: f64,
    /// Quality statistics of all tets together.
    pub quality: Qualities,
    /// The worst EAS relative to that of the first mesh.
    pub eas_of_first: f64,
    /// The worst mean ratio relative to that of the first mesh.
    pub mean_ratio_of_first: f64,
    /// Time taken, in seconds.
    pub seconds: f64,
}

/// The default limit on generations for criteria of size.
const DEFAULT_MAX_GENERATIONS: u32 = 20;

impl Wanted {
    /// The largest number of times anything is divided.
    pub fn most_generations(&self) -> u32 {
        self.generations.unwrap_or(DEFAULT_MAX_GENERATIONS)
    }

    fn coarsens(&self) -> bool {
        self.coarsen || !self.coarsen_where.is_empty()
    }
}

impl MeshRefinement {
    /// Takes back divisions no longer wanted, then divides, generation after generation. `on_step` is called
    /// with each step once it is done.
    ///
    /// # Errors
    /// When nothing is marked at all, a criterion names something the mesh does not have, more tets are
    /// wanted than there are ids, or the watch cancels the run. Steps completed before the error remain.
    pub fn reach(
        &mut self,
        wanted: &Wanted,
        rules: &Rules,
        threads: &Threads,
        on_step: impl FnMut(&Step),
    ) -> Result<Reached> {
        wanted.limits.check()?;
        let identity = || History::identity(self.mesh().points.len(), self.mesh().cells.len());
        let history = wanted.keeps_history.then(identity);
        let reached = Reached { history, ..Reached::default() };
        let mut work = Work { refinement: self, wanted, rules, threads, on_step, reached };
        work.report_step("came", Summary::default(), 0, Instant::now());
        work.reached.stopped_by = work.run()?;
        work.reached.is_reached = work.reached.stopped_by.is_none();
        Ok(work.reached)
    }
}

struct Work<'a, T> {
    refinement: &'a mut MeshRefinement,
    wanted: &'a Wanted,
    rules: &'a Rules,
    threads: &'a Threads,
    on_step: T,
    reached: Reached,
}

impl<T: FnMut(&Step)> Work<'_, T> {
    /// Takes divisions back, then divides. Returns what stopped this before all was divided.
    fn run(&mut self) -> Result<Option<Stop>> {
        let wanted = self.wanted;
        let (mut stop, mut is_held) = (Stop::Generations, false);
        if wanted.coarsens() {
            self.take_back()?;
        }
        for generation in 0.. {
            let Some(active) = self.active(generation) else { break };
            let most = if active.iter().any(Criterion::lasts) { 0 } else { wanted.most_generations() };
            self.threads.watch().report_and_check("refining", generation as usize, most as usize)?;
            let wishes = self.wishes(&active)?;
            let (n_wished, marks) = (marked(&wishes[0]).len(), marked(&wishes[1]));
            if generation == 0 && n_wished == 0 && !wanted.coarsens() {
                return Err(Error::input("no tet is marked: no tet of the mesh meets the criteria")
                    .remedy("`motet info` shows bounds and arrays; lengths are in the unit of the mesh"));
            }
            if marks.is_empty() {
                stop = Stop::Limits;
                break;
            }
            let n_held = self.divide(&marks, generation)?;
            is_held |= n_held > 0;
            if n_held == marks.len() {
                break;
            }
        }
        let stop = if is_held { Stop::Held } else { stop };
        let lasting: Vec<Criterion> = wanted.criteria.iter().filter(|c| c.lasts()).cloned().collect();
        let is_reached = lasting.is_empty() || marked(&self.wishes(&lasting)?[0]).is_empty();
        Ok((!is_reached).then_some(stop))
    }

    /// Returns the wishes for all tets, first as the criteria have them, then as the limits allow.
    fn wishes(&self, criteria: &[Criterion]) -> Result<[Vec<Wish>; 2]> {
        let part = self.refinement.part();
        let wished = wishes_of_all(criteria, self.refinement.mesh(), &part, self.threads)?;
        let mut allowed = wished.clone();
        let generations: Vec<u8> = self.refinement.refinement().generations().collect();
        self.wanted.limits.apply(&part.mesh, &generations, &mut allowed);
        check_expected(&allowed)?;
        Ok([wished, allowed])
    }

    /// Divides the marked tets once; returns how many of them were left as they are.
    fn divide(&mut self, marks: &[TetId], generation: u32) -> Result<usize> {
        let begin = Instant::now();
        let Changed { history, report: summary, .. } =
            self.refinement.refine(marks, self.rules, self.threads)?;
        self.put_on_surface();
        self.record(&history);
        self.report_step(&(generation + 1).to_string(), summary, marks.len(), begin);
        Ok(summary.n_held)
    }

    /// Returns the criteria active in a generation: those of size as often as needed, others as often as
    /// requested; `None` at the end.
    fn active(&self, generation: u32) -> Option<Vec<Criterion>> {
        if generation >= self.wanted.most_generations() {
            return None;
        }
        let n_marks = self.wanted.generations.unwrap_or(1);
        let is_active = |criterion: &&Criterion| criterion.lasts() || generation < n_marks;
        let active: Vec<Criterion> = self.wanted.criteria.iter().filter(is_active).cloned().collect();
        if active.is_empty() { None } else { Some(active) }
    }

    /// Takes back, level after level, divisions that no criterion needs. If no criterion says how far, takes
    /// back as many levels as generations are requested, or one.
    fn take_back(&mut self) -> Result<()> {
        let says_how_far = !self.wanted.criteria.is_empty() || !self.wanted.coarsen_where.is_empty();
        let n_levels = if says_how_far { u32::MAX } else { self.wanted.generations.unwrap_or(1).max(1) };
        for _ in 0..n_levels {
            self.threads.watch().report_and_check("taking divisions back", 0, 0)?;
            let removable = self.removable(&self.refinement.part())?;
            let before = self.refinement.mesh().cells.len();
            let begin = Instant::now();
            let Changed { history, report: summary, .. } =
                self.refinement.coarsen(&removable, self.rules, self.threads)?;
            self.record(&history);
            if self.refinement.mesh().cells.len() == before {
                return Ok(());
            }
            self.report_step("back", summary, 0, begin);
        }
        Ok(())
    }

    /// The tets whose division may be taken back.
    fn removable(&self, part: &TetPart) -> Result<Vec<TetId>> {
        let mesh = self.refinement.mesh();
        let wishes = wishes_of_all(&self.wanted.criteria, mesh, part, self.threads)?;
        let removable = coarser(&wishes);
        if self.wanted.coarsen_where.is_empty() {
            return Ok(removable);
        }
        let mut meets_condition = vec![false; wishes.len()];
        for condition in &self.wanted.coarsen_where {
            let marks = Criterion::Where(condition.clone()).marks(mesh, part, self.threads)?;
            marks.iter().for_each(|tet| meets_condition[tet.index()] = true);
        }
        Ok(removable.into_iter().filter(|tet| meets_condition[tet.index()]).collect())
    }

    fn record(&mut self, history: &History) {
        let regions = history.ledger.regions.iter().filter(|region| region.volume_before > 0.0);
        let parts = regions.map(|region| region.deviation / region.volume_before);
        self.reached.volume_deviation = parts.fold(self.reached.volume_deviation, f64::max);
        self.reached.history = self.reached.history.as_ref().map(|before| before.then(history));
    }

    fn put_on_surface(&mut self) {
        if let Some(surface) = &self.wanted.surface {
            let done = self.refinement.put_on_surface(surface.tree());
            let all = self.reached.on_surface.get_or_insert_default();
            all.n_moved += done.n_moved;
            all.n_short += done.n_short;
            all.farthest = all.farthest.max(done.farthest);
        }
    }

    fn report_step(&mut self, step: &str, summary: Summary, n_marked: usize, begin: Instant) {
        let seconds = begin.elapsed().as_secs_f64();
        let step = Step::new(step, self.refinement.refinement(), summary, n_marked, seconds, self.threads);
        (self.on_step)(&step);
        self.reached.steps.push(step);
    }
}

impl Step {
    fn new(
        step: &str,
        refinement: &Refinement,
        summary: Summary,
        marked: usize,
        seconds: f64,
        threads: &Threads,
    ) -> Self {
        let [first, now] = [&refinement.first(), refinement.mesh()].map(|mesh| Shapes::of(mesh, threads));
        Self {
            step: step.to_string(),
            tets: refinement.mesh().tets.len(),
            points: refinement.mesh().points.len(),
            marked,
            promoted: summary.n_promoted,
            cut: summary.n_cut,
            held: summary.n_held,
            worst_eas: now.worst_eas,
            mean_eas: now.mean_eas,
            worst_mean_ratio: now.worst_mean_ratio,
            mean_mean_ratio: now.mean_mean_ratio,
            quality: now.all,
            eas_of_first: now.worst_eas / first.worst_eas,
            mean_ratio_of_first: now.worst_mean_ratio / first.worst_mean_ratio,
            seconds,
        }
    }
}
