//! The job file: its keys, and errors in it, reported with the line.

use std::collections::BTreeMap;
use std::ops::Deref;
use std::path::{Path, PathBuf};

use motet::base::{Point, Word, Words, read_both};
use motet::contact::GapWords;
use motet::implant::{ImplantWords, InterfaceName};
use motet::mesh::history::Carry;
use motet::motion::Motion;
use motet::moving::{RepairWords, WatchWords};
use motet::refine::RefineWords;
use motet::{Error, Result, io, words};
use serde::{Deserialize, Deserializer, Serialize};

use crate::verbs::implant::inside;

/// A job file.
#[derive(Debug)]
pub(super) struct Job {
    /// The path of the job file: names of files are relative to it.
    pub(super) file: PathBuf,
    content: Content,
}

impl Deref for Job {
    type Target = Content;

    fn deref(&self) -> &Content {
        &self.content
    }
}

words! {
    /// The content of a job file.
    pub(super) struct Content {
        /// The mesh, a file or folder. Required.
        mesh: PathBuf = PathBuf::new(),
        /// The series that is written, a `.pvd`; the other files are beside it. Required.
        output: PathBuf = PathBuf::new(),
        /// Steps between frames of the output.
        every: usize = 1,
        /// Cell arrays that are densities: their integral over each cell stays constant while the cell moves.
        contents: Vec<String> = Vec::new(),
        /// The table `[time]`.
        time: Time = Time::default(),
        /// Devices that are put into the mesh first, as `motet implant` does: tables `[[device]]`.
        device: Vec<Device> = Vec::new(),
        /// The table `[motion]`.
        motion: MotionTable = MotionTable::default(),
        /// The table `[repair]`.
        repair: RepairWords = RepairWords::default(),
        /// What is refined, and when: tables `[[refine]]`.
        refine: Vec<RefineTable> = Vec::new(),
        /// The table `[contact]`.
        contact: Option<ContactTable> = None,
        /// How arrays are carried where the mesh changes, by name: `mean`, `linear`, `inherit` or `drop`.
        carry: BTreeMap<String, Carry> = BTreeMap::new(),
    }
}

words! {
    /// The times of the steps.
    pub(super) struct Time {
        /// How long a period takes, in the unit of time of the output.
        period: f64 = 1.0,
        /// Steps per period. By default 20; for measured walls one per frame.
        steps: Option<usize> = None,
        /// The number of periods.
        periods: usize = 1,
    }
}

words! {
    /// A device that is put into the mesh.
    pub(super) struct Device {
        /// The file of the device, a closed surface or a mesh of tets. Required.
        file: PathBuf = PathBuf::new(),
        /// The surface of the device bounds the mesh: the flow goes around it.
        hollow: bool = false,
        /// The device is filled with new tets.
        fill: bool = false,
        /// The largest distance of a new surface from the device's, in the unit of the mesh. By default the
        /// triangles of the device are kept.
        conform: Option<f64> = None,
    }
}

impl Device {
    /// How this device is put into the mesh, in the words of `motet implant`.
    pub(super) fn implant_words(&self) -> ImplantWords {
        let interface = self.conform.map_or(InterfaceName::Match, |_| InterfaceName::Conform);
        let inside = inside(self.hollow, self.fill);
        ImplantWords { inside, interface, tolerance: self.conform, ..ImplantWords::default() }
    }
}

/// The table `[motion]`: how the inside follows the walls, and how these move.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct MotionTable {
    #[serde(flatten)]
    pub(super) motion: Motion,
    #[serde(flatten)]
    pub(super) walls: Walls,
}

impl<'de> Deserialize<'de> for MotionTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        read_both(deserializer).map(|(motion, walls)| Self { motion, walls })
    }
}

