//! Floor 3: files. One format a file, one registry for all.

mod registry;
mod series;

pub use registry::{
    Compression, Encoding, Format, Input, Notes, Read, Write, WriteOptions, Written, can_write, formats,
    read, read_as, read_noted, replace, write,
};
pub use series::{SeriesWriter, read_series};
