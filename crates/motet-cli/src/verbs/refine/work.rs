//! Generation after generation: what is wished, what is divided, what came of it.

use std::sync::Arc;
use std::time::Instant;

use indicatif::ProgressBar;
use motet::base::{TetId, Threads};
use motet::mesh::TetPart;
use motet::mesh::history::{History, Rules};
use motet::refine::wish::{Wish, check_expected, coarser, marked};
use motet::refine::{Criterion, MeshRefinement, Summary, Target, wishes_of_all};
use motet::{Error, Result};

use super::args::RefineArgs;
use super::report::{Report, Step};

/// A call at work.
pub(super) struct Work<'a> {
    pub(super) args: &'a RefineArgs,
    pub(super) refinement: MeshRefinement,
    pub(super) surface: Option<Arc<Target>>,
    pub(super) rules: &'a Rules,
    /// From the mesh that came to this one, where the call asks for it.
    pub(super) history: Option<History>,
    pub(super) report: Report,
    pub(super) threads: &'a Threads,
}

impl Work<'_> {
    /// Tells of the mesh as it came.
    pub(super) fn begin(&mut self) {
        self.tell("came", Summary::default(), 0, Instant::now());
    }

    /// Takes back, then divides; `false` where edges are still longer than was asked for.
    pub(super) fn run(&mut self, criteria: &[Criterion], bar: &ProgressBar) -> Result<bool> {
        let is_back = self.args.coarsen || !self.args.coarsen_where.is_empty();
        if is_back {
            self.take_back(criteria)?;
        }
        for generation in 0.. {
            let Some(active) = self.active(criteria, generation) else { break };
            let wishes = self.wishes(&active)?;
            let (n_wished, marks) = (marked(&wishes[0]).len(), marked(&wishes[1]));
            if generation == 0 && n_wished == 0 && !is_back {
                return Err(Error::input("no tet is marked: nothing of it is where, or as, the call says")
                    .remedy("`motet info` tells bounds and arrays; lengths are in the unit of the mesh"));
            }
            if marks.is_empty() || self.divide(&marks, generation)? == marks.len() {
                break;
            }
            bar.inc(1);
        }
        let lasting: Vec<Criterion> = criteria.iter().filter(|c| c.lasts()).cloned().collect();
        Ok(lasting.is_empty() || marked(&self.wishes(&lasting)?[0]).is_empty())
    }

    /// What is wished of each tet, and what of it the limits allow.
    fn wishes(&self, criteria: &[Criterion]) -> Result<[Vec<Wish>; 2]> {
        let part = self.refinement.part();
        let wished = wishes_of_all(criteria, self.refinement.mesh(), &part, self.threads)?;
        let mut allowed = wished.clone();
        let generations: Vec<u8> = self.refinement.refinement().generations().collect();
        self.args.limits().apply(&part.mesh, &generations, &mut allowed);
        check_expected(&allowed)?;
        Ok([wished, allowed])
    }

    /// How many were left as they are.
    fn divide(&mut self, marks: &[TetId], generation: u32) -> Result<usize> {
        let begin = Instant::now();
        let (summary, history) = self.refinement.refine(marks, self.rules, self.threads)?;
        self.put_on_surface();
        self.went(&history);
        self.tell(&(generation + 1).to_string(), summary, marks.len(), begin);
        Ok(summary.n_held)
    }

    /// The criteria of a generation: those of sizes as often as it takes, others as often as is said; `None` at the end.
    fn active(&self, criteria: &[Criterion], generation: u32) -> Option<Vec<Criterion>> {
        if generation >= self.args.most_generations() {
            return None;
        }
        let n_marks = self.args.generations.unwrap_or(1);
        let is_active = |criterion: &&Criterion| criterion.lasts() || generation < n_marks;
        let active: Vec<Criterion> = criteria.iter().filter(is_active).cloned().collect();
        if active.is_empty() { None } else { Some(active) }
    }

    /// Takes back, level after level, what no criterion needs; one level where nothing says how far.
    fn take_back(&mut self, criteria: &[Criterion]) -> Result<()> {
        loop {
            let part = self.refinement.part();
            let free = self.free(criteria, &part)?;
            let before = self.refinement.mesh().cells.len();
            let begin = Instant::now();
            let (summary, history) = self.refinement.coarsen(&free, self.rules, self.threads)?;
            self.went(&history);
            if self.refinement.mesh().cells.len() == before {
                return Ok(());
            }
            self.tell("back", summary, 0, begin);
            if criteria.is_empty() && self.args.coarsen_where.is_empty() {
                return Ok(());
            }
        }
    }

    /// The tets whose division may be taken back.
    fn free(&self, criteria: &[Criterion], part: &TetPart) -> Result<Vec<TetId>> {
        let mesh = self.refinement.mesh();
        let wishes = wishes_of_all(criteria, mesh, part, self.threads)?;
        let free = coarser(&wishes);
        if self.args.coarsen_where.is_empty() {
            return Ok(free);
        }
        let mut is_so = vec![false; wishes.len()];
        for condition in &self.args.coarsen_where {
            let marks = Criterion::Where(condition.clone()).marks(mesh, part, self.threads)?;
            marks.iter().for_each(|tet| is_so[tet.index()] = true);
        }
        Ok(free.into_iter().filter(|tet| is_so[tet.index()]).collect())
    }

    fn went(&mut self, history: &History) {
        self.report.add_volumes(&history.ledger);
        self.history = self.history.as_ref().map(|before| before.then(history));
    }

    fn put_on_surface(&mut self) {
        if let Some(surface) = &self.surface {
            let done = self.refinement.put_on_surface(surface.tree());
            self.report.add_on_surface(done);
        }
    }

    fn tell(&mut self, step: &str, summary: Summary, n_marked: usize, begin: Instant) {
        let seconds = begin.elapsed().as_secs_f64();
        self.report.add(Step::new(
            step,
            self.refinement.refinement(),
            summary,
            n_marked,
            seconds,
            self.threads,
        ));
    }
}
