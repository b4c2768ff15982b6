//! `motet run`: a mesh kept good through cycles of its walls, as a job file says.

mod args;
mod begin;
mod course;
mod job;
mod output;
mod places;
mod report;

use std::time::Instant;

use motet::base::Threads;
use motet::moving::{Change, MovingMesh, Step};
use motet::refine::Wanted;
use motet::{Error, Result};

pub(crate) use args::RunArgs;

use self::begin::Begin;
use self::job::Job;
use self::output::Output;
use self::report::Report;
use crate::args::Common;
use crate::console::Console;
use crate::exit::Outcome;

pub(crate) fn run(args: &RunArgs, common: &Common, console: &Console) -> Result<Outcome> {
    let begin = Instant::now();
    let threads = common.threads()?;
    let job = Job::read(&args.job)?;
    let mut output = Output::new(&job)?;
    let Begin { mesh, script, options, refining } = Begin::of(&job, &threads, console)?;
    let mut report = Report::new(&job);
    let state = args.resume.then(|| output.state()).flatten();
    let mut moving = match &state {
        Some(state) => {
            let moving = MovingMesh::load(state, options, &threads)?;
            if moving.driven_places() != script.places() {
                return Err(Error::input("is of another job: other vertices are driven")
                    .in_file(state)
                    .remedy("leave --resume away to start anew"));
            }
            output.go_on(moving.step())?;
            console.say(format_args!("goes on after step {}", moving.step()));
            moving
        }
        None => {
            let mut moving = MovingMesh::new(&mesh, options, &threads)?;
            let mut changes = refine(&mut moving, &refining, 0, &threads)?;
            changes.extend(moving.repair(&threads)?);
            let step = Step { changes, ..moving.certify(&threads)? };
            output.first(&moving, &step)?;
            report.line(&step, console);
            moving
        }
    };
    report.begin(moving.step());
    let last = args.until.map_or(job.n_steps(), |until| until.min(job.n_steps()));
    let bar = console.bar(last.saturating_sub(moving.step()) as u64, "moving");
    for k in moving.step() + 1..=last {
        let time = job.time(k);
        let mut step = moving.advance(time, &script.at(time / job.time.period), &threads)?;
        if step.complete {
            let mut came = refine(&mut moving, &refining, k, &threads)?;
            if !came.is_empty() {
                came.extend(moving.repair(&threads)?);
            }
            if !came.is_empty() {
                let (changes, seconds) = (std::mem::take(&mut step.changes), step.seconds);
                step = moving.certify(&threads)?;
                step.changes = changes.into_iter().chain(came).collect();
                step.seconds.total += seconds.total;
            }
        }
        let file = output.take(&moving, &step)?;
        bar.suspend(|| report.line(&step, console));
        let is_complete = step.complete;
        report.add(step, file);
        bar.inc(1);
        if !is_complete {
            break;
        }
    }
    bar.finish_and_clear();
    report.end(&output, begin.elapsed().as_secs_f64());
    report.tell(console);
    Ok(if report.is_reached() { Outcome::Done } else { Outcome::NotReached })
}

/// Divides and takes back what the job asks for after step `k`; before the first all of it.
fn refine(
    moving: &mut MovingMesh,
    refining: &[(usize, Wanted)],
    k: usize,
    threads: &Threads,
) -> Result<Vec<Change>> {
    let due = refining.iter().filter(|(every, _)| k.is_multiple_of(*every));
    let changes = due.map(|(_, wanted)| moving.refine(wanted, threads)).collect::<Result<Vec<_>>>()?;
    Ok(changes.into_iter().flatten().collect())
}
