//! Files that appear whole or not at all: written beside their place, then renamed into it.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::base::{Error, Result};

/// Writes `bytes` beside `path`, then renames into place.
///
/// # Errors
/// When the system refuses the file; what stood at `path` before is then still there.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<()> {
    replace_all(&[(path.to_owned(), bytes)])
}

/// Writes all files beside their places, then renames them all: as long as one
/// cannot be written, none is touched.
///
/// # Errors
/// As [`replace`].
pub fn replace_all(files: &[(PathBuf, &[u8])]) -> Result<()> {
    let written: Vec<(&Path, NamedTempFile)> = files
        .iter()
        .map(|(path, bytes)| write_beside(path, bytes).map(|file| (path.as_path(), file)))
        .collect::<Result<_>>()?;
    written.into_iter().try_for_each(|(path, file)| match file.persist(path) {
        Ok(_) => Ok(()),
        Err(e) => Err(Error::io(path, &e.error)),
    })
}

/// As [`replace`], with what `write` gives to the file.
pub(super) fn replace_with<T>(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<T>) -> Result<T> {
    let mut file = create_beside(path)?;
    let result = write(&mut file).map_err(|e| e.in_file(path))?;
    file.persist(path).map_err(|e| Error::io(path, &e.error))?;
    Ok(result)
}

/// Writes a folder of files beside `path`, then renames it into place. Nothing stands at `path`, or an empty folder.
pub(super) fn replace_folder(path: &Path, files: &[(String, Vec<u8>)]) -> Result<()> {
    let told = |e: std::io::Error| Error::io(path, &e);
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = tempfile::Builder::new().prefix(".motet-").tempdir_in(parent).map_err(told)?;
    // Inside a folder that is its owner's alone; the one that is renamed has the rights that the user's umask says.
    let inner = folder.path().join("folder");
    for (name, bytes) in files {
        let file = inner.join(name);
        std::fs::create_dir_all(file.parent().unwrap_or(&inner)).map_err(told)?;
        std::fs::write(file, bytes).map_err(told)?;
    }
    if path.is_dir() {
        std::fs::remove_dir(path).map_err(told)?;
    }
    std::fs::rename(inner, path).map_err(told)
}

fn write_beside(path: &Path, bytes: &[u8]) -> Result<NamedTempFile> {
    let mut file = create_beside(path)?;
    file.write_all(bytes).map_err(|e| Error::io(path, &e))?;
    Ok(file)
}

fn create_beside(path: &Path) -> Result<NamedTempFile> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".motet-");
    // As any program creates a file: readable for whom the user's umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|e| Error::io(path, &e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn when_one_of_several_files_cannot_be_written_none_is_touched() {
        let folder = tempfile::tempdir().unwrap();
        let (good, bad) = (folder.path().join("a"), folder.path().join("missing/b"));
        replace(&good, b"before").unwrap();
        assert!(replace_all(&[(good.clone(), b"after"), (bad, b"after")]).is_err());
        assert_eq!(std::fs::read(&good).unwrap(), b"before");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
