//! Files that a run writes: the series, a line per step, the state from which to resume.
//!
//! Lines and meshes are the same bytes however often a run was stopped; timings go to a separate file. One
//! run at a time writes to an output: the lock is the system's, so that a killed run leaves none. Everything
//! that a state depends on is on the disk before the state is.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use motet::base::Threads;
use motet::geometry::quality::eas;
use motet::io::{SeriesWriter, WriteOptions, remove_drafts, replace, settle, sync};
use motet::mesh::Field;
use motet::moving::{MovingMesh, Step};
use motet::{Error, Mesh, Result};
use serde_json::{Value, json};

use super::job::Job;
use super::record::{self, Record};

/// The output files of a run.
pub(super) struct Output {
    pub(super) series_file: PathBuf,
    series: SeriesWriter,
    every: usize,
    pub(super) log: PathBuf,
    times: PathBuf,
    state: PathBuf,
    /// The next state, until it is complete.
    draft: PathBuf,
    /// The record of the job.
    record: PathBuf,
}

impl Output {
    /// Prepares the output of a job.
    ///
    /// # Errors
    /// When the system refuses access, or another run writes there.
    pub(super) fn new(job: &Job) -> Result<Self> {
        let series_file = job.path(&job.output);
        let folder = series_file.parent().filter(|folder| !folder.as_os_str().is_empty());
        let mut series = SeriesWriter::new(&series_file, WriteOptions::default());
        let is_locked = series.lock()?;
        let name = series_file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if is_locked {
            remove_drafts(folder.unwrap_or(Path::new(".")), |of| is_own(&name, of));
        }
        Ok(Self {
            series,
            draft: series_file.with_file_name(draft_of(&name)),
            record: series_file.with_extension("job.json"),
            every: job.every,
            log: series_file.with_extension("jsonl"),
            times: series_file.with_extension("times.jsonl"),
            state: series_file.with_extension("state.vtu"),
            series_file,
        })
    }

    /// The state of an earlier run, where there is one.
    pub(super) fn state(&self) -> Option<PathBuf> {
        self.state.is_file().then(|| self.state.clone())
    }

    /// Checks that the state was made by this job.
    ///
    /// # Errors
    /// When it was made by another job, or no record exists; the error names the differences.
    pub(super) fn check_record(&self, job: &Job, now: &Record) -> Result<()> {
        let differ = record::differences(&record::read(&self.record)?, now);
        match differ.is_empty() {
            true => Ok(()),
            false => Err(Error::input(format!("differs from the job to resume: {}", differ.join("; ")))
                .in_file(&job.file)
                .remedy("change it back, or omit --resume to start anew; only time.periods may differ")),
        }
    }

    /// Keeps what an earlier run has written up to a step, and no more.
    ///
    /// # Errors
    /// When one of its frames or lines is missing.
    pub(super) fn resume_after(&mut self, step: usize) -> Result<()> {
        let n_frames = 1 + step / self.every;
        self.series.go_on_after(n_frames)?;
        let remedy = "restore it, or omit --resume to start anew";
        let is_there = |file: &PathBuf| file.metadata().is_ok_and(|it| it.is_file() && it.len() > 0);
        let mut frames = (0..n_frames).map(|k| self.series.frame_path(k));
        if let Some(file) = frames.find(|file| !is_there(file)) {
            return Err(Error::input("is a frame of the run to resume, but is missing or empty")
                .in_file(file)
                .remedy(remedy));
        }
        let text = std::fs::read_to_string(&self.log).map_err(|e| Error::io(&self.log, e).remedy(remedy))?;
        let is_of_step = |(k, line): (usize, &str)| {
            let line: Option<Value> =
                line.strip_suffix('\n').and_then(|line| serde_json::from_str(line).ok());
            line.is_some_and(|line| line["step"].as_u64() == Some(k as u64))
        };
        let n_lines = text.split_inclusive('\n').enumerate().take_while(|line| is_of_step(*line)).count();
        if n_lines <= step {
            return Err(Error::input(format!("has lines for {n_lines} steps, expected {}", step + 1))
                .in_file(&self.log)
                .remedy(remedy));
        }
        // Timings do not matter for what follows.
        for file in [&self.log, &self.times] {
            let text = std::fs::read_to_string(file).unwrap_or_default();
            let lines: String = text.split_inclusive('\n').take(step + 1).collect();
            replace(file, lines.as_bytes())?;
        }
        Ok(())
    }

