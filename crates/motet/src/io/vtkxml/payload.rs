//! The bytes of one binary array: its header, its blocks, and their decompression.
//!
//! ```text
//! plain        [bytes] data
//! compressed   [blocks][block size][size of the last, 0 = full][compressed size]... block block ...
//! ```
//! A number in brackets has the file's `header_type`. In base64, header and data may be padded separately.

use std::borrow::Cow;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::base::{Error, Result, Threads};
use crate::io::Compression;
use crate::io::scalar::ByteOrder;
use crate::io::vtkxml::codec::{Decompressor, max_output};
use crate::io::vtkxml::tail::Tail;

const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Size of the blocks into which uncompressed data are divided: small enough to stay in the cache.
const CHUNK: usize = 256 << 10;
/// Decompressed bytes that a thread reads at a time, if blocks are smaller.
const RUN: usize = 1 << 20;

/// The layout of the binary data in a file, from the attributes of `VTKFile`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) order: ByteOrder,
    /// Size in bytes of a number in the header: 4 or 8.
    pub(super) word: usize,
    pub(super) compression: Compression,
}

/// Location of the bytes of an array, including its header.
#[derive(Debug)]
enum Source<'a> {
    Memory(Cow<'a, [u8]>),
    /// In the file, from this byte of the appended data.
    File(&'a Tail, usize),
}

/// The bytes of an array, whose header has been read and checked.
#[derive(Debug)]
pub(super) struct Payload<'a> {
    bytes: Source<'a>,
    compression: Compression,
    /// Where the data start after the header.
    start: usize,
    /// Where each compressed block ends, counted from the first; empty in a plain array.
    ends: Vec<usize>,
    /// Decompressed size of every block but the last.
    block: usize,
    /// Decompressed size in bytes.
    len: usize,
}

impl<'a> Payload<'a> {
    /// Opens the array at the start of `bytes`.
    pub(super) fn open(bytes: Cow<'a, [u8]>, layout: Layout) -> Result<Self> {
        match layout.compression {
            Compression::None => Self::open_plain(bytes, layout),
            _ => Self::open_blocks(bytes, layout),
        }
    }

    /// Opens the array at the start of base64 `text`.
    pub(super) fn open_base64(text: &[u8], layout: Layout) -> Result<Self> {
        Self::open(Cow::Owned(decode_base64(text)?), layout)
    }

    /// Opens the array that starts at byte `at` of the appended data and ends at `end` or before.
    pub(super) fn open_file(tail: &'a Tail, at: usize, end: usize, layout: Layout) -> Result<Self> {
        let in_file = if layout.compression == Compression::None { layout.word } else { end - at };
        let mut bytes = vec![0; in_file.min(tail.len - at)];
        tail.read_at(at, &mut bytes)?;
        if layout.compression != Compression::None {
            return Self::open_blocks(Cow::Owned(bytes), layout);
        }
        let len = Words { bytes: &bytes, layout }.get(0)?;
        Self::plain(Source::File(tail, at), len, tail.len - at - layout.word, layout)
    }

    fn open_plain(bytes: Cow<'a, [u8]>, layout: Layout) -> Result<Self> {
        let len = Words { bytes: &bytes, layout }.get(0)?;
        let available = bytes.len() - layout.word;
        Self::plain(Source::Memory(bytes), len, available, layout)
    }

    fn plain(bytes: Source<'a>, len: usize, available: usize, layout: Layout) -> Result<Self> {
        if len > available {
            return Err(truncated(format!("the header declares {len} bytes, but {available} are available")));
        }
        Ok(Self {
            bytes,
            compression: Compression::None,
            start: layout.word,
            ends: Vec::new(),
            block: CHUNK,
            len,
        })
    }

