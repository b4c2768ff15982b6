//! `motet remesh`: finds and repairs bad tets, and leaves everything else unchanged.

mod args;
mod report;

use std::time::Instant;

use motet::io;
use motet::mesh::history::{Changed, field_ledger};
use motet::remesh::{has_only_labels, remesh_labelled, remesh_mesh};

pub(crate) use args::{RemeshArgs, eas};

use self::report::Report;
use crate::arrays::Written;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;
use crate::table::seconds;

pub(crate) fn run(args: &RemeshArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    let words = args.words();
    words.check()?;
    outputs::check_with_history(&args.output, &args.mesh, args.arrays.history.as_deref())?;
    let meter = console.meter("remeshing", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let (old, notes) = io::read_on(&args.mesh, &threads)?;
    let read = begin.elapsed().as_secs_f64();
    let rules = args.arrays.rules(&old).map_err(|e| e.in_file(&args.mesh))?;
    let options = words.options(&old).map_err(|e| e.in_file(&args.mesh))?;
    let outcome = match args.arrays.history.is_none() && has_only_labels(&old) {
        true => remesh_labelled(&old, &options, &threads).map(|(mesh, report)| (mesh, None, report)),
        false => remesh_mesh(&old, &options, &rules, &threads)
            .map(|Changed { mesh, history, report, .. }| (mesh, Some(history), report)),
    };
    let (mut mesh, history, report) = outcome.map_err(|e| e.in_file(&args.mesh))?;
    meter.stage("writing");
    let begin_fields = Instant::now();
    let fields = field_ledger(&old, &mesh, &rules, &threads);
    let on_fields = begin_fields.elapsed().as_secs_f64();
    let Written { lost, seconds: write } =
        args.arrays.write(&mut mesh, history.as_ref(), &args.output, &args.writing, &threads)?;
    drop(meter);

    console.detail(format_args!("read {} in {}", args.mesh.display(), seconds(read)));
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    notes.iter().chain(&lost).for_each(|what| console.warn(what));
    if mesh.is_turned() {
        console.warn(format_args!(
            "{}: most tets are numbered with the opposite orientation, and stay so; other programs may call \
             them inverted",
            args.mesh.display()
        ));
    }
    let mut summary = Report::new(args, [&old, &mesh], &threads, &report, history.as_ref(), fields);
    summary.end([read, on_fields, write, begin.elapsed().as_secs_f64()], notes, lost);
    let outcome = Outcome::of(summary.not_reached(&report));
    summary.print(&outcome, console);
    Ok(outcome)
}
