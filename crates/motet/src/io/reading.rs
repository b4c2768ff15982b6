//! Reading in a known format: the steps before and after the reader that all formats share.

use std::path::Path;

use crate::base::{Error, ErrorKind, Result, Threads};
use crate::io::format::{Format, Input, Notes};
use crate::io::{foreign, ghosts, vtkxml};
use crate::mesh::Mesh;

/// Reads the file or folder `path` in the given format.
pub(super) fn read_file(format: &Format, path: &Path, threads: &Threads, notes: &Notes) -> Result<Mesh> {
    if let Some(tail) = vtkxml::Tail::of(path) {
        return checked(vtkxml::read_tail(&tail, threads, notes), path, notes);
    }
    let bytes = match format.is_folder() {
        true => Vec::new(),
        false => std::fs::read(path).map_err(|e| Error::io(path, e))?,
    };
    read_as(format, &Input { path, bytes: &bytes, threads, notes })
}

/// Reads `input` in the given format.
///
/// # Errors
/// The errors of [`read`](super::read).
pub fn read_as(format: &Format, input: &Input<'_>) -> Result<Mesh> {
    let Some(read) = format.read else {
        return Err(Error::new(ErrorKind::Input, format!("{} files can only be written", format.name))
            .in_file(input.path));
    };
    if !format.is_folder() {
        refuse_non_meshes(input.bytes).map_err(|e| e.in_file(input.path))?;
        foreign::refuse(input.path, input.bytes, format.extensions)?;
    }
    checked(read(input), input.path, input.notes)
}

/// Validates the result of a reader and removes ghost cells; adds the file and a remedy to errors.
pub(super) fn checked(mesh: Result<Mesh>, path: &Path, notes: &Notes) -> Result<Mesh> {
    let damaged = |e: Error| e.in_file(path).remedy("the file is damaged or invalid: write it again");
    let mut mesh = mesh.map_err(damaged)?;
    mesh.validate().map_err(damaged)?;
    ghosts::remove_ghosts(&mut mesh, notes);
    Ok(mesh)
}

/// Rejects content that cannot be a mesh in any format.
fn refuse_non_meshes(bytes: &[u8]) -> Result<()> {
    if bytes.is_empty() {
        return Err(Error::input("is empty (0 bytes)").remedy("get a new copy of the file"));
    }
    if bytes.starts_with(b"version https://git-lfs.github.com/spec/") {
        return Err(
            Error::input("is a Git LFS pointer, not the file itself").remedy("fetch the file: git lfs pull")
        );
    }
    Ok(())
}

/// Whether two paths lead to the same existing file.
pub fn is_same_file(a: impl AsRef<Path>, b: impl AsRef<Path>) -> bool {
    let [a, b] = [a.as_ref(), b.as_ref()].map(|path| path.canonicalize().ok());
    a.is_some() && a == b
}

/// The content of a file that may be missing, such as a companion of the file being read.
pub(super) fn read_if_exists(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::io(path, e)),
    }
}
