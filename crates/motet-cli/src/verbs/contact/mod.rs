//! `motet contact`: how far apart surfaces are, where, and when they will touch.

mod args;
mod delaunay;
mod frames;
mod histogram;
mod output;
mod print;
mod report;

use std::path::PathBuf;
use std::time::Instant;

use motet::base::Threads;
use motet::contact::{Ahead, Contact, Gaps};
use motet::io::{self, SeriesWriter};
use motet::{Error, Result};

pub(crate) use args::ContactArgs;

use self::args::Method;
use self::delaunay::DelaunayAccuracy;
use self::frames::{Frame, Frames};
use self::report::{Report, Step};
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;

pub(crate) fn run(args: &ContactArgs, common: &Common, console: &Console) -> Result<Outcome> {
    let begin = Instant::now();
    args.check()?;
    outputs::check(&args.output, args.surfaces.iter().map(PathBuf::as_path), "a surface")?;
    args.gap_tets.as_ref().map_or(Ok(()), io::can_write)?;
    let frames = Frames::new(args)?;
    let n = frames.times.len();
    if n > 1 && !io::can_write_series(&args.output) {
        console.warn(format_args!(
            "{} is a single file: the last of {n} frames is written there; give a .pvd to keep all",
            args.output.display()
        ));
    }
    let meter = console.meter("measuring", Some(n));
    let threads = common.threads()?.watched(meter.watch());
    let mut report = Report::new(args);
    let mut series =
        io::can_write_series(&args.output).then(|| SeriesWriter::new(&args.output, args.writing.options()));
    series.as_mut().map_or(Ok(true), SeriesWriter::lock)?;
    let mut handle: Option<(Contact, Frame)> = None;
    let mut next = Some(frames.read(0, console)?);
    for k in 0..n {
        let Some(mut frame) = next.take() else { break };
        if k + 1 < n {
            next = Some(frames.read(k + 1, console)?);
        }
        let measuring = Instant::now();
        let mut contact = prepare(handle.take(), &mut frame, args, &threads)?;
        let mut gaps = contact.measure(&threads);
        report.seconds.measure += measuring.elapsed().as_secs_f64();
        let accuracy = by_delaunay(&contact, &mut gaps, args, &threads, console)?;
        let looking = Instant::now();
        let dt = if k + 1 < n { frames.times[k + 1] - frames.times[k] } else { 0.0 };
        let ahead = look_ahead(&contact, &frame, next.as_ref(), dt, args, &threads)?;
        report.seconds.look_ahead += looking.elapsed().as_secs_f64();
        let is_last = k + 1 == n;
        let mut mesh = output::mesh(&frame, &gaps, ahead.as_ref());
        let (accuracy, errors) = accuracy.unzip();
        errors.into_iter().for_each(|errors| output::add_errors(&mut mesh, errors));
        let writing = Instant::now();
        let file = match &mut series {
            Some(series) => Some(series.add_on(frames.times[k], &mesh, &threads)?),
            None if is_last => {
                let lost = io::write_on(&args.output, &mesh, &args.writing.options(), &threads)?;
                Some((args.output.clone(), lost))
            }
            None => None,
        };
        report.seconds.write += writing.elapsed().as_secs_f64();
        let (file, lost) = file.unzip();
        lost.into_iter().flatten().for_each(|what| console.warn(what));
        let step = Step::new(frames.times[k], file, &contact, &frame, &gaps, ahead.as_ref());
        report.add(&contact, &frame, step.with_delaunay(accuracy));
        handle = Some((contact, frame));
        meter.step();
    }
    drop(meter);
    report.seconds.total = begin.elapsed().as_secs_f64();
    let fails = args.fail_on_warning && report.is_warned();
    let outcome = Outcome::of(fails.then(|| "some gaps are below --warn".to_owned()));
    report.print(&outcome, console);
    Ok(outcome)
}

/// The contact of the previous frame with its points moved, where only points differ; otherwise a new one.
fn prepare(
    last: Option<(Contact, Frame)>,
    frame: &mut Frame,
    args: &ContactArgs,
    threads: &Threads,
) -> Result<Contact> {
    let file = (frame.sources.len() == 1).then(|| frame.sources[0].file.clone());
    let with_file = |e: Error| match (e.file(), file) {
        (None, Some(file)) => e.in_file(&file),
        _ => e,
    };
    if let Some((mut contact, last)) = last {
        if frame.has_same_triangles(&last) {
            contact.refit(&frame.points, threads).map_err(with_file)?;
            return Ok(contact);
        }
        frame.keep_rooms(&contact);
    }
    Contact::new(frame.points.clone(), frame.bodies.clone(), args.words().options(), threads)
        .map_err(with_file)
}

/// The gaps by Delaunay tets and the tets themselves, where requested.
fn by_delaunay(
    contact: &Contact,
    gaps: &mut Gaps,
    args: &ContactArgs,
    threads: &Threads,
    console: &Console,
) -> Result<Option<(DelaunayAccuracy, Vec<f64>)>> {
    if args.method == Method::Exact && args.gap_tets.is_none() {
        return Ok(None);
    }
    let (between, seconds) = delaunay::between(contact, threads)?;
    if let Some(file) = &args.gap_tets {
        let (mesh, n_flat) = delaunay::tets(contact, &between);
        let lost = io::write_on(file, &mesh, &args.writing.options(), threads)?;
        lost.iter().for_each(|what| console.warn(what));
        if n_flat > 0 {
            console.warn(format_args!(
                "{n_flat} gap tets are not written: they are triangles or segments, since all vertices lie \
                 in a plane"
            ));
        }
    }
    let is_requested = args.method == Method::Delaunay;
    Ok(is_requested.then(|| delaunay::replace(gaps, &between, seconds, args.warn)))
}

/// Looks ahead by velocities where given, otherwise to the next frame where it fits.
fn look_ahead(
    contact: &Contact,
    frame: &Frame,
    next: Option<&Frame>,
    dt: f64,
    args: &ContactArgs,
    threads: &Threads,
) -> Result<Option<Ahead>> {
    if let Some(velocity) = &frame.velocity {
        let horizon = args.horizon.unwrap_or(f64::INFINITY);
        return contact.look_ahead(velocity, horizon, threads).map(Some);
    }
    match next.filter(|next| dt > 0.0 && next.has_same_triangles(frame)) {
        Some(next) => contact.look_ahead_to(&next.points, dt, threads).map(Some),
        None => Ok(None),
    }
}
