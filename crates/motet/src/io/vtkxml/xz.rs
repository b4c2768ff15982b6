//! Blocks compressed with xz (lzma). Without the feature `lzma` each call is refused.

#[cfg(feature = "lzma")]
pub(super) use with::{compress, decompress};
#[cfg(not(feature = "lzma"))]
pub(super) use without::{compress, decompress};

#[cfg(feature = "lzma")]
mod with {
    use std::io::{Read as _, Write as _};

    use lzma_rust2::{CheckType, XzOptions, XzReader, XzWriter};

    const XZ_PRESET: u32 = 5;
    /// Memory limit: blocks hold some ten thousand bytes, and the strongest preset of xz needs 65 MiB.
    const XZ_MEMORY_KIB: u32 = 128 << 10;

    /// Decompresses one block, which must fill `out` exactly; returns the number of bytes.
    pub(in crate::io::vtkxml) fn decompress(block: &[u8], out: &mut [u8]) -> Result<usize, String> {
        let mut reader = XzReader::new_mem_limit(block, false, XZ_MEMORY_KIB);
        reader.read_exact(out).map_err(|e| e.to_string())?;
        match reader.read(&mut [0]) {
            Ok(0) => Ok(out.len()),
            Ok(_) => Err("it contains more data than declared".into()),
            Err(e) => Err(e.to_string()),
        }
    }

    /// Appends the compressed `block` to `out`.
    pub(in crate::io::vtkxml) fn compress(block: &[u8], out: &mut Vec<u8>) -> Result<(), String> {
        let mut options = XzOptions::with_preset(XZ_PRESET);
        options.set_check_sum_type(CheckType::Crc32);
        // A dictionary larger than the block has no use.
        options.lzma_options.dict_size = (block.len() as u32).next_power_of_two().max(1 << 12);
        let mut writer = XzWriter::new(out, options).map_err(|e| e.to_string())?;
        writer.write_all(block).map_err(|e| e.to_string())?;
        writer.finish().map_err(|e| e.to_string())?;
        Ok(())
    }
}

#[cfg(not(feature = "lzma"))]
mod without {
    const REFUSED: &str = "motet was built without lzma; build it with the feature `lzma`";

    /// Decompresses nothing.
    pub(in crate::io::vtkxml) fn decompress(_: &[u8], _: &mut [u8]) -> Result<usize, String> {
        Err(REFUSED.to_owned())
    }

    /// Compresses nothing.
    pub(in crate::io::vtkxml) fn compress(_: &[u8], _: &mut Vec<u8>) -> Result<(), String> {
        Err(REFUSED.to_owned())
    }
}
