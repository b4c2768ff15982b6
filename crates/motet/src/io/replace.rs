//! Atomic replacement of files: they appear whole or not at all, since they are written beside their targets
//! and then renamed.
//!
//! An existing target is treated as by `cp`: symbolic links are followed, permissions and owner are kept,
//! devices and pipes are written into, and a file without write permission is rejected. Only other hard links
//! keep the old content, which is reported. Missing folders of a target are made.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::base::{Error, Result, Threads};
use crate::io::output::Output;

/// Maximum length of a chain of symbolic links; a longer one is a cycle.
const MAX_LINKS: usize = 40;

/// Writes `bytes` to a temporary file beside `path`, then renames it. Returns notes for the user on the
/// replaced file.
///
/// # Errors
/// If the file cannot be written; the previous content of `path` is then unchanged.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<Vec<String>> {
    replace_all(&[(path.to_owned(), bytes)])
}

/// Writes all files beside their targets, then renames them all: if one cannot be written, none is changed.
///
/// # Errors
/// The errors of [`replace`].
pub fn replace_all(files: &[(PathBuf, &[u8])]) -> Result<Vec<String>> {
    let written: Vec<(&Path, Draft)> = files
        .iter()
        .map(|(path, bytes)| {
            let failed = |e: std::io::Error| Error::output(path, e);
            let mut draft = Draft::new(path)?;
            draft.file().write_all(bytes).map_err(failed)?;
            Ok((path.as_path(), draft))
        })
        .collect::<Result<_>>()?;
    let mut notes = Vec::new();
    for (path, draft) in written {
        notes.extend(draft.persist(path)?);
    }
    Ok(notes)
}

