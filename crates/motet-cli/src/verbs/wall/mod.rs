//! `motet wall`: a solid wall around a vessel.

mod args;
mod report;

use std::time::Instant;

use motet::io;
use motet::mesh::history::Changed;
use motet::meshing::wall::wall;

pub(crate) use args::WallArgs;

use self::report::Report;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::outputs;
use crate::table::seconds;

pub(crate) fn run(args: &WallArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    outputs::check(&args.output, [args.input.as_path()], "the vessel")?;
    let meter = console.meter("wall", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let (given, notes) = io::read_on(&args.input, &threads)?;
    notes.iter().for_each(|what| console.warn(what));
    let read = begin.elapsed().as_secs_f64();
    let in_file = |e: motet::Error| e.in_file(&args.input);
    let options = args.words().options(&given).map_err(in_file)?;
    let Changed { mesh, report, .. } = wall(&given, &options, &threads).map_err(in_file)?;
    meter.stage("writing");
    let writing = Instant::now();
    let lost = io::write_on(&args.output, &mesh, &args.writing.options(), &threads)?;
    let write = writing.elapsed().as_secs_f64();
    drop(meter);
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    lost.iter().for_each(|what| console.warn(what));
    let outcome = Outcome::of(report.not_reached());
    let seconds = Seconds { read, write, total: begin.elapsed().as_secs_f64() };
    Report::new(args, &report, seconds).print(&outcome, console);
    Ok(outcome)
}
