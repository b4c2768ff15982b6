//! `motet refine`: divides tets where it matters, and takes divisions back where it does not.

mod args;
mod report;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use motet::base::Threads;
use motet::refine::{MeshRefinement, Options, Target, Wanted, fix_sizes};
use motet::{Error, io};

pub(crate) use args::RefineArgs;

use self::report::Report;
use crate::arrays::Written;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;
use crate::table::seconds;

pub(crate) fn run(args: &RefineArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    outputs::check_with_history(&args.output, &args.mesh, args.arrays.history.as_deref())?;
    let meter = console.meter("refining", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let mut wanted = wanted(args, &threads)?;
    let (old, notes) = io::read_on(&args.mesh, &threads)?;
    let rules = args.arrays.rules(&old).map_err(|e| e.in_file(&args.mesh))?;
    let mut given = if args.forget { MeshRefinement::forget(&old) } else { old };
    let sizes = fix_sizes(&mut wanted.criteria, &mut given, &threads).map_err(|e| e.in_file(&args.mesh))?;
    let mut refinement =
        MeshRefinement::new(&given, Options::default(), &threads).map_err(|e| hint(e).in_file(&args.mesh))?;
    let read = begin.elapsed().as_secs_f64();

    let done = refinement.reach(&wanted, &rules, &threads, |_| ());
    let done = done.map_err(|e| e.in_file(&args.mesh))?;
    meter.stage("writing");
    let mut mesh = refinement.with_memory(&threads);
    mesh.point_data.retain(|field| !sizes.contains(&field.name));
    let Written { lost, seconds: write } =
        args.arrays.write(&mut mesh, done.history.as_ref(), &args.output, &args.writing, &threads)?;
    drop(meter);
    console.detail(format_args!("read {} in {}", args.mesh.display(), seconds(read)));
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    notes.iter().chain(&lost).for_each(|what| console.warn(what));
    let outcome = Outcome::of(done.not_reached());
    Report::new(args, &refinement, done, [read, write, begin.elapsed().as_secs_f64()], &threads)
        .print(&outcome, console);
    Ok(outcome)
}

/// The goal of a call, with the surfaces that it names.
fn wanted(args: &RefineArgs, threads: &Threads) -> motet::Result<Wanted> {
    let words = args.words();
    let criteria = words.criteria(|file| target(file, threads))?;
    let surface = args.surface.as_deref().map(|file| target(file, threads)).transpose()?;
    Ok(Wanted { surface, keeps_history: args.arrays.history.is_some(), ..words.wanted(criteria)? })
}

/// Reads a surface from which distances are measured.
///
/// # Errors
/// When it cannot be read, or is not a surface.
pub(crate) fn target(surface: &Path, threads: &Threads) -> motet::Result<Arc<Target>> {
    let mesh = io::read(surface)?;
    Target::of_mesh(&mesh, threads).map(Arc::new).map_err(|e| e.in_file(surface))
}

/// Replaces the remedy of an error about the memory by the option of the command line.
fn hint(error: Error) -> Error {
    let is_memory =
        error.what().contains("refinement does not fit") || error.what().contains("remembers how");
    if !is_memory {
        return error;
    }
    Error::new(error.kind(), error.what()).remedy("use --forget to take the current mesh as the first one")
}
