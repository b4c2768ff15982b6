//! Exit statuses of outcomes and errors: the contract that scripts rely on.

use motet::{Error, ErrorKind};
use serde_json::json;

use crate::console::Console;
use crate::outcome::Outcome;
use crate::words::shown;

const DONE: u8 = 0;
const ELSE: u8 = 1;
const WORDS: u8 = 2;
const INPUT: u8 = 3;
const NOT_REACHED: u8 = 4;

fn of_kind(kind: ErrorKind) -> u8 {
    match kind {
        ErrorKind::Options => WORDS,
        ErrorKind::Input | ErrorKind::Io => INPUT,
        _ => ELSE,
    }
}

/// The exit status of a verb that ran. Prints the reason or the error first.
pub(crate) fn status(outcome: motet::Result<Outcome>, console: &Console) -> u8 {
    let code = match outcome {
        Ok(Outcome::Done) => DONE,
        Ok(Outcome::NotReached(why)) => {
            console.not_reached(&why);
            NOT_REACHED
        }
        Err(error) => {
            let code = of_kind(error.kind());
            console.report(&json!({ "error": described(&error, code) }));
            console.error(&error);
            code
        }
    };
    match console.finish() {
        Ok(()) => code,
        Err(error) => {
            console.error(&error);
            if code == DONE { ELSE } else { code }
        }
    }
}

fn described(error: &Error, code: u8) -> serde_json::Value {
    json!({
        "exit": code,
        "file": error.file().map(shown),
        "place": error.place(),
        "what": error.what(),
        "remedy": error.remedy_text(),
        "message": error.to_string(),
    })
}

/// The exit status of a call that could not be parsed, or that only requested help.
pub(crate) fn misread(misread: &clap::Error, json: bool) -> u8 {
    let code = u8::try_from(misread.exit_code()).unwrap_or(ELSE);
    let console = Console::plain(json);
    if code == DONE {
        // Help and versions are for people, even where JSON is requested.
        console.help(misread);
    } else {
        let what = misread.to_string();
        let what = what.trim_start_matches("error: ").trim_end();
        console.report(&json!({ "error": { "exit": code, "what": what, "message": what } }));
        console.error(what);
    }
    match console.finish() {
        Err(error) if code == DONE => {
            console.error(&error);
            ELSE
        }
        _ => code,
    }
}
