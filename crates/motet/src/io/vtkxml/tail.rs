//! Raw appended arrays left in the file and read one by one.
//!
//! When large uncompressed files were read as a whole, half of the time went into memory that is filled once
//! and then discarded (53 MB: 26 ms of 46 ms); reading the same bytes directly into their arrays takes 4 ms.

use std::fs::File;
use std::io::Read as _;
#[cfg(not(unix))]
use std::io::Seek as _;
use std::path::Path;

use crate::base::{Error, Result};
use crate::io::vtkxml::document::Document;

/// Files below this size are read as a whole.
const MIN_TAIL_FILE_BYTES: u64 = 256 << 10;
/// Maximum size of the elements before the appended data, which are usually much shorter.
const MAX_HEAD_BYTES: u64 = 1 << 20;

/// A file whose head is in memory and whose raw appended data are not.
#[derive(Debug)]
pub(in crate::io) struct Tail {
    file: File,
    /// The bytes before the first one of the appended data.
    pub(super) head: Vec<u8>,
    /// Number of bytes after the head.
    pub(super) len: usize,
}

impl Tail {
    /// Opens a file and reads only its head; `None` for a file to be read as a whole: one without the
    /// extension of VTU or VTP, a small one, one without raw appended data, or one that cannot be read.
    pub(in crate::io) fn of(path: &Path) -> Option<Self> {
        path.extension().filter(|e| e.eq_ignore_ascii_case("vtu") || e.eq_ignore_ascii_case("vtp"))?;
        let mut file = File::open(path).ok()?;
        let size = file.metadata().ok().filter(|m| m.is_file() && m.len() >= MIN_TAIL_FILE_BYTES)?.len();
        let mut head = Vec::new();
        (&mut file).take(MAX_HEAD_BYTES).read_to_end(&mut head).ok()?;
        let start = appended_start(&head)?;
        head.truncate(start);
        head.shrink_to_fit();
        Some(Self { file, head, len: usize::try_from(size - start as u64).ok()? })
    }

    /// Fills `out` with the appended data from byte `at`. Several threads may read at the same time.
    pub(super) fn read_at(&self, at: usize, out: &mut [u8]) -> Result<()> {
        read_exact_at(&self.file, out, (self.head.len() + at) as u64)
            .map_err(|e| Error::input(format!("the file could not be read: {e}")).remedy("try again"))
    }
}

#[cfg(unix)]
fn read_exact_at(file: &File, out: &mut [u8], place: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, out, place)
}

/// One thread reads at a time, since a handle has one position for all.
#[cfg(not(unix))]
fn read_exact_at(file: &File, out: &mut [u8], place: u64) -> std::io::Result<()> {
    let _one_at_a_time = READING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut file = file;
    file.seek(std::io::SeekFrom::Start(place)).and_then(|_| file.read_exact(out))
}

/// Held by the thread that reads.
#[cfg(not(unix))]
static READING: std::sync::Mutex<()> = std::sync::Mutex::new(());

/// Where raw appended data start, after the underscore. Determined by the parser, since a text search would
/// also find comments and other attributes.
fn appended_start(head: &[u8]) -> Option<usize> {
    let appended = Document::parse(head).ok()?.appended.filter(|appended| !appended.base64)?;
    Some(head.len() - appended.bytes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raw_data_start_after_the_underscore() {
        let head = b"<V><AppendedData encoding=\"raw\">\n _xyz";
        assert_eq!(appended_start(head).map(|start| &head[start..]), Some(b"xyz".as_slice()));
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"base64\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"raw\">\n "), None);
        assert_eq!(appended_start(b"<V></V>"), None);
    }

    #[test]
    fn files_that_only_seem_to_have_raw_data_are_read_whole() {
        // VTK's default encoding is base64.
        assert_eq!(appended_start(b"<V><AppendedData encod#ng=\"raw\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"base64\" note=\"raw\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><!-- <AppendedData encoding=\"raw\"> _x --><B/></V>"), None);
    }
}
