//! `motet view`: a mesh in a window of the browser, in which its parts are dragged.

use std::path::PathBuf;

use clap::Args;
use motet::io;
use motet_view::{Scene, Server};
use serde::Serialize;

use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;

/// Show a mesh in the browser, and drag its parts: the mesh follows
///
/// A coil, a stent or any other patch is dragged with the mouse. While it moves, so does the mesh, with the
/// worst tets in red; when it is released, bad tets are repaired. Steps can be undone; the mesh and the page
/// can be saved from the browser. Colour by `gap` to see what comes near. Only this machine can reach the
/// page, under an address that contains a random word. Ctrl-C ends the program.
#[derive(Debug, Args)]
#[command(after_help = "\
Parts that share no vertex with another one, such as a coil in a vessel, are dragged where they \
are; other patches, such as an inlet, are chosen in the list first. Over a remote shell, forward \
the port, and give it: --port 8000 --no-browser.

Examples:
  motet view vessel_with_coil.vtu
  motet view mesh.msh --port 8000 --no-browser")]
pub(crate) struct ViewArgs {
    /// The mesh, in any format that motet reads
    mesh: PathBuf,
    /// The port of this machine to listen on; 0 = any free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Print the address only, and open no browser
    #[arg(long)]
    no_browser: bool,
}

#[derive(Serialize)]
struct Report {
    address: String,
}

pub(crate) fn run(args: &ViewArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let threads = common.threads()?;
    let (mesh, notes) = io::read_on(&args.mesh, &threads)?;
    notes.iter().for_each(|note| console.warn(format_args!("{}: {note}", args.mesh.display())));
    let name = args.mesh.file_name().unwrap_or(args.mesh.as_os_str()).to_string_lossy().into_owned();
    let server = Server::new(Scene::new(mesh, &name, threads)?, args.port)?;
    let address = server.address();
    console.print(&address);
    console.report(&Report { address: address.clone() });
    // Whoever reads the address waits for it.
    console.finish()?;
    if !args.no_browser
        && let Err(e) = open::that_detached(&address)
    {
        console.warn(format_args!("no browser can be opened: {e}; open {address} in one"));
    }
    server.serve();
    Ok(Outcome::Done)
}
