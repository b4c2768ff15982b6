//! `motet info`: what a mesh is, and what is wrong with it.

use std::path::PathBuf;

use clap::Args;

use crate::args::Common;
use crate::console::Console;
use crate::exit::Outcome;

/// Tell what a mesh holds, how good it is, and what is wrong with it
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The mesh file (or folder)
    mesh: PathBuf,
}

pub(crate) fn run(args: &InfoArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let _threads = common.threads()?;
    let mesh = motet::io::read(&args.mesh)?;
    console.say(mesh.points.len());
    Ok(Outcome::Done)
}
