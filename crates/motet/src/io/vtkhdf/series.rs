//! Addresses the steps of a transient file as files: `flow.vtkhdf#3` is step 3 of `flow.vtkhdf`, counted from
//! 0.

use std::path::{Path, PathBuf};

use crate::base::{Error, Result};
use crate::io::format::Notes;
use crate::io::hdf::open_in_place;
use crate::io::vtkhdf::FORMAT;
use crate::io::vtkhdf::frame::{Frame, Steps};
use crate::io::vtkhdf::read::{mesh_of, root_of};
use crate::mesh::Mesh;

/// A step of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::io) struct StepPath {
    pub(in crate::io) file: PathBuf,
    pub(in crate::io) step: usize,
}

impl StepPath {
    /// Parses a path; `None` if it is not that of a step.
    pub(in crate::io) fn of(path: &Path) -> Option<Self> {
        let (name, step) = path.file_name()?.to_str()?.rsplit_once('#')?;
        let step = step.parse().ok()?;
        has_extension(name).then(|| Self { file: path.with_file_name(name), step })
    }

    /// The path of the step.
    fn path(&self) -> PathBuf {
        let mut path = self.file.clone().into_os_string();
        path.push(format!("#{}", self.step));
        path.into()
    }
}

fn has_extension(name: &str) -> bool {
    let name = name.to_lowercase();
    FORMAT.extensions.iter().any(|extension| name.ends_with(extension))
}

/// Whether the file name has the extension of VTKHDF.
pub(in crate::io) fn is_vtkhdf_name(path: &Path) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(has_extension)
}

/// Whether this is an existing file with several steps.
pub(in crate::io) fn is_transient(path: &Path) -> bool {
    is_vtkhdf_name(path) && path.is_file() && times(path).is_ok_and(|frames| frames.len() > 1)
}

/// The times of a file and the path of each step.
pub(in crate::io) fn times(path: &Path) -> Result<Vec<(f64, PathBuf)>> {
    let steps = Steps::of(&root_of(&open_in_place(path)?)?)?;
    let times = steps.ok_or_else(|| Error::input("contains a single mesh without steps"))?.times;
    if let Some(k) = times.iter().position(|t| !t.is_finite()) {
        return Err(Error::input(format!("the time of step {k} is not finite")).at("/VTKHDF/Steps/Values"));
    }
    let path_of = |step| StepPath { file: path.to_owned(), step }.path();
    Ok(times.into_iter().enumerate().map(|(step, time)| (time, path_of(step))).collect())
}

/// Reads the mesh of a step, and no other part of the file.
pub(in crate::io) fn read_step(path: &StepPath, notes: &Notes) -> Result<Mesh> {
    let root = root_of(&open_in_place(&path.file)?)?;
    let steps = Steps::of(&root)?.ok_or_else(|| Error::input("contains a single mesh without steps"))?;
    if path.step >= steps.times.len() {
        let n = steps.times.len();
        return Err(Error::input(format!("there is no step {}", path.step))
            .remedy(format!("give a step from 0 to {}", n - 1)));
    }
    mesh_of(&root, &Frame::of_step(&root, &steps, path.step)?, notes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_means_a_step_or_a_file() {
        let step = StepPath::of(Path::new("a b/flow.VtkHdf#12")).unwrap();
        assert_eq!((step.file.as_path(), step.step), (Path::new("a b/flow.VtkHdf"), 12));
        assert_eq!(step.path(), Path::new("a b/flow.VtkHdf#12"));
        for other in [
            "flow.vtkhdf",
            "flow.vtkhdf#",
            "flow.vtkhdf#x",
            "flow.vtu#1",
            "#1",
            "a#1/flow.hdf",
            "flow.hdf#-1",
        ] {
            assert_eq!(StepPath::of(Path::new(other)), None, "{other}");
        }
    }
}
