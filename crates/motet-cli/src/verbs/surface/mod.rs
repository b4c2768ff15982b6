//! `motet surface`: a surface gets even triangles within a distance.

mod args;
mod report;
mod shape;

use std::path::PathBuf;
use std::time::Instant;

use motet::Mesh;
use motet::base::Threads;
use motet::io;
use motet::mesh::history::Changed;
use motet::meshing::even::even_surface;
use motet::meshing::tubes::even_tubes;

pub(crate) use args::SurfaceArgs;

use self::report::Report;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::outputs;
use crate::table::seconds;

pub(crate) fn run(args: &SurfaceArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    let inputs = args.input.iter().chain(&args.segments).map(PathBuf::as_path);
    outputs::check(&args.output, inputs, "the surface")?;
    let meter = console.meter("surface", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let given = read(args, console, &threads)?;
    let seconds_read = begin.elapsed().as_secs_f64();
    let in_file = |e: motet::Error| match &args.input {
        Some(input) => e.in_file(input),
        None => e,
    };
    let words = args.words();
    let wires = args.tube_words().options(words.repair).map_err(in_file)?;
    let (mesh, report, wires) = match wires {
        None => {
            let options = words.options(&given).map_err(in_file)?;
            let Changed { mesh, report, .. } = even_surface(&given, &options, &threads).map_err(in_file)?;
            (mesh, report, None)
        }
        Some(wires) => {
            let made = even_tubes(&given, &wires, &words, &threads).map_err(in_file)?;
            (made.mesh, made.report.surface, Some(made.report.wires))
        }
    };
    wires.iter().flat_map(|wires| wires.notes()).for_each(|what| console.warn(&what));
    meter.stage("writing");
    let writing = Instant::now();
    let lost = io::write_on(&args.output, &mesh, &args.writing.options(), &threads)?;
    let write = writing.elapsed().as_secs_f64();
    drop(meter);
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    lost.iter().for_each(|what| console.warn(what));
    let outcome = Outcome::of(report.not_reached());
    let seconds = Seconds { read: seconds_read, write, total: begin.elapsed().as_secs_f64() };
    Report::new(args, &report, wires.as_ref(), seconds).print(&outcome, console);
    Ok(outcome)
}

/// The surface or the lines that the arguments name.
fn read(args: &SurfaceArgs, console: &Console, threads: &Threads) -> motet::Result<Mesh> {
    match (&args.stent, &args.coil, &args.input, &args.segments) {
        (Some(stent), ..) => stent.lines(),
        (_, Some(coil), ..) => coil.lines(),
        (_, _, Some(positions), Some(segments)) => io::read_segments(positions, segments),
        (_, _, Some(input), None) => {
            let (given, notes) = io::read_on(input, threads)?;
            notes.iter().for_each(|what| console.warn(what));
            Ok(given)
        }
        (None, None, None, _) => Err(motet::Error::options("there is no input").remedy("name a mesh file")),
    }
}
