//! Where the files of a case are.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::base::{Error, Result};

/// zlib makes no more than so many bytes of one (its own documentation: 1032 to 1).
const MOST_BYTES_OF_ONE: u64 = 1032;

/// Whether a folder is a case, or its `polyMesh`.
pub(in crate::io) fn is_case(path: &Path) -> bool {
    path.is_dir() && mesh_folder(path).is_some()
}

/// Whether a folder that is to be written is called `polyMesh`.
pub(in crate::io) fn is_to_be_one(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.eq_ignore_ascii_case("polyMesh"))
}

/// The folder that has the mesh of a case.
pub(super) fn mesh_folder(path: &Path) -> Option<PathBuf> {
    let case = if path.is_dir() {
        path
    } else {
        path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    };
    let holds_mesh = |folder: &PathBuf| find(folder, "faces").is_some() && find(folder, "owner").is_some();
    [case.to_owned(), case.join("polyMesh"), case.join("constant/polyMesh")].into_iter().find(holds_mesh)
}

/// A file of the mesh, packed or not.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    [name.to_owned(), format!("{name}.gz")]
        .into_iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())
}

/// Where a file of the mesh is, and its bytes, unpacked; `None` where there is none.
pub(super) fn load(folder: &Path, name: &str) -> Result<Option<(PathBuf, Vec<u8>)>> {
    let Some(path) = find(folder, name) else { return Ok(None) };
    let bytes = std::fs::read(&path).map_err(|e| Error::io(&path, &e))?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(Some((path, bytes)));
    }
    let (most, mut unpacked) = (MOST_BYTES_OF_ONE * bytes.len() as u64, Vec::new());
    let read = flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(most).read_to_end(&mut unpacked);
    read.map_err(|e| {
        Error::input(format!("cannot be unpacked: {e}")).in_file(&path).remedy("get the file again")
    })?;
    Ok(Some((path, unpacked)))
}
