//! The job file: its keys, and errors in it, reported with the line.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use motet::base::Point;
use motet::mesh::history::Carry;
use motet::{Error, Result, io};
use serde::{Deserialize, Serialize};

use crate::verbs::refine::parsers;

/// The content of a job file.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Job {
    /// The path of the job file: names of files are relative to it.
    #[serde(skip)]
    pub(super) file: PathBuf,
    pub(super) mesh: PathBuf,
    pub(super) output: PathBuf,
    #[serde(default = "default_every")]
    pub(super) every: usize,
    #[serde(default)]
    pub(super) contents: Vec<String>,
    #[serde(default)]
    pub(super) time: Time,
    #[serde(default)]
    pub(super) device: Vec<Device>,
    #[serde(default)]
    pub(super) motion: Motion,
    #[serde(default)]
    pub(super) repair: Repair,
    #[serde(default)]
    pub(super) refine: Vec<Refine>,
    pub(super) contact: Option<Contact>,
    #[serde(default)]
    pub(super) carry: BTreeMap<String, Carry>,
}

/// The default of `every`: each step is written.
fn default_every() -> usize {
    1
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Time {
    pub(super) period: f64,
    pub(super) steps: Option<usize>,
    pub(super) periods: usize,
}

impl Default for Time {
    fn default() -> Self {
        Self { period: 1.0, steps: None, periods: 1 }
    }
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Device {
    pub(super) file: PathBuf,
    #[serde(default)]
    pub(super) hollow: bool,
    #[serde(default)]
    pub(super) fill: bool,
    /// Largest distance of a new surface from the device's; without it the triangles are kept.
    pub(super) conform: Option<f64>,
}

#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Motion {
    pub(super) method: Option<String>,
    pub(super) bodies: Vec<String>,
    pub(super) strain: Option<String>,
    pub(super) returns: Option<bool>,
    pub(super) smooth: usize,
    pub(super) rigid_layer: Option<Layer>,
    pub(super) rigid_layer_at: Vec<String>,
    pub(super) within_walls: bool,
    pub(super) fixed: Vec<String>,
    pub(super) slide: Vec<String>,
    pub(super) slide_tolerance: Option<f64>,
    pub(super) inside: Vec<String>,
    pub(super) surfaces: Option<PathBuf>,
    #[serde(rename = "match")]
    pub(super) matching: Match,
    pub(super) patch: Option<String>,
    #[serde(rename = "move")]
    pub(super) moves: Vec<Move>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub(super) enum Layer {
    Distance(f64),
    Word(String),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Match {
    #[default]
    Id,
    Position,
    Nearest,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Move {
    pub(super) patch: String,
    pub(super) shift: Option<Point>,
    pub(super) turn: Option<Turn>,
    pub(super) affine: Option<[[f64; 4]; 3]>,
    pub(super) bend: Option<Bend>,
    pub(super) swell: Option<f64>,
    #[serde(default)]
    pub(super) in_time: Course,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Turn {
    pub(super) axis: Point,
    pub(super) degrees: f64,
    pub(super) centre: Option<Point>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bend {
    pub(super) hinge: Point,
    pub(super) along: Point,
    pub(super) towards: Point,
    pub(super) length: f64,
    pub(super) degrees: f64,
}

/// The course of a motion in time: a name, or a table.
#[derive(Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub(super) enum Course {
    Name(String),
    Table(Vec<[f64; 2]>),
}

impl Course {
    /// Whether what follows this course ends at another place than it started from.
    pub(super) fn is_ramp(&self) -> bool {
        matches!(self, Self::Name(name) if name == "ramp")
    }
}

impl Default for Course {
    fn default() -> Self {
        Self::Name("beat".into())
    }
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Repair {
    pub(super) off: bool,
    pub(super) min_eas: f64,
    pub(super) surface: String,
    pub(super) distance: Option<f64>,
    /// Names of regions and patches that stay as they are.
    pub(super) hold: Vec<String>,
    pub(super) margin: f64,
    pub(super) floor: f64,
    pub(super) improve_below: f64,
    pub(super) valid_at_start: bool,
}

impl Default for Repair {
    fn default() -> Self {
        let usual = motet::moving::Options::default();
        Self {
            off: false,
            min_eas: usual.limit(),
            surface: "keep".into(),
            distance: None,
            hold: Vec::new(),
            margin: usual.margin,
            floor: usual.floor,
            improve_below: usual.improve_below,
            valid_at_start: usual.valid_at_start,
        }
    }
}

/// An entry of `refine`; each word has the syntax of the command line of `motet refine`.
#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Refine {
    pub(super) near: Vec<String>,
    pub(super) near_size: Vec<String>,
    #[serde(rename = "where")]
    pub(super) conditions: Vec<String>,
    pub(super) ball: Vec<String>,
    #[serde(rename = "box")]
    pub(super) in_box: Vec<String>,
    pub(super) patch: Vec<String>,
    pub(super) region: Vec<String>,
    pub(super) gradient: Vec<String>,
    pub(super) vorticity: Vec<String>,
    /// Whether to divide edges of watched patches until they are no longer than the gap between them.
    pub(super) gaps: bool,
    pub(super) smallest: Option<f64>,
    pub(super) generations: Option<u32>,
    pub(super) limit_generation: Option<u8>,
    pub(super) every: Option<usize>,
    pub(super) coarsen: bool,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Contact {
    pub(super) patches: Vec<String>,
    pub(super) warn: Option<f64>,
    pub(super) within: Option<f64>,
    #[serde(default)]
    pub(super) own: bool,
    pub(super) horizon: Option<f64>,
    /// The distance at which walls stop.
    pub(super) hold: Option<f64>,
}

impl Job {
    /// Reads and checks a job.
    ///
    /// # Errors
    /// When it cannot be read or is not a valid job; with the line.
    pub(super) fn read(file: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(file).map_err(|e| Error::io(file, e))?;
        let job = toml::from_str(&text).map_err(|e| toml_error(&text, &e).in_file(file))?;
        let mut job = Self { file: file.to_owned(), ..job };
        if let (None, Some(series)) = (job.time.steps, &job.motion.surfaces) {
            job.time.steps = Some(io::read_series(job.path(series))?.len());
        }
        job.check().map_err(|e| e.in_file(file))?;
        Ok(job)
    }

    /// The path of a file that the job names.
    pub(super) fn path(&self, named: &Path) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(named)
    }

    /// The files that the job reads, each with the key that names it.
    pub(super) fn files(&self) -> Vec<(String, PathBuf)> {
        let mut files = vec![("mesh".to_owned(), self.mesh.clone())];
        for (i, device) in self.device.iter().enumerate() {
            files.push((format!("device.{i}.file"), device.file.clone()));
        }
        files
            .extend(self.motion.surfaces.iter().map(|series| ("motion.surfaces".to_owned(), series.clone())));
        for (i, refine) in self.refine.iter().enumerate() {
            let near =
                refine.near.iter().filter_map(|text| parsers::near(text).ok().map(|near| near.surface));
            let sized = refine.near_size.iter();
            let sized = sized.filter_map(|text| parsers::near_size(text).ok().map(|near| near.surface));
            let named = near.chain(sized).enumerate();
            files.extend(named.map(|(k, file)| (format!("refine.{i}, surface {k}"), file)));
        }
        files
    }

    /// The error as one of kind input, in the job file where it names no other file.
    pub(super) fn with_job_file(&self, error: Error) -> Error {
        let file = error.file().unwrap_or(&self.file).to_owned();
        let mut located = Error::input(error.what());
        if let Some(place) = error.place() {
            located = located.at(place);
        }
        if let Some(remedy) = error.remedy_text() {
            located = located.remedy(remedy);
        }
        located.in_file(file)
    }

    /// Number of steps in a period.
    pub(super) fn steps_in_period(&self) -> usize {
        self.time.steps.unwrap_or(DEFAULT_STEPS)
    }

    /// Total number of steps.
    pub(super) fn n_steps(&self) -> usize {
        self.steps_in_period() * self.time.periods
    }

    /// The time of step `k`.
    pub(super) fn time(&self, k: usize) -> f64 {
        self.time.period * (k as f64 / self.steps_in_period() as f64)
    }

    fn check(&self) -> Result<()> {
        let invalid = |what: &str, remedy: &str| Err(Error::input(what).remedy(remedy));
        if !(self.time.period > 0.0 && self.time.period.is_finite()) {
            return invalid("time.period must be positive", "give a number above 0");
        }
        if self.every == 0 || self.time.steps == Some(0) || self.time.periods == 0 {
            return invalid("every, time.steps or time.periods is 0", "give numbers of at least 1");
        }
        if self.steps_in_period().checked_mul(self.time.periods).is_none_or(|n| n > MAX_STEPS) {
            return invalid("too many steps", "a run has at most a hundred million steps");
        }
        if !motet::io::can_write_series(&self.output) {
            return invalid("output is not a series", "name a file that ends in .pvd");
        }
        let share = |x: f64| (0.0..1.0).contains(&x);
        let repair = &self.repair;
        if !(share(repair.min_eas)
            && share(repair.margin)
            && share(repair.floor)
            && share(repair.improve_below))
        {
            return invalid(
                "a number of [repair] is not between 0 and 1",
                "min_eas, margin, floor and improve_below are shares",
            );
        }
        let contact = self.contact.as_ref();
        let distances = contact.map(|contact| [("warn", contact.warn), ("hold", contact.hold)]);
        for (key, value) in distances.into_iter().flatten() {
            if let Some(value) = value.filter(|value| *value <= 0.0 || value.is_nan()) {
                return invalid(&format!("contact.{key} is {value}"), "give a distance above 0");
            }
        }
        if self.contact.is_none() && self.refine.iter().any(|refine| refine.gaps) {
            return invalid(
                "refine.gaps follows the gaps between watched patches, and none is watched",
                "add [contact]",
            );
        }
        if self.device.iter().any(|device| device.hollow && device.fill) {
            return invalid("a device has both hollow and fill", "give one of them");
        }
        Ok(())
    }
}

/// Number of steps in a period, by default.
const DEFAULT_STEPS: usize = 20;
const MAX_STEPS: usize = 100_000_000;

/// The error of the TOML parser, with the line.
fn toml_error(text: &str, error: &toml::de::Error) -> Error {
    let located = Error::input(error.message().trim().replace('\n', "; "));
    let located = located.remedy("`motet help run` shows a job with all keys");
    match error.span() {
        Some(span) => {
            located.at(format!("line {}", 1 + text[..span.start.min(text.len())].matches('\n').count()))
        }
        None => located,
    }
}
