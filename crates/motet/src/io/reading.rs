//! Reading in a format that is known: what is the same for each of them, before and behind its reader.

use std::path::Path;

use crate::base::{Error, ErrorKind, Result};
use crate::io::format::{Format, Input, Notes};
use crate::io::{foreign, ghosts, vtkxml};
use crate::mesh::Mesh;

/// Reads the file or folder `path` in the given format.
pub(super) fn read_file(format: &Format, path: &Path, notes: &Notes) -> Result<Mesh> {
    if let Some(tail) = vtkxml::Tail::of(path) {
        return checked(vtkxml::read_tail(&tail, notes), path, notes);
    }
    let bytes = match format.is_folder() {
        true => Vec::new(),
        false => std::fs::read(path).map_err(|e| Error::io(path, e))?,
    };
    read_as(format, &Input { path, bytes: &bytes, notes })
}

/// Reads `input` in the given format.
///
/// # Errors
/// As [`read`](super::read).
pub fn read_as(format: &Format, input: &Input<'_>) -> Result<Mesh> {
    let Some(read) = format.read else {
        return Err(Error::new(ErrorKind::Input, format!("{} files can only be written", format.name))
            .in_file(input.path));
    };
    if !format.is_folder() {
        refuse_stand_ins(input.bytes).map_err(|e| e.in_file(input.path))?;
        foreign::refuse(input.path, input.bytes, format.endings)?;
    }
    checked(read(input), input.path, input.notes)
}

/// What a reader returned, found to hold together; errors with the file and a remedy.
pub(super) fn checked(mesh: Result<Mesh>, path: &Path, notes: &Notes) -> Result<Mesh> {
    let told = |e: Error| e.in_file(path).remedy("the file is damaged, or was written wrong: write it again");
    let mut mesh = mesh.map_err(told)?;
    mesh.validate().map_err(told)?;
    ghosts::leave_out(&mut mesh, notes);
    Ok(mesh)
}

/// Refuses what lies in place of a mesh, whatever the format.
fn refuse_stand_ins(bytes: &[u8]) -> Result<()> {
    if bytes.is_empty() {
        return Err(Error::input("is empty (0 bytes)").remedy("get the file again"));
    }
    if bytes.starts_with(b"version https://git-lfs.github.com/spec/") {
        return Err(Error::input("is a pointer of Git LFS, not the file itself")
            .remedy("fetch the file: git lfs pull"));
    }
    Ok(())
}

/// Whether two paths lead to one file that is there.
pub fn is_same_file(a: impl AsRef<Path>, b: impl AsRef<Path>) -> bool {
    let [a, b] = [a.as_ref(), b.as_ref()].map(|path| path.canonicalize().ok());
    a.is_some() && a == b
}

/// The content of a file that may be missing, such as one that belongs to the file named.
pub(super) fn read_beside(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::io(path, e)),
    }
}
