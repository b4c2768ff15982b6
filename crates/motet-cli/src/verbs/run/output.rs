//! What a run writes: the series, a line a step, the state to go on from.
//!
//! Lines and meshes are the same bytes however often a run was stopped; what the clock said has a file of its own.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use motet::geometry::quality::eas;
use motet::io::{SeriesWriter, WriteOptions, replace};
use motet::mesh::Field;
use motet::moving::{MovingMesh, Step};
use motet::{Error, Mesh, Result};
use serde_json::{Value, json};

use super::job::Job;

/// Where all goes.
pub(super) struct Output {
    pub(super) series_file: PathBuf,
    series: SeriesWriter,
    every: usize,
    pub(super) log: PathBuf,
    times: PathBuf,
    state: PathBuf,
}

impl Output {
    pub(super) fn new(job: &Job) -> Result<Self> {
        let series_file = job.path(&job.output);
        let folder = series_file.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.map_or(Ok(()), std::fs::create_dir_all).map_err(|e| Error::io(&series_file, &e))?;
        Ok(Self {
            series: SeriesWriter::new(&series_file, WriteOptions::default()),
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

    /// What an earlier run has written up to a step stays, and no more.
    pub(super) fn go_on(&mut self, step: usize) -> Result<()> {
        self.series.go_on_after(1 + step / self.every)?;
        for file in [&self.log, &self.times] {
            let text = std::fs::read_to_string(file).map_err(|e| Error::io(file, &e))?;
            let lines: String = text.split_inclusive('\n').take(step + 1).collect();
            replace(file, lines.as_bytes())?;
        }
        Ok(())
    }

    /// The first frame; what an earlier run has left goes.
    pub(super) fn first(&mut self, moving: &MovingMesh, step: &Step) -> Result<()> {
        if self.state.is_file() {
            std::fs::remove_file(&self.state).map_err(|e| Error::io(&self.state, &e))?;
        }
        for file in [&self.log, &self.times] {
            replace(file, b"")?;
        }
        self.take(moving, step)
    }

    /// Writes a step: the frame where one is due, then the lines, then the state.
    pub(super) fn take(&mut self, moving: &MovingMesh, step: &Step) -> Result<()> {
        let is_due = step.step.is_multiple_of(self.every) || !step.complete;
        let file =
            is_due.then(|| self.series.add(step.time, &frame(moving))).transpose()?.map(|(file, _)| file);
        let mut line = serde_json::to_value(step).map_err(|e| Error::io(&self.log, &e.into()))?;
        let seconds = line.as_object_mut().and_then(|line| line.remove("seconds")).unwrap_or(Value::Null);
        if let (Some(line), Some(file)) = (line.as_object_mut(), &file) {
            line.insert("file".into(), json!(file.file_name().map(|name| name.to_string_lossy())));
        }
        append(&self.log, &line)?;
        append(&self.times, &json!({ "step": step.step, "seconds": seconds }))?;
        if step.complete {
            moving.save(&self.state)?;
        }
        Ok(())
    }
}

fn append(file: &Path, line: &Value) -> Result<()> {
    let told = |e: &std::io::Error| Error::io(file, e);
    let mut out = OpenOptions::new().append(true).create(true).open(file).map_err(|e| told(&e))?;
    // One write a line: a run that is killed leaves whole lines, or a last one that resuming cuts off.
    out.write_all(format!("{line}\n").as_bytes()).map_err(|e| told(&e))
}

/// The mesh with what the step says of it as arrays.
fn frame(moving: &MovingMesh) -> Mesh {
    let mut mesh = moving.mesh().clone();
    mesh.set_point_field(Field::vectors("displacement", &moving.displacement()));
    mesh.set_point_field(Field::vectors("velocity", &moving.velocity()));
    if let Some(gaps) = moving.gaps() {
        // Where nothing is measured there is no number.
        let gap =
            gaps.at_points(mesh.points.len()).into_iter().map(|x| if x.is_finite() { x } else { f64::NAN });
        mesh.set_point_field(Field::scalars("gap", gap.collect::<Vec<_>>()));
    }
    let quality = mesh.tet_field("eas", eas);
    mesh.set_cell_field(quality);
    mesh
}
