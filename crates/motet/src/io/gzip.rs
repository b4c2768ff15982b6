//! Compresses gzip files, and decompresses them up to a memory limit.

use std::io::{Read as _, Write as _};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;

use crate::base::{Error, Result};
use crate::io::memory_budget::MemoryBudget;

/// Whether the bytes begin with the gzip signature.
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// The decompressed content of a gzip file.
///
/// Fails if the file is damaged, or decompresses to more than files of its size may.
pub(super) fn decompress(bytes: &[u8]) -> Result<Vec<u8>> {
    let budget = MemoryBudget::of(bytes.len() as u64);
    let limit = budget.remaining();
    let mut content = Vec::new();
    MultiGzDecoder::new(bytes).take(limit.saturating_add(1)).read_to_end(&mut content).map_err(|e| {
        Error::input(format!("cannot be decompressed: {e}"))
            .at(format!("after {} decompressed bytes", content.len()))
            .remedy("the file is truncated or damaged: get a new copy")
    })?;
    if content.len() as u64 > limit { Err(budget.exceeded()) } else { Ok(content) }
}

/// The content of a gzip file that holds `bytes`.
pub(super) fn compress(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    let infallible = "writing into memory does not fail";
    encoder.write_all(bytes).expect(infallible);
    encoder.finish().expect(infallible)
}
