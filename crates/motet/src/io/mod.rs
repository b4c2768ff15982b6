//! Floor 3: files. One format a file, one registry for all.

mod registry;

pub use registry::{
    Compression, Encoding, Format, Input, Read, Write, WriteOptions, Written, formats, read, read_as,
    replace, write,
};