    fn open_blocks(bytes: Cow<'a, [u8]>, layout: Layout) -> Result<Self> {
        let words = Words { bytes: &bytes, layout };
        let n_blocks = words.get(0)?;
        if n_blocks == 0 {
            return Ok(Self {
                bytes: Source::Memory(bytes),
                compression: layout.compression,
                start: 0,
                ends: Vec::new(),
                block: 0,
                len: 0,
            });
        }
        let start = n_blocks.checked_add(3).and_then(|n| n.checked_mul(layout.word));
        let Some(start) = start.filter(|&s| s <= bytes.len()) else {
            return Err(truncated(format!(
                "the header declares {n_blocks} blocks, but {} bytes are available",
                bytes.len()
            )));
        };
        let (block, last) = (words.get(1)?, words.get(2)?);
        let last = if last == 0 { block } else { last };
        let available = bytes.len() - start;
        let mut ends = Vec::with_capacity(n_blocks);
        let mut end = 0;
        for i in 0..n_blocks {
            let (size, left) = (words.get(3 + i)?, available - end);
            let decompressed = if i + 1 == n_blocks { last } else { block };
            if size > left {
                return Err(truncated(format!(
                    "block {i} of {n_blocks} has {size} bytes, but {left} are available"
                )));
            }
            if decompressed > max_output(layout.compression, size) {
                return Err(damaged(format!(
                    "block {i} of {n_blocks}: {size} bytes cannot decompress to {decompressed}"
                )));
            }
            end += size;
            ends.push(end);
        }
        // No overflow: the size of every block has just been checked.
        let len = (n_blocks - 1) * block + last;
        if last > block {
            return Err(damaged(format!("the last block has {last} bytes, more than the others, {block}")));
        }
        Ok(Self { bytes: Source::Memory(bytes), compression: layout.compression, start, ends, block, len })
    }

    /// Decompressed size of the array in bytes.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Copies the first `out.len()` bytes of the array, which must have that many, to `out`.
    pub(super) fn read_into(&self, out: &mut [u8], threads: &Threads) -> Result<()> {
        let runs = out.chunks_mut(self.run_blocks() * self.block.max(1)).enumerate().collect();
        let read = |(run, out): (usize, &mut [u8])| {
            let mut decompressor = Decompressor::new(self.compression);
            let mut blocks = out.chunks_mut(self.block).enumerate();
            blocks
                .try_for_each(|(i, out)| self.read_block(&mut decompressor, run * self.run_blocks() + i, out))
        };
        threads.each(runs, read).into_iter().collect()
    }

    /// Number of bytes decompressed at a time.
    pub(super) fn block(&self) -> usize {
        self.block
    }

    /// Fills all ids from numbers of `size` bytes, of which blocks must have whole ones. `convert` fills some
    /// from their bytes, and returns whether they are ids; so does this.
    pub(super) fn read_ids(
        &self,
        size: usize,
        ids: &mut [u32],
        convert: impl Fn(&mut [u32], &[u8]) -> bool + Sync + Send,
        threads: &Threads,
    ) -> Result<bool> {
        let per_block = (self.block / size).max(1);
        let runs = ids.chunks_mut(self.run_blocks() * per_block).enumerate().collect();
        let read = |(run, ids): (usize, &mut [u32])| {
            let mut decompressor = Decompressor::new(self.compression);
            let mut bytes = Vec::new();
            let mut fits = true;
            for (i, ids) in ids.chunks_mut(per_block).enumerate() {
                bytes.resize(ids.len() * size, 0);
                self.read_block(&mut decompressor, run * self.run_blocks() + i, &mut bytes)?;
                fits &= convert(ids, &bytes);
            }
            Ok(fits)
        };
        threads.each(runs, read).into_iter().try_fold(true, |all, fits| Ok(all & fits?))
    }

    /// Number of blocks that a thread reads at a time.
    fn run_blocks(&self) -> usize {
        (RUN / self.block.max(1)).max(1)
    }

    /// Copies block `i`, or its first bytes if `out` is shorter.
    fn read_block(&self, decompressor: &mut Decompressor, i: usize, out: &mut [u8]) -> Result<()> {
        let bytes = match &self.bytes {
            Source::File(tail, at) => return tail.read_at(at + self.start + i * self.block, out),
            Source::Memory(bytes) => &bytes[self.start..],
        };
        if self.compression == Compression::None {
            out.copy_from_slice(&bytes[i * self.block..][..out.len()]);
            return Ok(());
        }
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        let n = self.ends.len();
        decompressor
            .decompress(&bytes[start..self.ends[i]], out)
            .map_err(|what| damaged(format!("block {i} of {n}: {what}")))
    }

