//! Locks that admit one writer of an output at a time. The system releases a lock when its process ends,
//! however it ends.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use crate::base::{Error, Result};
use crate::io::replace::{DRAFT, folder_of};

/// Attempts to take a lock: its holder removes the lock file on release, so a file just opened may no longer
/// exist.
const MAX_ATTEMPTS: usize = 16;

/// A lock on an output, held until it is dropped.
#[derive(Debug)]
pub struct OutputLock {
    path: PathBuf,
    /// The locked file; closing it releases the lock. `None` on a file system without locks.
    file: Option<File>,
}

impl OutputLock {
    /// Takes the lock of an output, whose folder is made if it does not exist. On a file system without locks
    /// the result does not hold, see [`Self::is_held`].
    ///
    /// # Errors
    /// If another process holds the lock, or the lock file beside the output cannot be created.
    pub fn take(output: &Path) -> Result<Self> {
        let name = output.file_name().unwrap_or_default().to_string_lossy();
        let path = folder_of(output).join(format!("{DRAFT}{name}.lock"));
        let failed = |e: std::io::Error| Error::output(&path, e);
        std::fs::create_dir_all(folder_of(output)).map_err(failed)?;
        for _ in 0..MAX_ATTEMPTS {
            let open = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let mut file = open.map_err(failed)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(busy(output, &mut file)),
                Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => {
                    return Ok(Self { path, file: None });
                }
                Err(TryLockError::Error(e)) => return Err(failed(e)),
            }
            if still_at(&file, &path) {
                file.set_len(0).map_err(failed)?;
                writeln!(file, "{}", std::process::id()).map_err(failed)?;
                return Ok(Self { path, file: Some(file) });
            }
        }
        Err(Error::new(
            crate::base::ErrorKind::Output,
            "the lock could not be taken: other processes keep taking it",
        )
        .in_file(path))
    }

    /// Whether the lock excludes other processes; false on a file system without locks.
    pub fn is_held(&self) -> bool {
        self.file.is_some()
    }
}

impl Drop for OutputLock {
    fn drop(&mut self) {
        // Unix allows the removal of an open file; elsewhere the file remains, unlocked.
        if cfg!(unix) {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

fn busy(output: &Path, file: &mut File) -> Error {
    let mut holder = String::new();
    let holder = match file.take(20).read_to_string(&mut holder).is_ok().then(|| holder.trim().parse::<u32>())
    {
        Some(Ok(id)) => format!(" (process {id})"),
        _ => String::new(),
    };
    Error::new(crate::base::ErrorKind::Output, format!("another run{holder} is writing to this output"))
        .in_file(output)
        .remedy("wait until it ends, or give this run another output")
}

#[cfg(unix)]
fn still_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let key = |m: &std::fs::Metadata| (m.dev(), m.ino());
    matches!((file.metadata(), path.metadata()), (Ok(a), Ok(b)) if key(&a) == key(&b))
}

#[cfg(not(unix))]
fn still_at(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_holder_has_the_lock_and_its_file_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("run.pvd");
        let held = OutputLock::take(&output).unwrap();
        assert!(held.is_held());
        let error = OutputLock::take(&output).unwrap_err().to_string();
        assert!(error.contains("run.pvd") && error.contains(&std::process::id().to_string()), "{error}");
        assert!(OutputLock::take(&folder.path().join("other.pvd")).is_ok());
        drop(held);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        // A lock file left by a killed process does not lock.
        std::fs::write(folder.path().join(".motet-run.pvd.lock"), "4000000000\n").unwrap();
        assert!(OutputLock::take(&output).unwrap().is_held());
    }
}
