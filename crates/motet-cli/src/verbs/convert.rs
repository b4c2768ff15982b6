//! `motet convert`: reads one format and writes another.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use motet::base::Threads;
use motet::io;
use serde_json::json;

use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::table::{count, seconds};
use crate::words::shown;
use crate::writing::WritingArgs;

/// Convert a mesh file to another format, given by its extension
///
/// Points, cells of every kind and all arrays are kept, bit for bit, where the
/// format can hold them; what it cannot hold is listed.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  motet convert vessel.msh vessel.vtu                     for ParaView
  motet convert mesh-complete/ vessel.vtu                 a SimVascular folder, faces as patches
  motet convert vessel.msh mesh-complete/                 and back
  motet convert vessel.vtu case/constant/polyMesh         an OpenFOAM case
  motet convert case vessel.vtu                           and back
  motet convert vessel.vtu vessel.msh --version 2.2       for old readers
  motet convert flow.pvd flow.vtkhdf                      a series, in either direction
  motet convert a.vtu b.vtu --encoding ascii --compression none")]
pub(crate) struct ConvertArgs {
    /// The file (or folder) to read
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write, or a new folder, with a slash at its end
    #[arg(value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Converts a series into a series of another format.
fn series(args: &ConvertArgs, threads: &Threads, console: &Console) -> motet::Result<Outcome> {
    let frames = io::read_series(&args.input)?;
    let meter = console.meter("converting", Some(frames.len()));
    let read = frames.iter().map(|(time, file)| {
        meter.step();
        Ok((*time, io::read_on(file, threads)?.0))
    });
    let lost = io::write_series(&args.output, read, &args.writing.options(), threads)?;
    drop(meter);
    lost.iter().for_each(|what| console.warn(what));
    let n = frames.len();
    console.print(format_args!("{} -> {}: {n} meshes", args.input.display(), args.output.display()));
    console.report(
        &json!({ "input": shown(&args.input), "output": shown(&args.output), "meshes": n, "lost": lost }),
    );
    Ok(Outcome::Done)
}

pub(crate) fn run(args: &ConvertArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let threads = common.threads()?;
    if io::is_series(&args.input) && io::can_be_series(&args.output) {
        return series(args, &threads, console);
    }
    io::can_write(&args.output)?;
    let start = Instant::now();
    let (mesh, notes) = io::read_on(&args.input, &threads)?;
    let read = start.elapsed().as_secs_f64();
    console.detail(format_args!("read {} in {}", args.input.display(), seconds(read)));
    let lost = io::write_on(&args.output, &mesh, &args.writing.options(), &threads)?;
    let write = start.elapsed().as_secs_f64() - read;
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));

    notes.iter().chain(&lost).for_each(|what| console.warn(what));
    console.print(format_args!(
        "{} -> {}: {} points, {} cells, {} point and {} cell arrays",
        args.input.display(),
        args.output.display(),
        count(mesh.points.len()),
        count(mesh.cells.len()),
        mesh.point_data.len(),
        mesh.cell_data.len()
    ));
    console.report(&json!({
        "input": shown(&args.input),
        "output": shown(&args.output),
        "points": mesh.points.len(),
        "cells": mesh.cells.len(),
        "point_arrays": mesh.point_data.iter().map(|f| &f.name).collect::<Vec<_>>(),
        "cell_arrays": mesh.cell_data.iter().map(|f| &f.name).collect::<Vec<_>>(),
        "passed_over": notes,
        "lost": lost,
        "seconds": { "read": read, "write": write },
    }));
    Ok(Outcome::Done)
}
