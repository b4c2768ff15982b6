//! `motet demo`: the whole story on a built-in mesh.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, Parser as _};
use motet::Error;
use motet::io::{self, WriteOptions};
use motet::mesh::shapes::sphere_in_box;

use crate::args::{Call, Common, Verb};
use crate::console::Console;
use crate::exit::Outcome;
use crate::table::{count, seconds};
use crate::verbs::moving;

/// See it work: a sphere in a box moves to near a wall
///
/// Builds the mesh (32 000 vertices), moves the sphere in ten steps, writes a
/// series that ParaView plays, and tells what happened. Takes seconds.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Where the files go
    #[arg(value_name = "DIR", default_value = "motet-demo")]
    folder: PathBuf,
}

/// Quads along a face of the sphere's shells, and layers of cells from sphere to
/// box: as many vertices as the second of the paper's four sizes has, spread so that the
/// cells are about as tall as wide.
const SIZE: (usize, usize) = (16, 20);

/// The sphere has radius 1 and the walls are 5 from its centre: this leaves a gap of
/// one radius.
const SHIFT: &str = "sphere=3,0,0";

pub(crate) fn run(args: &DemoArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    std::fs::create_dir_all(&args.folder).map_err(|e| Error::io(&args.folder, &e))?;
    let (mesh_file, series) = (args.folder.join("box.vtu"), args.folder.join("moved.pvd"));
    let begin = Instant::now();
    let mesh = sphere_in_box(SIZE.0, SIZE.1);
    let built = begin.elapsed().as_secs_f64();
    io::write(&mesh_file, &mesh, &WriteOptions::default())?;
    console.say(format_args!(
        "A sphere of radius 1 in a box of edge 10: {} vertices, {} tets, built in {}.",
        count(mesh.points.len()),
        count(mesh.cells.tets().count()),
        seconds(built)
    ));
    // The demo is the very call that a user would make.
    let mut call: Vec<&OsStr> = vec!["motet".as_ref(), "move".as_ref(), mesh_file.as_ref(), "-o".as_ref()];
    call.push(series.as_ref());
    call.extend(["--translate", SHIFT, "--steps", "10", "--quality"].map(OsStr::new));
    let told: Vec<_> = call.iter().map(|word| word.to_string_lossy()).collect();
    console.say(format_args!("\n$ {}", told.join(" ")));
    let outcome = match Call::try_parse_from(&call).map(|call| call.verb) {
        Ok(Verb::Move(moving)) => moving::run(&moving, common, console)?,
        _ => {
            return Err(
                Error::options("this name of a folder cannot be part of a call").in_file(&args.folder)
            );
        }
    };
    console.say(format_args!(
        "\nSee it move:\n  \
         paraview {0}        (Apply, colour by eas, slice across y, play)\n  \
         python -c \"import pyvista as pv; m = pv.read('{1}'); m.clip('y').plot(scalars='eas', show_edges=True)\"\n\
         Look closer:\n  motet info {1}\n  motet help move",
        series.display(),
        args.folder.join("moved_0010.vtu").display()
    ));
    Ok(outcome)
}
