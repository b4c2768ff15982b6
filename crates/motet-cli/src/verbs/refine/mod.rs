//! `motet refine`: divides tets where it matters, and takes divisions back where it does not.

mod args;
mod criteria;
pub(crate) mod parsers;
mod report;

use std::time::Instant;

use motet::refine::{MeshRefinement, Options, fix_sizes};
use motet::{Error, io};

pub(crate) use args::RefineArgs;
pub(crate) use criteria::target;

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
    let mut criteria = criteria::criteria(args, &threads)?;
    let surface = args.surface.as_deref().map(|file| criteria::target(file, &threads)).transpose()?;
    let (old, notes) = io::read_noted(&args.mesh)?;
    let rules = args.arrays.rules(&old).map_err(|e| e.in_file(&args.mesh))?;
    let mut given = if args.forget { MeshRefinement::forget(&old) } else { old };
    let sizes = fix_sizes(&mut criteria, &mut given, &threads).map_err(|e| e.in_file(&args.mesh))?;
    let mut refinement =
        MeshRefinement::new(&given, Options::default(), &threads).map_err(|e| hint(e).in_file(&args.mesh))?;
    let read = begin.elapsed().as_secs_f64();

    let wanted = args.wanted(criteria, surface);
    let done = refinement.reach(&wanted, &rules, &threads, |_| ());
    let done = done.map_err(|e| e.in_file(&args.mesh))?;
    meter.stage("writing");
    let mut mesh = refinement.with_memory(&threads);
    mesh.point_data.retain(|field| !sizes.contains(&field.name));
    let Written { lost, seconds: write } =
        args.arrays.write(&mut mesh, done.history.as_ref(), &args.output, &args.writing)?;
    drop(meter);
    console.detail(format_args!("read {} in {}", args.mesh.display(), seconds(read)));
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    notes.iter().chain(&lost).for_each(|what| console.warn(what));
    let outcome = Outcome::of(done.not_reached());
    Report::new(args, &refinement, done, [read, write, begin.elapsed().as_secs_f64()], &threads)
        .print(&outcome, console);
    Ok(outcome)
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