    /// All bytes of the array.
    pub(super) fn to_bytes(&self, threads: &Threads) -> Result<Cow<'_, [u8]>> {
        if let (Source::Memory(bytes), Compression::None) = (&self.bytes, self.compression) {
            return Ok(Cow::Borrowed(&bytes[self.start..self.start + self.len]));
        }
        let mut out = vec![0; self.len];
        self.read_into(&mut out, threads)?;
        Ok(Cow::Owned(out))
    }
}

/// The numbers of a header.
struct Words<'a> {
    bytes: &'a [u8],
    layout: Layout,
}

impl Words<'_> {
    fn get(&self, i: usize) -> Result<usize> {
        let word = self.layout.word;
        let Some(bytes) = self.bytes.get(i * word..(i + 1) * word) else {
            return Err(truncated("the data end inside their header".into()));
        };
        let mut wide = [0; 8];
        wide[..word].copy_from_slice(bytes);
        if self.layout.order == ByteOrder::Big {
            wide[..word].reverse();
        }
        usize::try_from(u64::from_le_bytes(wide))
            .map_err(|_| damaged("a size exceeds the address space".into()))
    }
}

/// Decodes base64 text, which may contain blanks and padding inside.
pub(super) fn decode_base64(text: &[u8]) -> Result<Vec<u8>> {
    let mut compact = Cow::Borrowed(text.trim_ascii());
    if compact.iter().any(u8::is_ascii_whitespace) {
        compact = compact.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
    }
    let mut rest: &[u8] = &compact;
    let mut bytes = Vec::with_capacity(rest.len() / 4 * 3 + 3);
    while !rest.is_empty() {
        let end = rest.iter().position(|&b| b == b'=').unwrap_or(rest.len());
        let padding = rest[end..].iter().take_while(|&&b| b == b'=').count();
        let (part, next) = rest.split_at(end + padding);
        BASE64.decode_vec(part, &mut bytes).map_err(|e| damaged(format!("invalid base64: {e}")))?;
        rest = next;
    }
    Ok(bytes)
}

fn truncated(what: String) -> Error {
    Error::input(what).remedy("the file is truncated or damaged: copy or write it again")
}

fn damaged(what: String) -> Error {
    Error::input(what).remedy("the file is damaged: copy or write it again")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Layout = Layout { order: ByteOrder::Little, word: 4, compression: Compression::None };

    #[test]
    fn base64_may_be_padded_between_header_and_data() {
        let together = Payload::open_base64(b"AwAAAGFiYw==", PLAIN).unwrap();
        let apart = Payload::open_base64(b"AwAAAA==\nYWJj", PLAIN).unwrap();
        assert_eq!(together.to_bytes(&Threads::single()).unwrap(), b"abc".as_slice());
        assert_eq!(apart.to_bytes(&Threads::single()).unwrap(), b"abc".as_slice());
    }

    #[test]
    fn a_size_beyond_the_bytes_is_refused_before_anything_is_allocated() {
        let mut file = (1u64 << 60).to_le_bytes().to_vec();
        file.extend([0; 16]);
        let layout = Layout { word: 8, ..PLAIN };
        assert!(Payload::open(Cow::Borrowed(&file), layout).is_err());
        for compression in [Compression::Zlib, Compression::Lz4, Compression::Lzma] {
            let layout = Layout { compression, ..layout };
            assert!(Payload::open(Cow::Borrowed(&file), layout).is_err());
            // One block of 8 bytes that declares a size of 2^40.
            let bomb: Vec<u8> = [1u64, 1 << 40, 0, 8, 0].iter().flat_map(|w| w.to_le_bytes()).collect();
            let error = Payload::open(Cow::Borrowed(&bomb), layout).unwrap_err();
            assert!(error.to_string().contains("cannot decompress to 1099511627776"), "{error}");
        }
    }
}
