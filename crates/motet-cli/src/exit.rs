//! Exit statuses of outcomes and errors: the contract that scripts rely on.

use motet::{Error, ErrorKind};
use serde_json::json;

use crate::console::Console;
use crate::outcome::Outcome;
use crate::words::shown;

const DONE: u8 = 0;
const OTHER_ERROR: u8 = 1;
const USAGE_ERROR: u8 = 2;
const INPUT_ERROR: u8 = 3;
const NOT_REACHED: u8 = 4;

fn exit_code(kind: ErrorKind) -> u8 {
    match kind {
        ErrorKind::Options => USAGE_ERROR,
        ErrorKind::Input | ErrorKind::Io => INPUT_ERROR,
        _ => OTHER_ERROR,
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
            let code = exit_code(error.kind());
            console.report(&json!({ "error": described(&error, code) }));
            console.error(&error);
            code
        }
    };
    match console.finish() {
        Ok(()) => code,
        Err(error) => {
            console.error(&error);
            if code == DONE { OTHER_ERROR } else { code }
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
pub(crate) fn parse_failure_status(misread: &clap::Error, json: bool) -> u8 {
    let code = u8::try_from(misread.exit_code()).unwrap_or(OTHER_ERROR);
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
            OTHER_ERROR
        }
        _ => code,
    }
}
