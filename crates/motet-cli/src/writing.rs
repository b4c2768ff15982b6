//! Options of how files are written.

use clap::{Args, ValueEnum};
use motet::io::{Compression, Encoding, WriteOptions};

/// How files are written.
#[derive(Debug, Args)]
#[command(next_help_heading = "Writing")]
pub(crate) struct WritingArgs {
    /// Shorthand for --encoding ascii
    #[arg(long, conflicts_with = "encoding")]
    ascii: bool,
    /// How numbers are written, where the format leaves the choice [default: binary]
    #[arg(long, value_name = "HOW")]
    encoding: Option<EncodingWord>,
    /// How blocks are compressed, where the format supports it
    #[arg(long, value_name = "HOW", default_value = "zlib")]
    compression: CompressionWord,
    /// The format's own version, such as 2.2 or 4.1 for .msh [default: the format's newest]
    #[arg(long = "version", value_name = "V")]
    version: Option<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum EncodingWord {
    /// Text, with enough digits to restore every number bit for bit
    Ascii,
    /// Base64 inside the elements (XML formats); binary elsewhere
    Base64,
    /// Raw bytes: appended (XML formats), binary elsewhere
    Binary,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CompressionWord {
    /// No compression
    None,
    /// Known to every reader
    Zlib,
    /// Faster, larger
    Lz4,
    /// Slower, smaller
    Lzma,
}

impl WritingArgs {
    pub(crate) fn options(&self) -> WriteOptions {
        let encoding = match self.encoding {
            _ if self.ascii => Encoding::Ascii,
            Some(EncodingWord::Ascii) => Encoding::Ascii,
            Some(EncodingWord::Base64) => Encoding::Base64,
            Some(EncodingWord::Binary) | None => Encoding::Binary,
        };
        let compression = match self.compression {
            CompressionWord::None => Compression::None,
            CompressionWord::Zlib => Compression::Zlib,
            CompressionWord::Lz4 => Compression::Lz4,
            CompressionWord::Lzma => Compression::Lzma,
        };
        WriteOptions { encoding, compression, version: self.version.clone() }
    }
}
