//! How the user is spoken to: results on standard output, all else on standard error.

use std::fmt::Display;
use std::io::Write as _;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::args::Common;

/// Where words go, and how many. A closed pipe is no failure: the words are dropped.
pub(crate) struct Console {
    json: bool,
    quiet: bool,
    verbose: bool,
}

impl Console {
    pub(crate) fn new(common: &Common) -> Self {
        Self { json: common.json, quiet: common.quiet, verbose: common.verbose }
    }

    /// The same, but for the objects of single results: where one object at the end stands for all.
    pub(crate) fn without_reports(&self) -> Self {
        Self { json: false, quiet: self.quiet || self.json, verbose: self.verbose }
    }

    /// The result for people, on standard output; nothing where JSON is asked for.
    pub(crate) fn say(&self, text: impl Display) {
        if !self.json && !self.quiet {
            let _ = writeln!(std::io::stdout(), "{text}");
        }
    }

    /// Whether the user wants to know everything.
    pub(crate) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// The result for programs: one JSON object on standard output, where asked for.
    pub(crate) fn report(&self, report: &impl Serialize) {
        if self.json {
            let mut out = std::io::stdout().lock();
            let _ = serde_json::to_writer_pretty(&mut out, report);
            let _ = writeln!(out);
        }
    }

    /// What the user should know, on standard error.
    pub(crate) fn warn(&self, text: impl Display) {
        if !self.quiet {
            let _ = writeln!(std::io::stderr(), "warning: {text}");
        }
    }

    /// What only a curious user wants to know, on standard error.
    pub(crate) fn detail(&self, text: impl Display) {
        if self.verbose {
            let _ = writeln!(std::io::stderr(), "{text}");
        }
    }

    /// What went wrong, on standard error.
    pub(crate) fn error(&self, text: impl Display) {
        let _ = writeln!(std::io::stderr(), "error: {text}");
    }

    /// A bar of `steps` steps on standard error; invisible where that is no terminal.
    pub(crate) fn bar(&self, steps: u64, what: &'static str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}  {eta} left");
        let bar = ProgressBar::new(steps).with_message(what);
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
