//! The command line of motet: words in, calls of the library, words out.
//!
//! It holds no algorithm. One file a verb lies in `verbs/`; what they share is
//! here: how the call is read (`args`, `words`), how the user is spoken to (`console`,
//! `progress`, `table`), how failures become exit statuses (`exit`), what outputs are refused
//! (`outputs`), what becomes of arrays (`arrays`).

mod args;
mod arrays;
mod console;
mod exit;
mod outputs;
mod progress;
mod quality;
mod table;
mod verbs;
mod words;

use std::ffi::OsString;

use clap::Parser as _;

use crate::args::{Call, Verb};
use crate::console::Console;

/// Runs the command line with these words, the name of the program first; the exit status.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let call = match Call::try_parse_from(&words) {
        Ok(call) => call,
        Err(misread) => return exit::misread(&misread, words.iter().any(|word| word == "--json")),
    };
    let console = Console::new(&call.common);
    let outcome = match call.verb {
        Verb::Info(args) => verbs::info::run(&args, &console),
        Verb::Convert(args) => verbs::convert::run(&args, &console),
        Verb::Cap(args) => verbs::cap::run(&args, &console),
        Verb::Mesh(args) => verbs::meshing::run(&args, &call.common, &console),
        Verb::Move(args) => verbs::moving::run(&args, &call.common, &console),
        Verb::Remesh(args) => verbs::remesh::run(&args, &call.common, &console),
        Verb::Refine(args) => verbs::refine::run(&args, &call.common, &console),
        Verb::Implant(args) => verbs::implant::run(&args, &call.common, &console),
        Verb::Contact(args) => verbs::contact::run(&args, &call.common, &console),
        Verb::Run(args) => verbs::run::run(&args, &call.common, &console),
        Verb::Report(args) => verbs::report::run(&args, &console),
        Verb::Demo(args) => verbs::demo::run(&args, &call.common, &console),
    };
    exit::status(outcome, &console)
}
