//! Reads a mesh in one format and writes it in another: `convert IN OUT [ascii|base64|binary] [none|zlib|lz4|lzma] [VERSION]`.

use motet::io::{self, Compression, Encoding, WriteOptions};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize| words.get(i).map(String::as_str);
    let options = WriteOptions {
        encoding: match word(2) {
            Some("ascii") => Encoding::Ascii,
            Some("base64") => Encoding::Base64,
            _ => Encoding::Binary,
        },
        compression: match word(3) {
            Some("none") => Compression::None,
            Some("lz4") => Compression::Lz4,
            Some("lzma") => Compression::Lzma,
            _ => Compression::Zlib,
        },
        version: word(4).map(str::to_owned),
    };
    let (Some(from), Some(to)) = (word(0), word(1)) else {
        eprintln!("usage: convert IN OUT [ascii|base64|binary] [none|zlib|lz4|lzma] [VERSION]");
        std::process::exit(2);
    };
    match io::read(from).and_then(|mesh| io::write(to, &mesh, &options)) {
        Ok(lost) => lost.iter().for_each(|what| eprintln!("lost: {what}")),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(3);
        }
    }
}
