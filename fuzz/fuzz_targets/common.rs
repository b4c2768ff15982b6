//! Shared by the targets of file formats: bytes in, a mesh or an error out.
#![allow(dead_code, reason = "each target uses its part")]

use std::path::Path;

use motet::Mesh;
use motet::base::Threads;
use motet::io::{Format, Input, Notes, WriteOptions, formats, read_as};

fn format(extension: &str) -> &'static Format {
    formats().iter().find(|f| f.extensions.contains(&extension)).expect("the format is registered")
}

/// Reads `bytes` as a file with this extension. A mesh that results is valid.
pub fn read(extension: &str, bytes: &[u8]) -> Option<Mesh> {
    let path = format!("in{extension}");
    let input =
        Input { path: Path::new(&path), bytes, threads: &Threads::single(), notes: &Notes::default() };
    let mesh = read_as(format(extension), &input).ok()?;
    mesh.validate().expect("a reader returns a mesh that holds together");
    Some(mesh)
}

/// Writes a mesh; returns the first file written, and whether nothing was lost.
pub fn write(extension: &str, mesh: &Mesh) -> (Vec<u8>, bool) {
    let written = format(extension).to_files(mesh, &WriteOptions::default(), &Threads::single());
    let mut written = written.expect("what is read can be written");
    (written.files.swap_remove(0).1, written.lost.is_empty())
}

/// Writes a mesh like [`write`], if the format can hold it.
pub fn try_write(extension: &str, mesh: &Mesh) -> Option<(Vec<u8>, bool)> {
    let mut written = format(extension).to_files(mesh, &WriteOptions::default(), &Threads::single()).ok()?;
    Some((written.files.swap_remove(0).1, written.lost.is_empty()))
}

/// Checks that what can be read can be written and read again, with the same number of points, and with the
/// same cells where nothing was lost.
pub fn there_and_back(extension: &str, bytes: &[u8]) {
    let Some(mesh) = read(extension, bytes) else { return };
    let (again, complete) = write(extension, &mesh);
    let again = read(extension, &again).expect("what is written is read");
    assert_eq!(again.points.len(), mesh.points.len());
    if complete {
        assert_eq!(again.cells, mesh.cells);
    }
}
