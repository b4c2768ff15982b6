//! The raw appended arrays of a file, read one by one instead of all at once.
//!
//! Half of the time of reading a large uncompressed file whole went into memory
//! that is filled once and thrown away (53 MB: 26 ms of 46 ms); from the file into
//! the array it belongs to, the same bytes take 4 ms.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use crate::base::{Error, Result};
use crate::io::vtkxml::document::Document;

/// Smaller files are read whole.
const SMALL: u64 = 256 << 10;
/// The elements in front of appended data are much shorter.
const LONGEST_HEAD: u64 = 1 << 20;

/// A file whose head is in memory and whose raw appended data is not.
#[derive(Debug)]
pub(in crate::io) struct Tail {
    file: File,
    /// All up to the first byte of the appended data.
    pub(super) head: Vec<u8>,
    /// Bytes behind the head.
    pub(super) len: usize,
}

impl Tail {
    /// `None` for a file that is to be read whole: one that is no VTU or VTP file by
    /// its ending, a small one, one without raw appended data, one that cannot be read.
    pub(in crate::io) fn of(path: &Path) -> Option<Self> {
        path.extension().filter(|e| e.eq_ignore_ascii_case("vtu") || e.eq_ignore_ascii_case("vtp"))?;
        let mut file = File::open(path).ok()?;
        let size = file.metadata().ok().filter(|m| m.is_file() && m.len() >= SMALL)?.len();
        let mut head = Vec::new();
        (&mut file).take(LONGEST_HEAD).read_to_end(&mut head).ok()?;
        let start = appended_start(&head)?;
        head.truncate(start);
        head.shrink_to_fit();
        Some(Self { file, head, len: usize::try_from(size - start as u64).ok()? })
    }

    /// Fills `out` from byte `at` of the appended data on.
    pub(super) fn read_at(&self, at: usize, out: &mut [u8]) -> Result<()> {
        let mut file = &self.file;
        let place = (self.head.len() + at) as u64;
        let read = file.seek(SeekFrom::Start(place)).and_then(|_| file.read_exact(out));
        read.map_err(|e| Error::input(format!("the file could not be read on: {e}")).remedy("read it again"))
    }
}

/// Where raw appended data starts, behind the underscore. The parser says it, and not a search for words: these stand
/// in comments and in other attributes, too.
fn appended_start(head: &[u8]) -> Option<usize> {
    let appended = Document::parse(head).ok()?.appended.filter(|appended| !appended.base64)?;
    Some(head.len() - appended.bytes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raw_data_starts_behind_the_underscore() {
        let head = b"<V><AppendedData encoding=\"raw\">\n _xyz";
        assert_eq!(appended_start(head).map(|start| &head[start..]), Some(b"xyz".as_slice()));
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"base64\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"raw\">\n "), None);
        assert_eq!(appended_start(b"<V></V>"), None);
    }

    #[test]
    fn what_only_looks_like_raw_data_is_read_whole() {
        // Base64 is what VTK takes where the encoding is not told.
        assert_eq!(appended_start(b"<V><AppendedData encod#ng=\"raw\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><AppendedData encoding=\"base64\" note=\"raw\">\n _xyz"), None);
        assert_eq!(appended_start(b"<V><!-- <AppendedData encoding=\"raw\"> _x --><B/></V>"), None);
    }
}
