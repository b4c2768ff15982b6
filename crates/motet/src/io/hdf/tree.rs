//! A tree of groups and arrays to be written.

use crate::mesh::Values;

/// The value of an attribute.
#[derive(Clone, Debug)]
pub(in crate::io) enum Attribute {
    /// A text without padding.
    Text(String),
    /// A text in a field of the given number of bytes, padded with zeros.
    Padded(String, u32),
    /// 64-bit integers.
    Ints(Vec<i64>),
    /// 32-bit integers.
    ShortInts(Vec<i32>),
}

/// Storage of an array in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::io) enum Storage {
    /// Contiguous and uncompressed.
    Plain,
    /// In chunks, so that rows can be appended.
    Growing,
    /// In chunks, shuffled and compressed with zlib; rows can be appended.
    Zlib,
}

/// A group for writing.
#[derive(Debug, Default)]
pub(in crate::io) struct Node {
    pub(super) name: String,
    pub(super) attributes: Vec<(String, Attribute)>,
    pub(super) arrays: Vec<(String, Values, Vec<usize>, Storage)>,
    pub(super) groups: Vec<Node>,
}

impl Node {
    /// An empty group with this name; the name of the root is ignored.
    pub(in crate::io) fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds an attribute.
    pub(in crate::io) fn attribute(&mut self, name: &str, value: Attribute) {
        self.attributes.push((name.to_owned(), value));
    }

    /// Adds an array with this shape.
    pub(in crate::io) fn array(&mut self, name: &str, values: Values, shape: &[usize], storage: Storage) {
        self.arrays.push((name.to_owned(), values, shape.to_vec(), storage));
    }

    /// Adds a group.
    pub(in crate::io) fn group(&mut self, group: Self) {
        self.groups.push(group);
    }
}