/// Replaces a file like [`replace`], with the output of `write`; also returns the result of `write`.
pub(super) fn replace_with<T>(
    path: &Path,
    threads: &Threads,
    write: impl FnOnce(&mut Output<'_>) -> Result<T>,
) -> Result<(T, Option<String>)> {
    let mut draft = Draft::new(path)?;
    let result = draft.fill(path, threads, write).map_err(|e| e.in_file(path))?;
    Ok((result, draft.persist(path)?))
}

/// Writes a folder of files beside `path`, then renames it. `path` must not exist or be an empty folder.
pub(super) fn replace_folder(path: &Path, files: &[(String, Vec<u8>)]) -> Result<()> {
    let failed = |e: std::io::Error| Error::output(path, e);
    let place = if path.is_dir() { path.canonicalize().map_err(failed)? } else { resolve_links(path)? };
    std::fs::create_dir_all(folder_of(&place)).map_err(failed)?;
    let folder = tempfile::Builder::new().prefix(".motet-").tempdir_in(folder_of(&place)).map_err(failed)?;
    // The temporary folder is private to its owner; the folder inside, which is renamed, has permissions from
    // the umask.
    let inner = folder.path().join("folder");
    for (name, bytes) in files {
        let file = inner.join(name);
        std::fs::create_dir_all(file.parent().unwrap_or(&inner)).map_err(failed)?;
        std::fs::write(file, bytes).map_err(failed)?;
    }
    if let Ok(old) = place.metadata() {
        std::fs::set_permissions(&inner, old.permissions()).map_err(failed)?;
        std::fs::remove_dir(&place).map_err(failed)?;
    }
    std::fs::rename(inner, &place).map_err(failed)
}

/// A file being written, before it takes its target's place.
enum Draft {
    /// A temporary file, its target, and the metadata of the existing target.
    Beside(NamedTempFile, PathBuf, Option<Box<Metadata>>),
    /// A device or pipe, which is written into.
    Into(File),
}

impl Draft {
    fn new(path: &Path) -> Result<Self> {
        let failed = |e: std::io::Error| Error::output(path, e);
        let place = resolve_links(path)?;
        let old = match place.metadata() {
            Err(e) if e.kind() == ErrorKind::NotFound => None,
            Err(e) => return Err(failed(e)),
            Ok(old) => {
                // A file without write permission is not replaced either.
                let file = OpenOptions::new().write(true).open(&place).map_err(failed)?;
                if !old.is_file() {
                    return Ok(Self::Into(file));
                }
                Some(Box::new(old))
            }
        };
        let mut builder = tempfile::Builder::new();
        let prefix = draft_prefix(&place);
        builder.prefix(&prefix);
        // Permissions of a new file, which the umask restricts.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        std::fs::create_dir_all(folder_of(&place)).map_err(failed)?;
        let file = builder.tempfile_in(folder_of(&place)).map_err(failed)?;
        Ok(Self::Beside(file, place, old))
    }

    fn file(&mut self) -> &mut File {
        match self {
            Self::Beside(file, ..) => file.as_file_mut(),
            Self::Into(file) => file,
        }
    }

    /// Writes the output of `write`. A device or pipe, which has no positions, gets it as a whole.
    fn fill<T>(
        &mut self,
        path: &Path,
        threads: &Threads,
        write: impl FnOnce(&mut Output<'_>) -> Result<T>,
    ) -> Result<T> {
        if let Self::Beside(file, ..) = self {
            return write(&mut Output::to_file(file.as_file_mut(), threads));
        }
        let mut bytes = Vec::new();
        let result = write(&mut Output::to_memory(&mut bytes, threads))?;
        self.file().write_all(&bytes).map_err(|e| Error::output(path, e))?;
        Ok(result)
    }

    /// Moves the file to its target.
    fn persist(self, path: &Path) -> Result<Option<String>> {
        let Self::Beside(file, place, old) = self else { return Ok(None) };
        if let Some(old) = &old {
            keep_permissions(file.as_file(), old).map_err(|e| Error::output(path, e))?;
        }
        file.persist(&place).map_err(|e| Error::output(path, e.error))?;
        Ok(old.as_deref().map_or(1, hard_links).checked_sub(1).filter(|&n| n > 0).map(|n| {
            format!("{}: {n} other hard link(s) to the replaced file keep its old content", path.display())
        }))
    }
}

/// Checks whether the folder of a file exists or can be made: nothing but a folder stands in its place.
///
/// # Errors
/// Of kind [`Io`](crate::ErrorKind::Io).
pub fn can_have_folder(path: &Path) -> Result<()> {
    let existing = folder_of(path).ancestors().find(|folder| folder.exists());
    match existing.filter(|folder| !folder.is_dir()) {
        None => Ok(()),
        Some(file) => Err(Error::new(crate::base::ErrorKind::Io, "its folder cannot be made")
            .in_file(path)
            .remedy(format!("{} is a file: give another folder", file.display()))),
    }
}

/// Prefix of the name of a temporary file; [`RANDOM_CHARS`] characters follow.
fn draft_prefix(place: &Path) -> String {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    // File names have at most 255 bytes.
    let end = (0..=name.len().min(MAX_NAME_BYTES)).rev().find(|&i| name.is_char_boundary(i)).unwrap_or(0);
    format!("{DRAFT}{}-", &name[..end])
}

/// Prefix of the names of all temporary files.
pub(super) const DRAFT: &str = ".motet-";

/// Number of random characters at the end of such a name.
const RANDOM_CHARS: usize = 6;

/// Maximum number of bytes of the target's name in such a name.
const MAX_NAME_BYTES: usize = 160;

/// Removes temporary files left by killed processes, for those targets whose names `is_own` accepts. The
/// caller must ensure that no other process is writing files with these names. Files that cannot be removed
/// are left.
pub fn remove_drafts(folder: &Path, is_own: impl Fn(&str) -> bool) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let of = name.to_str().and_then(|name| name.strip_prefix(DRAFT)).and_then(|rest| {
            let (of, random) = rest.split_at_checked(rest.len().checked_sub(RANDOM_CHARS + 1)?)?;
            random.starts_with('-').then_some(of)
        });
        if of.is_some_and(&is_own) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Flushes a file and its directory entry to disk.
///
/// # Errors
/// If the system reports a failure.
pub fn sync(path: &Path) -> Result<()> {
    let failed = |e: std::io::Error| Error::output(path, e);
    // Some systems only sync files opened for writing.
    OpenOptions::new().write(true).open(path).and_then(|file| file.sync_all()).map_err(failed)?;
    sync_folder(folder_of(path)).map_err(failed)
}

/// Flushes `from` to disk and renames it to `to` in the same folder: after a crash at any time, one of the
/// two versions is present and complete.
///
/// # Errors
/// If the system reports a failure.
pub fn settle(from: &Path, to: &Path) -> Result<()> {
    let failed = |e: std::io::Error| Error::output(to, e);
    OpenOptions::new().write(true).open(from).and_then(|file| file.sync_all()).map_err(failed)?;
    std::fs::rename(from, to).map_err(failed)?;
    sync_folder(folder_of(to)).map_err(failed)
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> std::io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> std::io::Result<()> {
    Ok(())
}

pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The target of a path after following symbolic links; the last link may dangle.
fn resolve_links(path: &Path) -> Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MAX_LINKS {
        match place.read_link() {
            Ok(next) => place = folder_of(&place).join(next),
            Err(_) => return Ok(place),
        }
    }
    Err(Error::options("symbolic links form a cycle").in_file(path).remedy("remove the link"))
}

#[cfg(unix)]
fn keep_permissions(file: &File, old: &Metadata) -> std::io::Result<()> {
    use std::os::unix::fs::MetadataExt;
    let new = file.metadata()?;
    if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
        // Only the superuser may change the owner; other users own what they write, as with any editor.
        let _ = std::os::unix::fs::fchown(file, Some(old.uid()), Some(old.gid()));
    }
    file.set_permissions(old.permissions())
}

#[cfg(not(unix))]
fn keep_permissions(file: &File, old: &Metadata) -> std::io::Result<()> {
    file.set_permissions(old.permissions())
}

#[cfg(unix)]
fn hard_links(old: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(old)
}

#[cfg(not(unix))]
fn hard_links(_: &Metadata) -> u64 {
    1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn if_one_of_several_files_cannot_be_written_none_is_changed() {
        let folder = tempfile::tempdir().unwrap();
        let (good, bad) = (folder.path().join("a"), folder.path().join("a/b"));
        replace(&good, b"before").unwrap();
        assert!(replace_all(&[(good.clone(), b"after"), (bad, b"after")]).is_err());
        assert_eq!(std::fs::read(&good).unwrap(), b"before");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn leftover_drafts_are_removed_by_the_names_of_their_targets() {
        let folder = tempfile::tempdir().unwrap();
        let draft = |name: &str| Draft::new(&folder.path().join(name)).unwrap();
        let left: Vec<PathBuf> = ["a.vtu", "b.vtu", &"long".repeat(60)]
            .into_iter()
            .map(|name| match draft(name) {
                Draft::Beside(file, ..) => file.into_temp_path().keep().unwrap(),
                Draft::Into(_) => unreachable!(),
            })
            .collect();
        std::fs::write(folder.path().join("a.vtu"), b"itself").unwrap();
        remove_drafts(folder.path(), |name| name == "a.vtu");
        assert_eq!(left.iter().map(|path| path.exists()).collect::<Vec<_>>(), [false, true, true]);
        assert!(folder.path().join("a.vtu").exists());
        settle(&left[1], &folder.path().join("a.vtu")).unwrap();
        assert_eq!(std::fs::read(folder.path().join("a.vtu")).unwrap(), b"");
        sync(&folder.path().join("a.vtu")).unwrap();
        assert!(sync(&folder.path().join("none")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_permissions_are_kept_and_hard_links_are_reported() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("deep")).unwrap();
        std::fs::write(at("deep/file"), b"before").unwrap();
        std::fs::set_permissions(at("deep/file"), PermissionsExt::from_mode(0o604)).unwrap();
        symlink("deep/file", at("one")).unwrap();
        symlink("one", at("two")).unwrap();
        assert_eq!(replace(&at("two"), b"after").unwrap(), Vec::<String>::new());
        assert!(at("two").is_symlink() && at("one").is_symlink());
        assert_eq!(std::fs::read(at("deep/file")).unwrap(), b"after");
        assert_eq!(std::fs::metadata(at("deep/file")).unwrap().permissions().mode() & 0o777, 0o604);

        symlink("deep/new", at("dangling")).unwrap();
        replace(&at("dangling"), b"new").unwrap();
        assert_eq!(std::fs::read(at("deep/new")).unwrap(), b"new");

        std::fs::hard_link(at("deep/file"), at("other")).unwrap();
        let notes = replace(&at("one"), b"once more").unwrap();
        assert!(notes[0].contains("1 other hard link"), "{notes:?}");
        assert_eq!(std::fs::read(at("other")).unwrap(), b"after");

        symlink("round", at("round")).unwrap();
        assert!(replace(&at("round"), b"").unwrap_err().to_string().contains("cycle"));
        assert!(replace(&at("deep"), b"").is_err(), "a folder is not a file");
        replace(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
    }
}
