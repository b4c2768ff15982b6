//! Output for the user: results on standard output, everything else on standard error.

use std::borrow::Cow;
use std::cell::RefCell;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::rc::Rc;

use motet::Error;
use motet::base::{Simulation, printable};
use serde::Serialize;

use crate::common::Common;
use crate::outcome::Outcome;
use crate::progress::Meter;

/// Writes to the terminal, as verbosely as the call requests. A closed pipe is not a failure: the text is
/// dropped. Any other failure of standard output is kept until [`finish`](Console::finish) returns it.
pub(crate) struct Console {
    json: bool,
    quiet: bool,
    verbose: bool,
    failed: Rc<RefCell<Option<io::Error>>>,
}

/// A report with the reason why the requested result was not reached.
#[derive(Serialize)]
struct Concluded<'a, R: Serialize> {
    #[serde(flatten)]
    report: &'a R,
    not_reached: Option<&'a str>,
}

/// Keeps newlines and tabs and escapes all other control characters, so that file names cannot control the
/// terminal.
fn lines(text: &impl Display) -> String {
    let text = text.to_string();
    let kept = |c: char| matches!(c, '\n' | '\t');
    match text.contains(|c: char| c.is_control() && !kept(c)) {
        false => text,
        true => text.split_inclusive(kept).map(line).collect(),
    }
}

fn line(text: &str) -> Cow<'_, str> {
    match text.strip_suffix(['\n', '\t']) {
        Some(rest) => Cow::Owned(printable(rest).into_owned() + &text[rest.len()..]),
        None => printable(text),
    }
}

impl Console {
    pub(crate) fn new(common: &Common) -> Self {
        Self { quiet: common.quiet, verbose: common.verbose, ..Self::plain(common.json) }
    }

    /// A console for a call that could not be parsed.
    pub(crate) fn plain(json: bool) -> Self {
        Self { json, quiet: false, verbose: false, failed: Rc::default() }
    }

    /// This console without the JSON objects of single results, for a verb that prints one object for all of
    /// them at the end.
    pub(crate) fn without_reports(&self) -> Self {
        Self {
            quiet: self.quiet || self.json,
            verbose: self.verbose,
            failed: self.failed.clone(),
            ..Self::plain(false)
        }
    }

    /// Prints a result for people on standard output; nothing where JSON is requested.
    pub(crate) fn print(&self, text: impl Display) {
        if !self.json && !self.quiet {
            self.put(format!("{}\n", lines(&text)).as_bytes());
        }
    }

    /// Whether `--verbose` was given.
    pub(crate) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// Prints a result for programs, one JSON object on standard output, where requested.
    pub(crate) fn report(&self, report: &impl Serialize) {
        if self.json {
            // Serialize first: print the whole object or nothing.
            match serde_json::to_vec_pretty(report) {
                Ok(mut text) => {
                    text.push(b'\n');
                    self.put(&text);
                }
                Err(e) => self.record_failure(e.into()),
            }
        }
    }

    /// Prints the result of a verb that may reach less than was requested: one JSON object, with the reason
    /// as `not_reached`, `null` where everything was reached.
    pub(crate) fn conclude(&self, report: &impl Serialize, outcome: &Outcome) {
        self.report(&Concluded { report, not_reached: outcome.not_reached() });
    }

    /// Prints why the requested result was not reached, on standard error, even with `--quiet`: it explains
    /// the exit status.
    pub(crate) fn not_reached(&self, why: &str) {
        let _ = writeln!(io::stderr(), "not reached: {}; what was reached is written", lines(&why));
    }

    /// Prints the help text of the call on standard output.
    pub(crate) fn help(&self, help: &clap::Error) {
        if let Err(e) = help.print() {
            self.record_failure(e);
        }
    }

    /// Writes bytes to standard output.
    pub(crate) fn put(&self, bytes: &[u8]) {
        if let Err(e) = io::stdout().write_all(bytes) {
            self.record_failure(e);
        }
    }

    fn record_failure(&self, error: io::Error) {
        self.failed.borrow_mut().get_or_insert(error);
    }

    /// Flushes standard output.
    ///
    /// # Errors
    /// The first failure of standard output, unless a reader has closed it.
    pub(crate) fn finish(&self) -> motet::Result<()> {
        if let Err(e) = io::stdout().flush() {
            self.record_failure(e);
        }
        match self.failed.take().filter(|e| e.kind() != ErrorKind::BrokenPipe) {
            None => Ok(()),
            Some(e) => Err(Error::output("standard output", e)),
        }
    }

    /// Prints a warning on standard error.
    pub(crate) fn warn(&self, text: impl Display) {
        if !self.quiet {
            let _ = writeln!(io::stderr(), "warning: {}", lines(&text));
        }
    }

    /// Prints details on standard error with `--verbose`.
    pub(crate) fn detail(&self, text: impl Display) {
        if self.verbose {
            let _ = writeln!(io::stderr(), "{}", lines(&text));
        }
    }

    /// Prints what simulated threads would have saved, on standard error, even with `--quiet`.
    pub(crate) fn saved_by(&self, simulation: &Simulation) {
        let (n, saved) = (simulation.count(), simulation.saved().as_secs_f64());
        let _ = writeln!(io::stderr(), "simulated threads: {n}; saved: {saved:.3} s");
    }

    /// Prints an error on standard error.
    pub(crate) fn error(&self, text: impl Display) {
        let _ = writeln!(io::stderr(), "error: {}", lines(&text));
    }

    /// A progress line on standard error; invisible where that is no terminal. `steps`: the number of equal
    /// steps that the verb makes.
    pub(crate) fn meter(&self, verb: &'static str, steps: Option<usize>) -> Meter {
        Meter::new(verb, steps, self.quiet)
    }
}
