//! The report of `motet run`: a line per step, and the result.

use std::path::PathBuf;

use motet::base::{percent, reasons};
use motet::mesh::Qualities;
use motet::motion::LeavesPlane;
use motet::moving::{MovingMesh, Script, Seconds, Step, Stopped, Why, WorstTet};
use serde::Serialize;

use super::job::Job;
use super::output::Output;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{Table, count, seconds, short, time};
use crate::words;

/// The result of a run.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    #[serde(serialize_with = "words::paths")]
    job: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    #[serde(serialize_with = "words::paths")]
    log: PathBuf,
    /// The step after which the run resumed; 0 for a new run.
    resumed_after: usize,
    /// The last step.
    pub(crate) steps: usize,
    of: usize,
    /// Whether every step was completed.
    complete: bool,
    changes: usize,
    /// Steps in which the mesh changed.
    pub(crate) changed_steps: usize,
    /// Bad tets present when something was repaired.
    pub(crate) repaired: usize,
    /// The most bad tets in a step, including those that walls force.
    pub(crate) most_bad: usize,
    most_bad_not_forced: usize,
    pub(crate) most_inverted: usize,
    /// The most tets in a step that are flat or inverted in the changed mesh with its vertices where they
    /// were as the step began.
    most_inverted_at_start: usize,
    /// The worst tet when the run started or resumed.
    pub(crate) worst_at_first: Option<WorstTet>,
    pub(crate) worst: Option<WorstTet>,
    worst_at_step: usize,
    points: usize,
    /// Number of tets when the run started or resumed, and at the end.
    pub(crate) tets: [usize; 2],
    /// Quality of all tets when the run started or resumed, and at the end.
    pub(crate) quality: [Qualities; 2],
    /// The least mean EAS of a step.
    least_mean: f64,
    /// The cells that changed, summed over all steps, relative to the cells of a step.
    changed: f64,
    /// Steps in which walls stopped in front of others.
    held_steps: usize,
    /// The held vertex of any step that stopped farthest from its requested place.
    farthest_held: Option<Stopped>,
    /// The first patch that had no room to keep its distance.
    cramped: Option<String>,
    pub(crate) least_gap: Option<f64>,
    least_gap_at: Option<f64>,
    first_warned_at: Option<f64>,
    /// Number of steps with a warning.
    pub(crate) warned_steps: usize,
    /// Where walls take the rim of a sliding patch farthest out of its plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    leaves_plane: Option<LeavesPlane>,
    seconds: Seconds,
    pub(super) seconds_total: f64,
}

/// Prints a line for a step, for people.
pub(super) fn line(step: &Step, console: &Console) {
    let worst = step.worst.map_or(f64::NAN, |worst| worst.eas);
    let mut text = format!(
        "step {:>4}  time {:<8} {:>11} tets  worst EAS {worst:.4}, 1 % {:.3}, mean {:.3}  {} bad",
        step.step,
        time(step.time),
        count(step.tets),
        step.quality.p1,
        step.quality.mean,
        step.bad
    );
    if step.forced > 0 {
        text += &format!(" ({} forced by walls)", step.forced);
    }
    if let Some(gaps) = &step.gaps {
        text += &gaps.least.map_or_else(String::new, |gap| format!("  gap {}", short(gap)));
        if gaps.warned > 0 {
            text += " !";
        }
        if gaps.held > 0 {
            text += &format!("  {} held", gaps.held);
        }
        if let Some(held) = &gaps.farthest_held {
            text += &format!(", by up to {}", short(held.short));
        }
    }
    for change in &step.changes {
        let part = 100.0 * (1.0 - change.kept_share);
        text += &format!("  [{:?}: {} bad, {part:.2} % new]", change.why, change.bad_before);
    }
    if !step.complete {
        text += &format!("  completed {} of the step", percent(step.fraction));
    }
    console.print(text);
}

impl Report {
    pub(super) fn new(job: &Job, output: &Output) -> Self {
        let (output, log) = (output.series_file.clone(), output.log.clone());
        Self {
            job: job.file.clone(),
            output,
            log,
            of: job.n_steps(),
            complete: true,
            least_mean: 1.0,
            ..Self::default()
        }
    }

    /// Notes that the run resumes after a step.
    pub(super) fn resume_after(&mut self, step: usize) {
        (self.resumed_after, self.steps) = (step, step);
    }

    pub(super) fn add(&mut self, step: &Step) {
        if self.worst_at_first.is_none() {
            (self.worst_at_first, self.tets[0], self.quality[0]) = (step.worst, step.tets, step.quality);
        }
        self.steps = step.step;
        self.complete &= step.complete;
        self.changes += step.changes.len();
        self.changed_steps += usize::from(!step.changes.is_empty());
        let repairs = step.changes.iter().filter(|change| change.why == Why::Repair);
        self.repaired += repairs.map(|change| change.bad_before).sum::<usize>();
        self.most_bad = self.most_bad.max(step.bad);
        self.most_bad_not_forced = self.most_bad_not_forced.max(step.bad - step.forced);
        self.most_inverted = self.most_inverted.max(step.inverted);
        let at_start = step.inverted_at_start.map_or(0, |found| found.tets);
        self.most_inverted_at_start = self.most_inverted_at_start.max(at_start);
        if let Some(worst) = step.worst.filter(|worst| self.worst.is_none_or(|w| worst.eas < w.eas)) {
            (self.worst, self.worst_at_step) = (Some(worst), step.step);
        }
        (self.points, self.tets[1], self.quality[1]) = (step.points, step.tets, step.quality);
        self.least_mean = self.least_mean.min(step.quality.mean);
        self.changed += 1.0 - step.changes.iter().map(|change| change.kept_share).product::<f64>();
        if let Some(gaps) = &step.gaps {
            if gaps.least.is_some_and(|gap| self.least_gap.is_none_or(|least| gap < least)) {
                (self.least_gap, self.least_gap_at) = (gaps.least, Some(step.time));
            }
            if gaps.warned > 0 {
                self.warned_steps += 1;
                self.first_warned_at = self.first_warned_at.or(Some(step.time));
            }
            self.held_steps += usize::from(gaps.held > 0);
            self.cramped = self.cramped.take().or_else(|| gaps.cramped.clone());
            if let Some(held) = &gaps.farthest_held
                && self.farthest_held.as_ref().is_none_or(|known| held.short > known.short)
            {
                self.farthest_held = Some(held.clone());
            }
        }
        self.seconds += step.seconds;
    }

