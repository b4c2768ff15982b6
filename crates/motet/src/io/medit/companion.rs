//! Reads a mesh and the solution beside it, given either of the two files.

use std::path::{Path, PathBuf};

use super::content::Content;
use super::solution::attach;
use super::source::is_medit;
use crate::base::{Error, Result};
use crate::io::format::{Input, Notes};
use crate::io::reading::read_if_exists;
use crate::mesh::Mesh;

/// Reads a mesh, with the solution of the same name if there is one beside it.
pub(super) fn read_mesh(input: &Input<'_>) -> Result<Mesh> {
    let mut mesh = Content::read(input.bytes, input.notes)?.into_mesh()?;
    let Some((path, bytes)) = find_companion(input.path, "sol")? else { return Ok(mesh) };
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    if !is_medit(&bytes) {
        input.notes.add(format!("{name} is skipped: it is not a Medit solution"));
        return Ok(mesh);
    }
    let solutions = read_solutions(&path, &bytes, input.notes)?;
    if let Err(misfit) = attach(&mut mesh, &solutions.solutions) {
        input.notes.add(format!("{name} is skipped: it {}", misfit.what()));
    }
    Ok(mesh)
}

/// Reads a solution and the mesh beside it.
pub(super) fn read_solution(input: &Input<'_>) -> Result<Mesh> {
    let solutions = read_solutions(input.path, input.bytes, input.notes)?;
    if solutions.solutions.is_empty() {
        return Err(Error::input("there is no solution (SolAtVertices, SolAtTetrahedra, ...)")
            .remedy("the file is damaged or not a solution: get a new copy"));
    }
    let (path, bytes) = find_companion(input.path, "mesh")?.ok_or_else(|| {
        Error::input("there is no mesh of the same name, which the solution needs")
            .remedy("put the .mesh or .meshb file of the same name in the same folder")
    })?;
    let in_companion = |e: Error| e.in_file(&path);
    let mut mesh = Content::read(&bytes, input.notes).and_then(Content::into_mesh).map_err(in_companion)?;
    attach(&mut mesh, &solutions.solutions)?;
    Ok(mesh)
}

fn read_solutions(path: &Path, bytes: &[u8], notes: &Notes) -> Result<Content> {
    Content::read(bytes, notes).map_err(|e| e.in_file(path))
}

/// The file of the same name with the extension `extension`, or with a `b` appended; the same form (text or
/// binary) as `path` is tried first.
fn find_companion(path: &Path, extension: &str) -> Result<Option<(PathBuf, Vec<u8>)>> {
    let is_binary = path.extension().is_some_and(|e| e.to_string_lossy().to_lowercase().ends_with('b'));
    let mut extensions = [extension.to_owned(), format!("{extension}b")];
    if is_binary {
        extensions.reverse();
    }
    for extension in extensions {
        let path = path.with_extension(extension);
        if let Some(bytes) = read_if_exists(&path)? {
            return Ok(Some((path, bytes)));
        }
    }
    Ok(None)
}
