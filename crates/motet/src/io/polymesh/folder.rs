//! Locates the files of a case.

use std::path::{Path, PathBuf};

use crate::base::{Error, Result};
use crate::io::gzip;

/// Whether a folder is a case or its `polyMesh` folder.
pub(in crate::io) fn is_case(path: &Path) -> bool {
    path.is_dir() && mesh_folder(path).is_some()
}

/// Whether a folder to be written is called `polyMesh`.
pub(in crate::io) fn is_polymesh_name(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.eq_ignore_ascii_case("polyMesh"))
}

/// The folder with the mesh of a case.
pub(super) fn mesh_folder(path: &Path) -> Option<PathBuf> {
    let case = if path.is_dir() {
        path
    } else {
        path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    };
    let holds_mesh = |folder: &PathBuf| find(folder, "faces").is_some() && find(folder, "owner").is_some();
    [case.to_owned(), case.join("polyMesh"), case.join("constant/polyMesh")].into_iter().find(holds_mesh)
}

/// The path of a mesh file, compressed or not.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    [name.to_owned(), format!("{name}.gz")]
        .into_iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())
}

/// The path of a mesh file and its decompressed bytes; `None` if there is no such file.
pub(super) fn load(folder: &Path, name: &str) -> Result<Option<(PathBuf, Vec<u8>)>> {
    let Some(path) = find(folder, name) else { return Ok(None) };
    let bytes = std::fs::read(&path).map_err(|e| Error::io(&path, e))?;
    if !gzip::is_gzip(&bytes) {
        return Ok(Some((path, bytes)));
    }
    let decompressed = gzip::decompress(&bytes).map_err(|e| e.in_file(&path))?;
    Ok(Some((path, decompressed)))
}
