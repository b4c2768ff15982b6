//! `motet run`: keeps a mesh good through cycles of its walls, as described by a job file.

mod args;
mod course;
mod job;
mod output;
mod record;
mod report;
mod setup;

use std::time::Instant;

use motet::base::Threads;
use motet::moving::{Change, MovingMesh, Script, Seconds, Step};
use motet::refine::Wanted;
use motet::{Error, Result};

pub(crate) use args::RunArgs;
pub(crate) use report::Report;

use self::job::Job;
use self::output::Output;
use self::setup::Setup;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;

pub(crate) fn run(args: &RunArgs, common: &Common, console: &Console) -> Result<Outcome> {
    if args.keys {
        console.print(Job::keys().trim_end());
        return Ok(Outcome::Done);
    }
    let report = execute(args, common, console)?;
    report.print(console);
    Ok(report.outcome())
}

/// Makes the steps of a job and reports the result.
pub(crate) fn execute(args: &RunArgs, common: &Common, console: &Console) -> Result<Report> {
    let begin = Instant::now();
    let threads = common.threads()?;
    let file = args
        .job
        .as_deref()
        .ok_or_else(|| Error::options("no job is given").remedy("give a job file, or --keys"))?;
    let job = Job::read(file)?;
    let mut output = Output::new(&job)?;
    let mut report = Report::new(&job, &output);
    let mut run = Run::begin(&job, args.resume, &mut output, &mut report, &threads, console)?;
    let last = args.until.map_or(job.n_steps(), |until| until.min(job.n_steps()));
    let meter = console.meter("moving", Some(last.saturating_sub(run.moving.step())));
    let threads = threads.watched(meter.watch());
    for k in run.moving.step() + 1..=last {
        let step = run.step(job.time(k), job.time.period, &threads)?;
        output.take(&run.moving, &step, &threads)?;
        meter.suspend(|| report::line(&step, console));
        report.add(&step);
        meter.step();
        if !step.complete {
            break;
        }
    }
    drop(meter);
    report.seconds_total = begin.elapsed().as_secs_f64();
    Ok(report)
}

/// A job in progress.
struct Run {
    moving: MovingMesh,
    script: Script,
    /// What to refine, and after every how many steps.
    refining: Vec<(usize, Wanted)>,
}

impl Run {
    /// Starts at the first step, or after the last that an earlier run has saved.
    fn begin(
        job: &Job,
        resume: bool,
        output: &mut Output,
        report: &mut Report,
        threads: &Threads,
        console: &Console,
    ) -> Result<Self> {
        let record = record::of(job)?;
        let state = output.state().filter(|_| resume);
        if state.is_some() {
            output.check_record(job, &record)?;
        }
        let Setup { mesh, script, options, refining } = Setup::of(job, threads, console)?;
        if let Some(state) = state {
            let moving = MovingMesh::load(&state, options, threads)?;
            if moving.driven_places() != script.places() {
                return Err(Error::input("belongs to another job: other vertices are driven")
                    .in_file(state)
                    .remedy("omit --resume to start anew"));
            }
            output.resume_after(moving.step())?;
            report.resume_after(moving.step());
            console.print(format_args!("resumes after step {}", moving.step()));
            return Ok(Self { moving, script, refining });
        }
        let moving = MovingMesh::new(&mesh, options, threads)?;
        report.warn_of_rims(job, &moving, &script, console);
        let mut run = Self { moving, script, refining };
        let mut changes = run.refine(0, threads)?;
        changes.extend(run.moving.repair(threads)?);
        let step = Step { changes, ..run.moving.certify(threads)? };
        output.first(&record, &run.moving, &step, threads)?;
        report::line(&step, console);
        report.add(&step);
        Ok(run)
    }

    fn step(&mut self, time: f64, period: f64, threads: &Threads) -> Result<Step> {
        let mut step = self.moving.advance(time, &self.script.at(time / period), threads)?;
        if !step.complete {
            return Ok(step);
        }
        let begin = Instant::now();
        let mut changes = self.refine(step.step, threads)?;
        if changes.is_empty() {
            return Ok(step);
        }
        changes.extend(self.moving.repair(threads)?);
        let repair = begin.elapsed().as_secs_f64();
        let after = self.moving.certify(threads)?;
        step.seconds += after.seconds;
        step.seconds += Seconds { repair, total: repair, ..Seconds::default() };
        step.changes.extend(changes);
        Ok(Step { legs: step.legs, changes: step.changes, seconds: step.seconds, ..after })
    }

    /// Makes the refinements that are due after step `k`; before the first step, all of them.
    fn refine(&mut self, k: usize, threads: &Threads) -> Result<Vec<Change>> {
        let due = self.refining.iter().filter(|(every, _)| k.is_multiple_of(*every));
        let changes =
            due.map(|(_, wanted)| self.moving.refine(wanted, threads)).collect::<Result<Vec<_>>>()?;
        Ok(changes.into_iter().flatten().collect())
    }
}
