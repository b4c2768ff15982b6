//! Progress of a verb on a terminal: the stage, how much of it is done where known, and the time it still
//! takes.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use motet::base::{Progress, Watch};

/// How often the line is redrawn.
const REDRAW_INTERVAL: Duration = Duration::from_millis(200);
/// No estimate before this: the first parts of a stage say little about the others.
const MIN_ESTIMATE_AGE: Duration = Duration::from_secs(1);

/// A progress line on standard error, drawn by a thread of its own until dropped. Where standard error is no
/// terminal, there is neither line nor thread.
pub(crate) struct Meter {
    bar: ProgressBar,
    watch: Watch,
    follower: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Meter {
    /// The progress line of a verb that makes `steps` equal steps, such as frames, or has no such steps
    /// (`None`).
    pub(crate) fn new(verb: &'static str, steps: Option<usize>, is_hidden: bool) -> Self {
        let bar = if is_hidden { ProgressBar::hidden() } else { ProgressBar::no_length() };
        if bar.is_hidden() {
            return Self { bar, watch: Watch::default(), follower: None };
        }
        let watch = Watch::new();
        let (done, is_done) = channel();
        let line = Line { bar: bar.clone(), watch: watch.clone(), verb, steps };
        let follower = Some((done, thread::spawn(move || line.follow(&is_done))));
        Self { bar, watch, follower }
    }

    /// The handle through which the library reports its progress.
    pub(crate) fn watch(&self) -> &Watch {
        &self.watch
    }

    /// Begins a stage of the verb itself, such as reading a file.
    pub(crate) fn stage(&self, name: &'static str) {
        self.watch.report(name, 0, 0);
    }

    /// Counts one more step as done.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }

    /// Calls `call` with the line hidden, for instance to print.
    pub(crate) fn suspend<T>(&self, call: impl FnOnce() -> T) -> T {
        self.bar.suspend(call)
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        if let Some((done, follower)) = self.follower.take() {
            drop(done);
            // The thread only draws; its result does not matter.
            let _ = follower.join();
        }
        self.bar.finish_and_clear();
    }
}

/// The state of the thread that draws the line.
struct Line {
    bar: ProgressBar,
    watch: Watch,
    verb: &'static str,
    steps: Option<usize>,
}

impl Line {
    fn follow(&self, is_done: &Receiver<()>) {
        let begin = Instant::now();
        let mut stage = Activity::default();
        let mut steps = self.steps.map(|of| Activity::new(Progress { stage: self.verb, done: 0, of }));
        // A line of 80 columns has room for the longest stage.
        let styles = ["{bar:12} {wide_msg}", "{spinner} {wide_msg}"]
            .map(|text| ProgressStyle::with_template(text).unwrap_or_else(|_| ProgressStyle::default_bar()));
        while is_done.recv_timeout(REDRAW_INTERVAL) == Err(RecvTimeoutError::Timeout) {
            let at = begin.elapsed();
            stage.take(self.watch.progress(), at);
            let (text, of) = match &mut steps {
                Some(steps) => {
                    let done = usize::try_from(self.bar.position()).unwrap_or(usize::MAX);
                    steps.take(Progress { done, ..steps.now }, at);
                    let within = Some(stage.part()).filter(|part| !part.is_empty());
                    let text = steps.text(at) + &within.map_or_else(String::new, |part| format!("; {part}"));
                    (text, steps.now.of)
                }
                None => {
                    self.bar.set_position(stage.now.done as u64);
                    (format!("{}: {}", self.verb, stage.text(at)), stage.now.of)
                }
            };
            self.bar.set_length(of as u64);
            self.bar.set_style(styles[usize::from(of == 0)].clone());
            self.bar.set_message(text);
            self.bar.tick();
        }
    }
}

/// One activity and when it began.
#[derive(Default)]
struct Activity {
    now: Progress,
    /// How much was done when it began, and the time then.
    first: usize,
    began: Duration,
}

impl Activity {
    fn new(now: Progress) -> Self {
        Self { now, ..Self::default() }
    }

    /// Takes the progress at time `at`. A stage that starts over begins anew.
    fn take(&mut self, now: Progress, at: Duration) {
        if now.stage != self.now.stage || now.done < self.now.done {
            (self.first, self.began) = (now.done, at);
        }
        self.now = now;
    }

    /// How long the rest takes at the speed so far; `None` where the amount is unknown or it is too early to
    /// say.
    fn remaining(&self, at: Duration) -> Option<Duration> {
        let took = at.saturating_sub(self.began);
        let (made, rest) = (self.now.done - self.first, self.now.of.saturating_sub(self.now.done));
        let is_known = made > 0 && rest > 0 && took >= MIN_ESTIMATE_AGE;
        is_known.then(|| took.mul_f64(rest as f64 / made as f64))
    }

    /// The stage, and how much of it is done.
    fn part(&self) -> String {
        match self.now {
            Progress { stage, done, of } if of > 0 => format!("{stage}, {done} of {of}"),
            Progress { stage, .. } => stage.to_owned(),
        }
    }

    fn text(&self, at: Duration) -> String {
        match self.remaining(at) {
            Some(left) => format!("{}, {} left", self.part(), rough(left)),
            None => self.part(),
        }
    }
}

fn rough(time: Duration) -> String {
    match time.as_secs_f64() {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(s: u64) -> Duration {
        Duration::from_secs(s)
    }

    #[test]
    fn what_is_left_is_reported_of_a_stage_alone_and_by_work_done() {
        let mut activity = Activity::default();
        activity.take(Progress { stage: "reading", done: 0, of: 0 }, seconds(0));
        assert_eq!((activity.remaining(seconds(50)), activity.text(seconds(50)).as_str()), (None, "reading"));
        // The 50 seconds before say nothing about this stage.
        activity.take(Progress { stage: "repairing", done: 0, of: 40 }, seconds(50));
        assert_eq!(activity.text(seconds(60)), "repairing, 0 of 40");
        activity.take(Progress { stage: "repairing", done: 10, of: 40 }, seconds(60));
        assert_eq!(activity.remaining(seconds(60)), Some(seconds(30)));
        assert_eq!(activity.text(seconds(60)), "repairing, 10 of 40, 30 s left");
        activity.take(Progress { stage: "repairing", done: 40, of: 40 }, seconds(90));
        assert_eq!(activity.remaining(seconds(90)), None);
        // The same stage again, a second round.
        activity.take(Progress { stage: "repairing", done: 2, of: 10 }, seconds(100));
        activity.take(Progress { stage: "repairing", done: 6, of: 10 }, seconds(104));
        assert_eq!(activity.remaining(seconds(104)), Some(seconds(4)));
    }

    #[test]
    fn more_done_than_there_was_to_do_is_no_time() {
        let mut activity = Activity::default();
        activity.take(Progress { stage: "moving", done: 9, of: 8 }, seconds(0));
        assert_eq!(activity.remaining(seconds(5)), None);
        assert_eq!([50, 300, 9000].map(|s| rough(seconds(s))), ["50 s", "5 min", "2 h"]);
    }
}