words! {
    /// How the walls move.
    pub(super) struct Walls {
        /// Whether walls come back to their first position: then tets are kept good there, too. By default
        /// they do, except where one moves on or far.
        returns: Option<bool> = None,
        /// Patches that stay in place, even where they meet one that moves.
        fixed: Vec<String> = Vec::new(),
        /// A series of measured walls, one per step of a period.
        surfaces: Option<PathBuf> = None,
        /// How the points of `surfaces` are found in the mesh: `id`, `position`, or `nearest` (of another
        /// mesh).
        matching as "match": Match = Match::Id,
        /// The patch that follows `surfaces`, with `nearest`.
        patch: Option<String> = None,
        /// Walls that move by rule, one entry each; a vertex follows the first entry that contains it.
        moves as "move": Vec<Move> = Vec::new(),
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Match {
    #[default]
    Id,
    Position,
    Nearest,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
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

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Turn {
    pub(super) axis: Point,
    pub(super) degrees: f64,
    pub(super) centre: Option<Point>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bend {
    pub(super) hinge: Point,
    pub(super) along: Point,
    pub(super) towards: Point,
    pub(super) length: f64,
    pub(super) degrees: f64,
}

/// The course of a motion in time: a name, or a table.
#[derive(Clone, Debug, Deserialize, Serialize)]
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

/// An entry of `refine`: what is divided, and when.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct RefineTable {
    #[serde(flatten)]
    pub(super) words: RefineWords,
    #[serde(flatten)]
    pub(super) timing: RefineTiming,
}

impl<'de> Deserialize<'de> for RefineTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        read_both(deserializer).map(|(words, timing)| Self { words, timing })
    }
}

words! {
    /// When a moving mesh is refined, and by what only a moving mesh has.
    pub(super) struct RefineTiming {
        /// Edges of watched patches are divided until they are no longer than the gap between them.
        gaps: bool = false,
        /// Steps from one refinement to the next. By default once, before the first step.
        every: Option<usize> = None,
    }
}

/// The table `[contact]`: which patches are watched, and how their gaps are measured.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct ContactTable {
    #[serde(flatten)]
    pub(super) watch: WatchWords,
    #[serde(flatten)]
    pub(super) gaps: GapWords,
}

impl<'de> Deserialize<'de> for ContactTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        read_both(deserializer).map(|(watch, gaps)| Self { watch, gaps })
    }
}

impl Job {
    /// All keys of a job with their defaults and effects, as tables in Markdown.
    pub(super) fn keys() -> String {
        let of_motion = [Motion::words(), Walls::words()].concat();
        let of_refine = [RefineWords::words(), RefineTiming::words()].concat();
        let of_contact = [WatchWords::words(), GapWords::words()].concat();
        let tables = [
            ("A job", Content::words()),
            ("`[time]`", Time::words()),
            ("`[[device]]`", Device::words()),
            ("`[motion]`", of_motion),
            ("`[repair]`", RepairWords::words()),
            ("`[[refine]]`", of_refine),
            ("`[contact]`", of_contact),
        ];
        let table = |(title, words): &(&str, Vec<Word>)| {
            let rows = words.iter().map(|word| {
                let default = match word.default.as_str() {
                    "null" | "[]" | "{}" | "\"\"" => String::new(),
                    value if value.starts_with('{') => String::new(),
                    value => format!("`{value}`"),
                };
                format!("| `{}` | {default} | {} |\n", word.name, word.effect_text().trim_end_matches('.'))
            });
            format!("| {title} | default | |\n|---|---|---|\n{}", rows.collect::<String>())
        };
        tables.iter().map(table).collect::<Vec<_>>().join("\n")
    }

    /// Reads and checks a job.
    ///
    /// # Errors
    /// When it cannot be read or is not a valid job; with the line.
    pub(super) fn read(file: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(file).map_err(|e| Error::io(file, e))?;
        let content = toml::from_str(&text).map_err(|e| toml_error(&text, &e).in_file(file))?;
        let mut job = Self { file: file.to_owned(), content };
        if let (None, Some(series)) = (job.time.steps, &job.motion.walls.surfaces) {
            job.content.time.steps = Some(io::read_series(job.path(series))?.len());
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
        files.extend(
            self.motion.walls.surfaces.iter().map(|series| ("motion.surfaces".to_owned(), series.clone())),
        );
        for (i, refine) in self.refine.iter().enumerate() {
            let named = refine.words.surfaces().into_iter().flatten().enumerate();
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
        let required = [("mesh", &self.mesh), ("output", &self.output)];
        let devices = self.device.iter().map(|device| ("device.file", &device.file));
        for (key, path) in required.into_iter().chain(devices) {
            if path.as_os_str().is_empty() {
                return invalid(&format!("`{key}` is missing"), "add it: the name of a file");
            }
        }
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
        if self.contact.is_none() && self.refine.iter().any(|refine| refine.timing.gaps) {
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