    /// Warns where walls take the rim of a sliding patch out of its plane in a period.
    pub(super) fn warn_of_rims(
        &mut self,
        job: &Job,
        moving: &MovingMesh,
        script: &Script,
        console: &Console,
    ) {
        if moving.options().motion.slide.is_empty() {
            return;
        }
        for k in 1..=job.steps_in_period() {
            let found = moving.leaves_plane(&script.at(job.time(k) / job.time.period));
            let farthest = self.leaves_plane.as_ref().map_or(0.0, |leaves| leaves.distance);
            if let Some(leaves) = found.filter(|leaves| leaves.distance > farthest) {
                self.leaves_plane = Some(leaves);
            }
        }
        if let Some(LeavesPlane { patch, vertex, place: [x, y, z], distance, is_significant: true, .. }) =
            &self.leaves_plane
        {
            console.warn(format_args!(
                "walls take the rim of the sliding patch {patch} out of its plane, by up to {} at vertex \
                 {vertex}, initially at ({x:.6}, {y:.6}, {z:.6}): \
                 the patch follows its rim",
                short(*distance)
            ));
        }
    }

    /// The outcome: done if every step was completed and the only bad tets are those that walls force.
    pub(crate) fn outcome(&self) -> Outcome {
        let (inverted, bad) = (self.most_inverted, self.most_bad_not_forced);
        Outcome::of(reasons([
            (!self.complete).then(|| format!("step {} stopped before its end", self.steps)),
            (inverted > 0).then(|| format!("up to {inverted} tets are inverted or flat in a step")),
            self.cramped.as_ref().map(|patch| {
                format!(
                    "the patch {patch} has no space to keep its distance (hold) from the patches after it"
                )
            }),
            (bad > 0).then(|| format!("up to {bad} bad tets are left in a step that no wall forces")),
        ]))
    }

    pub(crate) fn print(&self, console: &Console) {
        console.conclude(self, &self.outcome());
        let n = self.steps - self.resumed_after;
        console.print(format_args!(
            "\n{n} steps{}: {} changes in {} of them, {} tets at the end",
            if self.complete { "" } else { ", the last one incomplete" },
            self.changes,
            self.changed_steps,
            count(self.tets[1])
        ));
        if let Some(worst) = self.worst {
            console.print(format_args!(
                "worst EAS of all steps {:.4}, in step {}; at most {} bad tets in a step, {} of them not forced by walls; {} inverted",
                worst.eas, self.worst_at_step, self.most_bad, self.most_bad_not_forced, self.most_inverted
            ));
        }
        if n > 0 {
            let [first, last] = self.quality.map(Some);
            console.print(quality::table([("at first", first), ("at last", last)]));
            console.print(format_args!(
                "initially {} tets; mean EAS of a step at least {:.3}; on average {:.2} % of the cells \
                 changed per step",
                count(self.tets[0]),
                self.least_mean,
                100.0 * self.changed / n as f64
            ));
        }
        if self.most_inverted_at_start > 0 {
            console.print(format_args!(
                "up to {} tets of a changed mesh are inverted at the vertex positions from the start of the \
                 step (inverted_at_start in the log): \
                 schemes that use earlier time levels have no valid volume there (`valid_at_start` of the \
                 repair avoids them)",
                self.most_inverted_at_start
            ));
        }
        if let Some(gap) = self.least_gap {
            let at = self.least_gap_at.map_or_else(String::new, time);
            let warned = match self.first_warned_at {
                Some(first) => format!("first warning at time {}", time(first)),
                None => "no warnings".to_owned(),
            };
            let held = match self.held_steps {
                0 => String::new(),
                n => format!("; walls stopped in {n} steps"),
            };
            let farthest = self.farthest_held.as_ref().map_or_else(String::new, |held| {
                let [x, y, z] = held.place.map(short);
                format!(", {} by up to {}, at ({x}, {y}, {z})", held.patch, short(held.short))
            });
            console.print(format_args!("least gap {} at time {at}; {warned}{held}{farthest}", short(gap)));
        }
        let mut table = Table::new(["stage", "seconds", "per step"]);
        let all = &self.seconds;
        let writing = self.seconds_total - all.total;
        for (name, s) in [
            ("motion", all.motion),
            ("quality", all.quality),
            ("repair", all.repair),
            ("set-up", all.setup),
            ("contact", all.contact),
            ("reading, writing", writing),
        ] {
            table.row([name.to_owned(), format!("{s:.2}"), seconds(s / n.max(1) as f64)]);
        }
        console.print(format_args!("{table}\nwrote {}, {}", self.output.display(), self.log.display()));
    }
}
