//! The command line of motet: arguments in, calls of the library, text or JSON out.
//!
//! It holds no algorithm. Each verb has its file in `verbs/`; what they share is here: parsing of the call
//! (`args`, `words`, `help`, `adapting`), output for the user (`console`, `progress`, `table`), exit statuses
//! (`exit`), checks of output paths (`outputs`), and how arrays are carried (`arrays`).

mod adapting;
mod args;
mod arrays;
mod common;
mod console;
mod exit;
mod help;
mod outcome;
mod outputs;
mod progress;
mod quality;
mod table;
mod verbs;
mod words;
mod writing;

use std::ffi::OsString;

use clap::{CommandFactory as _, Parser as _};

use crate::args::{Call, Verb};
use crate::console::Console;

/// Runs the command line with these arguments, the name of the program first, and returns the exit status.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let call = match Call::try_parse_from(&words) {
        Ok(call) => call,
        Err(misread) => {
            return exit::parse_failure_status(&misread, words.iter().any(|word| word == "--json"));
        }
    };
    let console = Console::new(&call.common);
    let outcome = match call.verb {
        Verb::Info(args) => verbs::info::run(&args, &call.common, &console),
        Verb::Quality(args) => verbs::quality::run(&args, &call.common, &console),
        Verb::Convert(args) => verbs::convert::run(&args, &call.common, &console),
        Verb::Cap(args) => verbs::cap::run(&args, &call.common, &console),
        Verb::Surface(args) => verbs::surface::run(&args, &call.common, &console),
        Verb::Mesh(args) => verbs::meshing::run(&args, &call.common, &console),
        Verb::Wall(args) => verbs::wall::run(&args, &call.common, &console),
        Verb::Move(args) => verbs::moving::run(&args, &call.common, &console),
        Verb::Remesh(args) => verbs::remesh::run(&args, &call.common, &console),
        Verb::Refine(args) => verbs::refine::run(&args, &call.common, &console),
        Verb::Implant(args) => verbs::implant::run(&args, &call.common, &console),
        Verb::Contact(args) => verbs::contact::run(&args, &call.common, &console),
        Verb::Run(args) => verbs::run::run(&args, &call.common, &console),
        Verb::Report(args) => verbs::report::run(&args, &console),
        Verb::View(args) => verbs::view::run(&args, &call.common, &console),
        Verb::Demo(args) => verbs::demo::run(&args, &call.common, &console),
        Verb::Completions(args) => verbs::shell::complete(&args, Call::command(), &console),
        Verb::Man(args) => verbs::shell::man(&args, Call::command(), &console),
    };
    if let Some(simulation) = call.common.simulation() {
        console.saved_by(simulation);
    }
    exit::status(outcome, &console)
}
