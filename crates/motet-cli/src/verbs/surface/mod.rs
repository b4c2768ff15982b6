//! `motet surface`: a surface gets even triangles within a distance.

mod args;
mod report;

use std::time::Instant;

use motet::io;
use motet::mesh::history::Changed;
use motet::meshing::even::even_surface;

pub(crate) use args::SurfaceArgs;

use self::report::Report;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;
use crate::table::seconds;

pub(crate) fn run(args: &SurfaceArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    outputs::check(&args.output, [args.input.as_path()], "the surface")?;
    let meter = console.meter("surface", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let (given, notes) = io::read_on(&args.input, &threads)?;
    notes.iter().for_each(|what| console.warn(what));
    let read = begin.elapsed().as_secs_f64();
    let in_file = |e: motet::Error| e.in_file(&args.input);
    let options = args.words().options(&given).map_err(in_file)?;
    let Changed { mesh, report, .. } = even_surface(&given, &options, &threads).map_err(in_file)?;
    meter.stage("writing");
    let writing = Instant::now();
    let lost = io::write_on(&args.output, &mesh, &args.writing.options(), &threads)?;
    let write = writing.elapsed().as_secs_f64();
    drop(meter);
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    lost.iter().for_each(|what| console.warn(what));
    let outcome = Outcome::of(report.not_reached());
    Report::new(args, &report, [read, write, begin.elapsed().as_secs_f64()]).print(&outcome, console);
    Ok(outcome)
}
