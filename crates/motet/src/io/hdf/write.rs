//! A tree of groups and arrays, and the bytes of a file with them.

use hdf5_pure::{AttrValue, DatasetBuilder, FileBuilder, FinishedGroup, GroupBuilder, LibVer, MaxExtent};

use crate::base::{Error, Result};
use crate::mesh::Values;

/// An attribute's value.
#[derive(Clone, Debug)]
pub(in crate::io) enum Attribute {
    /// A text as long as it is.
    Text(String),
    /// A text in a field of so many bytes, the rest zeros.
    Padded(String, u32),
    /// Numbers of 64 bits.
    Ints(Vec<i64>),
    /// Numbers of 32 bits.
    ShortInts(Vec<i32>),
}

/// How an array lies in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::io) enum Packing {
    /// In one piece, as it is.
    Plain,
    /// In chunks, so that rows can be added.
    Growing,
    /// In chunks, shuffled and packed by zlib; rows can be added.
    Zlib,
}

/// About so many bytes make a chunk: few enough for a reader that wants some rows, enough for zlib.
const CHUNK_BYTES: usize = 1 << 18;
/// Of 0 to 9; higher levels take several times as long for some hundredths of the size.
const ZLIB_LEVEL: u32 = 4;

/// A group to be written.
#[derive(Debug, Default)]
pub(in crate::io) struct Node {
    name: String,
    attributes: Vec<(String, Attribute)>,
    arrays: Vec<(String, Values, Vec<usize>, Packing)>,
    groups: Vec<Node>,
}

impl Node {
    /// An empty group of this name; that of the root has no meaning.
    pub(in crate::io) fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds an attribute.
    pub(in crate::io) fn attribute(&mut self, name: &str, value: Attribute) {
        self.attributes.push((name.to_owned(), value));
    }

    /// Adds an array of this shape.
    pub(in crate::io) fn array(&mut self, name: &str, values: Values, shape: &[usize], packing: Packing) {
        self.arrays.push((name.to_owned(), values, shape.to_vec(), packing));
    }

    /// Adds a group.
    pub(in crate::io) fn group(&mut self, group: Self) {
        self.groups.push(group);
    }

    /// The file whose root this is.
    pub(in crate::io) fn into_file(self) -> Result<Vec<u8>> {
        self.into(FileBuilder::new())
    }

    /// The same in the form of HDF5 1.8, for readers that refuse what is newer. It has arrays in one piece alone.
    pub(in crate::io) fn into_file_of_1_8(self) -> Result<Vec<u8>> {
        let mut file = FileBuilder::new();
        file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
        self.into(file)
    }

    fn into(self, mut file: FileBuilder) -> Result<Vec<u8>> {
        for (name, value) in self.attributes {
            file.set_attr(&name, attribute(value)?);
        }
        for (name, values, shape, packing) in self.arrays {
            fill(file.create_dataset(&name), &values, &shape, packing)?;
        }
        for group in self.groups {
            let builder = file.create_group(&group.name);
            file.add_group(group.finish(builder)?);
        }
        file.finish().map_err(told)
    }

    fn finish(self, mut builder: GroupBuilder) -> Result<FinishedGroup> {
        for (name, value) in self.attributes {
            builder.set_attr(&name, attribute(value)?);
        }
        for (name, values, shape, packing) in self.arrays {
            fill(builder.create_dataset(&name), &values, &shape, packing)?;
        }
        for group in self.groups {
            let inner = builder.create_group(&group.name);
            builder.add_group(group.finish(inner)?);
        }
        Ok(builder.finish())
    }
}

fn told(e: impl std::fmt::Display) -> Error {
    Error::input(format!("HDF5 cannot hold this: {e}"))
}

fn attribute(value: Attribute) -> Result<AttrValue> {
    Ok(match value {
        Attribute::Text(text) => AttrValue::AsciiString(text),
        Attribute::Padded(text, width) => AttrValue::ascii_string_sized(text, width).map_err(told)?,
        Attribute::Ints(n) => AttrValue::I64Array(n),
        Attribute::ShortInts(n) => AttrValue::I32Array(n),
    })
}

fn fill(array: &mut DatasetBuilder, values: &Values, shape: &[usize], packing: Packing) -> Result<()> {
    let bytes_a_value = match values {
        Values::I8(v) => (array.with_i8_data(v), 1).1,
        Values::U8(v) => (array.with_u8_data(v), 1).1,
        Values::I16(v) => (array.with_i16_data(v), 2).1,
        Values::U16(v) => (array.with_u16_data(v), 2).1,
        Values::I32(v) => (array.with_i32_data(v), 4).1,
        Values::U32(v) => (array.with_u32_data(v), 4).1,
        Values::I64(v) => (array.with_i64_data(v), 8).1,
        Values::U64(v) => (array.with_u64_data(v), 8).1,
        Values::F32(v) => (array.with_f32_data(v), 4).1,
        Values::F64(v) => (array.with_f64_data(v), 8).1,
        Values::Text(v) => {
            array.with_vlen_strings(&v.iter().map(String::as_str).collect::<Vec<_>>());
            array.with_shape(&wide(shape));
            return Ok(());
        }
    };
    array.with_shape(&wide(shape));
    if packing == Packing::Plain {
        return Ok(());
    }
    let components: usize = shape.iter().skip(1).product::<usize>().max(1);
    let rows =
        (CHUNK_BYTES / (components * bytes_a_value)).clamp(1, shape.first().copied().unwrap_or(1).max(1));
    let mut chunk = wide(shape);
    let mut most: Vec<MaxExtent> = chunk.iter().map(|&d| MaxExtent::Fixed(d)).collect();
    if let (Some(first), Some(most)) = (chunk.first_mut(), most.first_mut()) {
        (*first, *most) = (rows as u64, MaxExtent::Unlimited);
    }
    array.with_chunks(&chunk).with_maxshape(&most);
    if packing == Packing::Zlib {
        array.with_shuffle().with_deflate(ZLIB_LEVEL);
    }
    Ok(())
}

fn wide(shape: &[usize]) -> Vec<u64> {
    shape.iter().map(|&d| d as u64).collect()
}
