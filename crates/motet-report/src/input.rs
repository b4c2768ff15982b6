//! The inputs of a report: meshes, series of them, and reports or logs in JSON.

use std::path::{Path, PathBuf};

use motet::{Error, Mesh, Result, io};

use crate::log::{self, Log};

/// One input of a report.
#[derive(Debug)]
pub(crate) enum Input {
    Meshes(Meshes),
    Log(Log),
}

/// A mesh, or a series of meshes that may change from frame to frame.
#[derive(Debug)]
pub(crate) struct Meshes {
    pub(crate) file: PathBuf,
    pub(crate) is_series: bool,
    /// The time and the source of each frame.
    pub(crate) frames: Vec<(f64, Source)>,
}

/// Where a frame comes from.
#[derive(Debug)]
pub(crate) enum Source {
    File(PathBuf),
    Memory(Box<Mesh>),
}

impl Input {
    /// Finds out what an input is; meshes are read later, one at a time.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("json") => return log::read_object(path).map(Self::Log),
            Some("jsonl" | "ndjson") => return log::read_lines(path).map(Self::Log),
            _ => {}
        }
        let is_series = io::is_series(path);
        let files = if is_series { io::read_series(path)? } else { vec![(0.0, path.to_owned())] };
        let frames: Vec<_> = files.into_iter().map(|(time, file)| (time, Source::File(file))).collect();
        if frames.is_empty() {
            return Err(Error::input("the series has no frames: there is nothing to show").in_file(path));
        }
        Ok(Self::Meshes(Meshes { file: path.to_owned(), is_series, frames }))
    }
}

impl Meshes {
    /// Reads one frame, with notes on what the reader skipped.
    pub(crate) fn read(&self, frame: usize) -> Result<(Mesh, Vec<String>)> {
        match &self.frames[frame].1 {
            Source::File(file) => io::read_noted(file),
            Source::Memory(mesh) => Ok((Mesh::clone(mesh), Vec::new())),
        }
    }

    /// The file of a frame.
    pub(crate) fn file_of(&self, frame: usize) -> &Path {
        match &self.frames[frame].1 {
            Source::File(file) => file,
            Source::Memory(_) => &self.file,
        }
    }
}

/// The name of a file on the page: without folders, so that a report reveals nothing about the machine.
pub(crate) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
