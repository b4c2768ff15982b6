//! What a motion reports: to people a table, to programs an object.

use std::path::PathBuf;

use motet::Mesh;
use motet::base::Threads;
use motet::motion::{Certificate, Mover, Setup, Tried};
use serde::Serialize;

use super::args::MoveArgs;
use super::inverted;
use crate::console::Console;
use crate::table::{Table, count, seconds, short, time};
use crate::words;

/// All that a motion came to.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    #[serde(serialize_with = "words::paths")]
    mesh: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Whether all that was asked was reached.
    complete: bool,
    points: usize,
    cells: usize,
    /// Vertices that are where they were, as a share of all.
    untouched: f64,
    /// How the method was chosen, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) choice: Option<Chosen>,
    setup: Setup,
    /// The mesh as it came.
    before: Certificate,
    /// The last step.
    after: Certificate,
    steps: Vec<Step>,
    pub(crate) seconds: Stages,
}

/// How a method was chosen.
#[derive(Debug, Serialize)]
pub(crate) struct Chosen {
    pub(crate) method: &'static str,
    /// No cell was to be worse.
    pub(crate) least: f64,
    pub(crate) tried: Vec<Tried>,
}

impl Chosen {
    fn tell(&self, console: &Console) {
        for tried in &self.tried {
            let came_to = match (&tried.refused, tried.worst) {
                (Some(why), _) => why.clone(),
                (None, Some(worst)) => format!("worst {} in {} steps", short(worst), tried.frames),
                (None, None) => format!("{} steps", tried.frames),
            };
            console.say(format_args!("tried {}: {came_to} ({})", tried.method, seconds(tried.seconds)));
        }
        if self.tried.last().is_some_and(|last| last.kept) {
            console.say(format_args!("{} keeps every cell at {}", self.method, short(self.least)));
        } else {
            let least = short(self.least);
            console.warn(format_args!(
                "no method keeps every cell at {least}; {} comes nearest to it",
                self.method
            ));
        }
    }
}

/// One step of a motion.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Step {
    pub(crate) step: usize,
    pub(crate) time: f64,
    /// Where it was written, if it was.
    #[serde(serialize_with = "words::paths")]
    pub(crate) file: Option<PathBuf>,
    #[serde(flatten)]
    pub(crate) certificate: Certificate,
}

/// Seconds by stage.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Stages {
    pub(crate) read: f64,
    pub(crate) setup: f64,
    #[serde(rename = "move")]
    pub(crate) moving: f64,
    pub(crate) write: f64,
    total: f64,
}

impl Report {
    pub(crate) fn new(args: &MoveArgs, mesh: &Mesh) -> Self {
        Self {
            mesh: args.mesh.clone(),
            output: args.output.clone(),
            complete: false,
            points: mesh.points.len(),
            cells: mesh.cells.len(),
            untouched: 1.0,
            choice: None,
            setup: Setup::default(),
            before: Certificate::default(),
            after: Certificate::default(),
            steps: Vec::new(),
            seconds: Stages::default(),
        }
    }

    pub(crate) fn begin(&mut self, mover: &Mover, threads: &Threads) {
        self.setup = *mover.setup();
        self.before = mover.quality(mover.reference(), threads);
    }

    /// Warns of a mesh that is not sound from the start.
    pub(crate) fn warn(&self, console: &Console) {
        if self.before.inverted > 0 {
            console.warn(format_args!(
                "{}: {} cells are inverted or flat as it comes; they do not stop the motion, `motet info` tells where they are",
                self.mesh.display(),
                count(self.before.inverted)
            ));
        }
    }

    pub(crate) fn step(&mut self, step: Step) {
        self.after = step.certificate.clone();
        self.complete = step.certificate.complete;
        self.steps.push(step);
    }

    pub(crate) fn end(&mut self, n_moved: usize, total: f64) {
        self.untouched = 1.0 - n_moved as f64 / self.points.max(1) as f64;
        self.seconds.total = total;
    }

    pub(crate) fn tell(&self, console: &Console) {
        console.report(self);
        if let Some(choice) = &self.choice {
            choice.tell(console);
        }
        let follow = match self.setup.solved {
            0 => format!(
                "{} hanging in a graph of {} tets",
                count(self.setup.hanging),
                count(self.setup.graph_tets)
            ),
            n if self.setup.factor_bytes > 0 => {
                let mib = self.setup.factor_bytes as f64 / f64::from(1 << 20);
                format!("{} solved for, with a factor of {mib:.1} MiB", count(n))
            }
            n => {
                let iterations: usize = self.steps.iter().map(|step| step.certificate.iterations).sum();
                format!("{} solved for, in {} iterations", count(n), count(iterations))
            }
        };
        console.say(format_args!(
            "{}: {} points, {} of them driven, {follow}",
            self.mesh.display(),
            count(self.points),
            count(self.setup.driven),
        ));
        if self.setup.layer > 0 || self.setup.sliding > 0 {
            console.say(format_args!(
                "{} in the rigid layer, {} sliding",
                count(self.setup.layer),
                count(self.setup.sliding)
            ));
        }
        console.say(step_table(&self.before, &self.steps));
        self.tell_end(console);
        console.say(format_args!(
            "read {}, set-up {}, {} step{} {}, writing {}, all {}",
            seconds(self.seconds.read),
            seconds(self.seconds.setup),
            self.steps.len(),
            if self.steps.len() == 1 { "" } else { "s" },
            seconds(self.seconds.moving),
            seconds(self.seconds.write),
            seconds(self.seconds.total)
        ));
    }

    fn tell_end(&self, console: &Console) {
        if let Some(last) = self.steps.last().filter(|last| !last.certificate.complete) {
            let cells: Vec<String> = last.certificate.blocked_by.iter().map(ToString::to_string).collect();
            console.warn(format_args!(
                "not reached: step {} got {:.1} % of its way in {} sub-steps, then cells would turn over (the first: {}); \
                 what was reached is written",
                last.step,
                100.0 * last.certificate.fraction,
                last.certificate.substeps,
                cells.join(", ")
            ));
        }
        console.say(format_args!("wrote {}", self.output.display()));
    }
}

/// The steps of a motion, a row each, after one for the mesh as it came.
fn step_table(before: &Certificate, steps: &[Step]) -> Table {
    let other = before.quality.worst_eas.is_none();
    let measure = if other { "worst scaled Jacobian" } else { "worst EAS" };
    let mut table = Table::new([
        "step",
        "time",
        measure,
        "in cell",
        "mean ratio",
        "bad",
        "inverted",
        "sub-steps",
        "move",
    ]);
    let mut row = |step: &str, time: &str, certificate: &Certificate, took: &str| {
        let quality = &certificate.quality;
        let of_others = quality.worst_curved_jacobian.or(quality.worst_scaled_jacobian);
        let worst = if other { of_others } else { quality.worst_eas };
        let ratio = quality.worst_mean_ratio.map(|w| short(w.value));
        table.row([
            step.to_string(),
            time.to_string(),
            worst.map_or("-".into(), |w| short(w.value)),
            worst.map_or("-".into(), |w| w.cell.to_string()),
            ratio.unwrap_or("-".into()),
            quality.bad.to_string(),
            inverted(certificate),
            certificate.substeps.to_string(),
            took.to_string(),
        ]);
    };
    row("as it came", "", before, "");
    for step in steps {
        let took = seconds(step.certificate.seconds.total);
        row(&step.step.to_string(), &time(step.time), &step.certificate, &took);
    }
    table
}