    /// Writes the first frame; removes what an earlier run has left.
    pub(super) fn first(
        &mut self,
        record: &Record,
        moving: &MovingMesh,
        step: &Step,
        threads: &Threads,
    ) -> Result<()> {
        if self.state.is_file() {
            std::fs::remove_file(&self.state).map_err(|e| Error::output(&self.state, e))?;
        }
        record::write(&self.record, record)?;
        for file in [&self.log, &self.times] {
            replace(file, b"")?;
        }
        self.take(moving, step, threads)
    }

    /// Writes a step: the frame where one is due, then the lines, then the state.
    pub(super) fn take(&mut self, moving: &MovingMesh, step: &Step, threads: &Threads) -> Result<()> {
        let is_due = step.step.is_multiple_of(self.every) || !step.complete;
        let file = is_due
            .then(|| self.series.add_on(step.time, &frame(moving), threads))
            .transpose()?
            .map(|(file, _)| file);
        let mut line = serde_json::to_value(step).map_err(|e| Error::io(&self.log, e.into()))?;
        let seconds = line.as_object_mut().and_then(|line| line.remove("seconds")).unwrap_or(Value::Null);
        if let (Some(line), Some(file)) = (line.as_object_mut(), &file) {
            line.insert("file".into(), json!(file.file_name().map(|name| name.to_string_lossy())));
        }
        append(&self.log, &line)?;
        append(&self.times, &json!({ "step": step.step, "seconds": seconds }))?;
        if step.complete {
            if let Some(file) = &file {
                sync(file)?;
                sync(&self.series_file)?;
            }
            sync(&self.log)?;
            moving.save(&self.draft)?;
            settle(&self.draft, &self.state)?;
        }
        Ok(())
    }
}

/// The file name of an incomplete state.
fn draft_of(name: &str) -> String {
    format!(".motet-{name}.state.vtu")
}

/// Whether a run whose output is named `name` writes the file named `of`.
fn is_own(name: &str, of: &str) -> bool {
    let is_number = |text: &str| text.len() >= 4 && text.bytes().all(|c| c.is_ascii_digit());
    of == draft_of(name)
        || of.strip_prefix(name).is_some_and(|rest| {
            let frame = rest.strip_prefix('_').and_then(|rest| rest.strip_suffix(".vtu"));
            matches!(rest, ".pvd" | ".jsonl" | ".times.jsonl" | ".job.json") || frame.is_some_and(is_number)
        })
}

fn append(file: &Path, line: &Value) -> Result<()> {
    let failed = |e: std::io::Error| Error::output(file, e);
    let mut out = OpenOptions::new().append(true).create(true).open(file).map_err(failed)?;
    // One write per line: a killed run leaves whole lines, or an incomplete last one that resuming cuts off.
    out.write_all(format!("{line}\n").as_bytes()).map_err(failed)
}

/// The mesh with the results of the step as arrays.
fn frame(moving: &MovingMesh) -> Mesh {
    let mut mesh = moving.mesh().clone();
    mesh.set_point_field(Field::vectors("displacement", &moving.displacement()));
    mesh.set_point_field(Field::vectors("velocity", &moving.velocity()));
    if let Some(gaps) = moving.gaps() {
        // NaN where nothing is measured.
        let gap =
            gaps.at_points(mesh.points.len()).into_iter().map(|x| if x.is_finite() { x } else { f64::NAN });
        mesh.set_point_field(Field::scalars("gap", gap.collect::<Vec<_>>()));
    }
    let quality = mesh.tet_field("eas", eas);
    mesh.set_cell_field(quality);
    mesh
}
