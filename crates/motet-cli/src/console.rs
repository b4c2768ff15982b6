//! How the user is spoken to: results on standard output, all else on standard error.

use std::borrow::Cow;
use std::cell::RefCell;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::rc::Rc;

use motet::Error;
use motet::base::printable;
use serde::Serialize;

use crate::args::Common;
use crate::exit::Outcome;
use crate::progress::Meter;

/// Where words go, and how many. A closed pipe is no failure: the words are dropped. Any other failure of standard output
/// is kept until [`finish`](Console::finish) tells it.
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

/// Lines as they are, all other control characters as escapes: names of files reach the terminal as names.
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

    /// One for a call that could not be read.
    pub(crate) fn plain(json: bool) -> Self {
        Self { json, quiet: false, verbose: false, failed: Rc::default() }
    }

    /// The same, but for the objects of single results: where one object at the end stands for all.
    pub(crate) fn without_reports(&self) -> Self {
        Self {
            quiet: self.quiet || self.json,
            verbose: self.verbose,
            failed: self.failed.clone(),
            ..Self::plain(false)
        }
    }

    /// The result for people, on standard output; nothing where JSON is asked for.
    pub(crate) fn say(&self, text: impl Display) {
        if !self.json && !self.quiet {
            self.put(format!("{}\n", lines(&text)).as_bytes());
        }
    }

    /// Whether the user wants to know everything.
    pub(crate) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// The result for programs: one JSON object on standard output, where asked for.
    pub(crate) fn report(&self, report: &impl Serialize) {
        if self.json {
            // The whole object, or nothing of it.
            match serde_json::to_vec_pretty(report) {
                Ok(mut text) => {
                    text.push(b'\n');
                    self.put(&text);
                }
                Err(e) => self.keep(e.into()),
            }
        }
    }

    /// The result of a verb that can reach less than was requested: one JSON object, with the reason as `not_reached`, `null` where all was reached.
    pub(crate) fn conclude(&self, report: &impl Serialize, outcome: &Outcome) {
        self.report(&Concluded { report, not_reached: outcome.not_reached() });
    }

    /// Why the requested result was not reached, on standard error, also where little is said: it explains the exit status.
    pub(crate) fn not_reached(&self, why: &str) {
        let _ = writeln!(io::stderr(), "not reached: {}; what was reached is written", lines(&why));
    }

    /// What the call's own description says, on standard output.
    pub(crate) fn help(&self, help: &clap::Error) {
        if let Err(e) = help.print() {
            self.keep(e);
        }
    }

    fn put(&self, bytes: &[u8]) {
        if let Err(e) = io::stdout().write_all(bytes) {
            self.keep(e);
        }
    }

    fn keep(&self, error: io::Error) {
        self.failed.borrow_mut().get_or_insert(error);
    }

    /// Hands on what still waits for standard output.
    ///
    /// # Errors
    /// The first failure of standard output, unless a reader has closed it.
    pub(crate) fn finish(&self) -> motet::Result<()> {
        if let Err(e) = io::stdout().flush() {
            self.keep(e);
        }
        match self.failed.take().filter(|e| e.kind() != ErrorKind::BrokenPipe) {
            None => Ok(()),
            Some(e) => Err(Error::output("standard output", e)),
        }
    }

    /// What the user should know, on standard error.
    pub(crate) fn warn(&self, text: impl Display) {
        if !self.quiet {
            let _ = writeln!(io::stderr(), "warning: {}", lines(&text));
        }
    }

    /// What only a curious user wants to know, on standard error.
    pub(crate) fn detail(&self, text: impl Display) {
        if self.verbose {
            let _ = writeln!(io::stderr(), "{}", lines(&text));
        }
    }

    /// What went wrong, on standard error.
    pub(crate) fn error(&self, text: impl Display) {
        let _ = writeln!(io::stderr(), "error: {}", lines(&text));
    }

    /// A line on standard error that follows the work; invisible where that is no terminal. `steps`: how many equal ones the verb makes.
    pub(crate) fn meter(&self, verb: &'static str, steps: Option<usize>) -> Meter {
        Meter::new(verb, steps, self.quiet)
    }
}
