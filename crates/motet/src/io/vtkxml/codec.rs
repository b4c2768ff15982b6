//! Compression of single blocks in VTK's XML files.

use flate2::{Compress, Decompress, FlushCompress, FlushDecompress, Status};

use super::xz;
use crate::base::{Error, Result};
use crate::io::Compression;

/// The level of zlib that VTK uses.
const ZLIB_LEVEL: u32 = 5;

/// VTK's name of a compression in the attribute `compressor`; `None` for no compression.
pub(super) fn vtk_name(compression: Compression) -> Option<&'static str> {
    match compression {
        Compression::None => None,
        Compression::Zlib => Some("vtkZLibDataCompressor"),
        Compression::Lz4 => Some("vtkLZ4DataCompressor"),
        Compression::Lzma => Some("vtkLZMADataCompressor"),
    }
}

/// The compression with this VTK name.
pub(super) fn by_vtk_name(name: &str) -> Result<Compression> {
    [Compression::Zlib, Compression::Lz4, Compression::Lzma]
        .into_iter()
        .find(|&c| vtk_name(c) == Some(name))
        .ok_or_else(|| {
            Error::input(format!("unknown compressor {name}")).at("VTKFile").remedy(
                "write the file with vtkZLibDataCompressor, vtkLZ4DataCompressor or vtkLZMADataCompressor",
            )
        })
}

/// Upper bound on the size of a decompressed block of `n` bytes, which exposes wrong sizes in a file. The
/// ratios are those of the formats (zlib 1032, lz4 255); xz has no bound, and reaches about 7000 on zeros.
pub(super) fn max_output(compression: Compression, n: usize) -> usize {
    let ratio = match compression {
        Compression::None => 1,
        Compression::Zlib => 1032,
        Compression::Lz4 => 255,
        Compression::Lzma => 8192,
    };
    n.saturating_mul(ratio).saturating_add(64)
}

/// Decompresses blocks, reusing its tables.
pub(super) struct Decompressor {
    compression: Compression,
    zlib: Option<Decompress>,
}

impl Decompressor {
    pub(super) fn new(compression: Compression) -> Self {
        let zlib = (compression == Compression::Zlib).then(|| Decompress::new(true));
        Self { compression, zlib }
    }

    /// Decompresses one block, which must fill `out` exactly. `Err` describes what is wrong with the block.
    pub(super) fn decompress(&mut self, block: &[u8], out: &mut [u8]) -> Result<(), String> {
        let n = match (&mut self.zlib, self.compression) {
            (Some(zlib), _) => {
                zlib.reset(true);
                let status = zlib.decompress(block, out, FlushDecompress::Finish);
                match status.map_err(|e| e.to_string())? {
                    Status::StreamEnd => zlib.total_out() as usize,
                    _ if zlib.total_out() as usize == out.len() => {
                        return Err("it contains more data than declared".into());
                    }
                    _ => return Err("it is truncated".into()),
                }
            }
            (None, Compression::Lz4) => {
                lz4_flex::block::decompress_into(block, out).map_err(|e| e.to_string())?
            }
            (None, Compression::Lzma) => xz::decompress(block, out)?,
            (None, _) => return Err("the file is not compressed".into()),
        };
        if n == out.len() { Ok(()) } else { Err(format!("expected {} bytes, found {n}", out.len())) }
    }
}

/// Compresses blocks, reusing its tables.
pub(super) struct Compressor {
    compression: Compression,
    zlib: Option<Compress>,
}

impl Compressor {
    pub(super) fn new(compression: Compression) -> Self {
        let level = flate2::Compression::new(ZLIB_LEVEL);
        let zlib = (compression == Compression::Zlib).then(|| Compress::new(level, true));
        Self { compression, zlib }
    }

    /// Appends the compressed `block` to `out`.
    pub(super) fn compress(&mut self, block: &[u8], out: &mut Vec<u8>) -> Result<()> {
        match (&mut self.zlib, self.compression) {
            (Some(zlib), _) => compress_zlib(zlib, block, out),
            (None, Compression::Lz4) => {
                let start = out.len();
                out.resize(start + lz4_flex::block::get_maximum_output_size(block.len()), 0);
                let n = lz4_flex::block::compress_into(block, &mut out[start..]).map_err(|e| failed(&e))?;
                out.truncate(start + n);
                Ok(())
            }
            (None, Compression::Lzma) => xz::compress(block, out).map_err(|e| failed(&e)),
            (None, Compression::None | Compression::Zlib) => {
                out.extend_from_slice(block);
                Ok(())
            }
        }
    }
}

fn compress_zlib(zlib: &mut Compress, block: &[u8], out: &mut Vec<u8>) -> Result<()> {
    zlib.reset();
    let start = out.len();
    loop {
        let (read, written) = (zlib.total_in() as usize, zlib.total_out() as usize);
        let left = &block[read..];
        // Into a slice, since `compress_vec` clears all unused capacity at each call. Blocks without matches
        // grow by up to 3 %.
        out.resize(start + written + left.len() + left.len() / 16 + 64, 0);
        let put = zlib.compress(left, &mut out[start + written..], FlushCompress::Finish);
        if put.map_err(|e| failed(&e))? == Status::StreamEnd {
            out.truncate(start + zlib.total_out() as usize);
            return Ok(());
        }
    }
}

fn failed(error: &dyn std::fmt::Display) -> Error {
    Error::input(format!("could not be compressed: {error}")).remedy("write with another compression")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_compression_round_trips_and_rejects_a_wrong_length() {
        let block: Vec<u8> = (0..5000u32).flat_map(|i| (i % 97).to_le_bytes()).collect();
        for compression in [Compression::Zlib, Compression::Lz4, Compression::Lzma] {
            let mut compressed = Vec::new();
            let mut compressor = Compressor::new(compression);
            compressor.compress(&block, &mut compressed).unwrap();
            assert!(compressed.len() < block.len());
            assert!(max_output(compression, compressed.len()) >= block.len());
            let mut decompressor = Decompressor::new(compression);
            let mut out = vec![0; block.len()];
            decompressor.decompress(&compressed, &mut out).unwrap();
            assert_eq!(out, block);
            assert!(decompressor.decompress(&compressed, &mut out[1..]).is_err());
            assert!(decompressor.decompress(&compressed, &mut vec![0; block.len() + 1]).is_err());
            assert!(decompressor.decompress(&compressed[..compressed.len() / 2], &mut out).is_err());
        }
    }
}
