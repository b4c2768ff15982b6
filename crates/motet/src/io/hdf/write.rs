//! The bytes of a file that holds a tree of groups and arrays.

use hdf5_pure::{
    AttrValue, DatasetBuilder, FileBuilder, FinishedGroup, GroupBuilder, LibVer, MaxExtent, make_i8_type,
};

use super::tree::{Attribute, Content, Node, NodeArray, Storage};
use crate::base::{Error, Result};
use crate::mesh::Values;

/// Approximate size of a chunk: small enough for reading a few rows, large enough for zlib.
const CHUNK_BYTES: usize = 1 << 18;
/// Compression level from 0 to 9; higher levels take several times as long and save a few percent.
const ZLIB_LEVEL: u32 = 4;

impl Node {
    /// The bytes of a file with this group as its root.
    pub(in crate::io) fn into_file(self) -> Result<Vec<u8>> {
        self.into(FileBuilder::new())
    }

    /// The bytes of a file in the format of HDF5 1.8, for readers that reject newer ones; all arrays must be
    /// contiguous.
    pub(in crate::io) fn into_file_v1_8(self) -> Result<Vec<u8>> {
        let mut file = FileBuilder::new();
        file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
        self.into(file)
    }

    fn into(self, mut file: FileBuilder) -> Result<Vec<u8>> {
        for (name, value) in self.attributes {
            file.set_attr(&name, attribute(value)?);
        }
        for array in self.arrays {
            fill(file.create_dataset(&array.name), array)?;
        }
        for group in self.groups {
            let builder = file.create_group(&group.name);
            file.add_group(group.finish(builder)?);
        }
        file.finish().map_err(not_storable)
    }

    fn finish(self, mut builder: GroupBuilder) -> Result<FinishedGroup> {
        for (name, value) in self.attributes {
            builder.set_attr(&name, attribute(value)?);
        }
        for array in self.arrays {
            fill(builder.create_dataset(&array.name), array)?;
        }
        for group in self.groups {
            let inner = builder.create_group(&group.name);
            builder.add_group(group.finish(inner)?);
        }
        Ok(builder.finish())
    }
}

fn not_storable(e: impl std::fmt::Display) -> Error {
    Error::input(format!("cannot be stored as HDF5: {e}"))
}

fn attribute(value: Attribute) -> Result<AttrValue> {
    Ok(match value {
        Attribute::Text(text) => AttrValue::AsciiString(text),
        Attribute::Padded(text, width) => AttrValue::ascii_string_sized(text, width).map_err(not_storable)?,
        Attribute::Ints(n) => AttrValue::I64Array(n),
        Attribute::ShortInts(n) => AttrValue::I32Array(n),
        Attribute::Int(n) => AttrValue::I64(n),
        Attribute::Real(x) => AttrValue::F64(x),
    })
}

fn fill(builder: &mut DatasetBuilder, array: NodeArray) -> Result<()> {
    for (name, value) in array.attributes {
        builder.set_attr(&name, attribute(value)?);
    }
    match array.content {
        Content::Values(values, shape, storage) => fill_values(builder, &values, &shape, storage),
        Content::Records(texts, width) => {
            fill_records(builder, &texts, width);
            Ok(())
        }
    }
}

fn fill_records(builder: &mut DatasetBuilder, texts: &[String], width: usize) {
    let mut bytes = vec![0; texts.len() * width];
    for (record, text) in bytes.chunks_exact_mut(width.max(1)).zip(texts) {
        let n = text.len().min(width);
        record[..n].copy_from_slice(&text.as_bytes()[..n]);
    }
    builder.with_array_data(make_i8_type(), &[width as u32], bytes, texts.len() as u64);
}

fn fill_values(array: &mut DatasetBuilder, values: &Values, shape: &[usize], storage: Storage) -> Result<()> {
    let bytes_per_value = match values {
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
    if storage == Storage::Plain {
        return Ok(());
    }
    let components: usize = shape.iter().skip(1).product::<usize>().max(1);
    let rows =
        (CHUNK_BYTES / (components * bytes_per_value)).clamp(1, shape.first().copied().unwrap_or(1).max(1));
    let mut chunk = wide(shape);
    let mut most: Vec<MaxExtent> = chunk.iter().map(|&d| MaxExtent::Fixed(d)).collect();
    if let (Some(first), Some(most)) = (chunk.first_mut(), most.first_mut()) {
        (*first, *most) = (rows as u64, MaxExtent::Unlimited);
    }
    array.with_chunks(&chunk).with_maxshape(&most);
    if storage == Storage::Zlib {
        array.with_shuffle().with_deflate(ZLIB_LEVEL);
    }
    Ok(())
}

fn wide(shape: &[usize]) -> Vec<u64> {
    shape.iter().map(|&d| d as u64).collect()
}
