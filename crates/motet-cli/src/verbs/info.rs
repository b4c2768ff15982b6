//! `motet info`: what a mesh is, and what is wrong with it.

use std::path::PathBuf;

use clap::Args;

use crate::args::Common;
use crate::console::Console;
use crate::exit::Outcome;
use crate::table::{Table, count, short};

/// Tell what a mesh holds, how good it is, and what is wrong with it
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The mesh file (or folder)
    mesh: PathBuf,
}

pub(crate) fn run(args: &InfoArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let _threads = common.threads()?;
    let mesh = motet::io::read(&args.mesh)?;
    let mut table = Table::new(["", "low", "high"]);
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        if let Some([low, high]) = mesh.bounds() {
            table.row([name.to_string(), short(low[axis]), short(high[axis])]);
        }
    }
    console.say(format_args!(
        "{} points, {} cells\n{table}",
        count(mesh.points.len()),
        count(mesh.cells.len())
    ));
    Ok(Outcome::Done)
}
