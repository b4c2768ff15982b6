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
    /// One 64-bit integer.
    Int(i64),
    /// One number of double precision.
    Real(f64),
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
    pub(super) arrays: Vec<NodeArray>,
    pub(super) groups: Vec<Node>,
}

/// An array for writing.
#[derive(Debug)]
pub(in crate::io) struct NodeArray {
    pub(super) name: String,
    pub(super) content: Content,
    pub(super) attributes: Vec<(String, Attribute)>,
}

/// The values of an array.
#[derive(Debug)]
pub(super) enum Content {
    /// With this shape.
    Values(Values, Vec<usize>, Storage),
    /// Texts as records of so many bytes, padded with zeros.
    Records(Vec<String>, usize),
}

impl NodeArray {
    /// Adds an attribute.
    pub(in crate::io) fn attribute(&mut self, name: &str, value: Attribute) {
        self.attributes.push((name.to_owned(), value));
    }
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
    pub(in crate::io) fn array(
        &mut self,
        name: &str,
        values: Values,
        shape: &[usize],
        storage: Storage,
    ) -> &mut NodeArray {
        self.add(name, Content::Values(values, shape.to_vec(), storage))
    }

    /// Adds texts as records of `width` bytes, to which longer ones are cut.
    pub(in crate::io) fn records(&mut self, name: &str, texts: Vec<String>, width: usize) {
        self.add(name, Content::Records(texts, width));
    }

    fn add(&mut self, name: &str, content: Content) -> &mut NodeArray {
        self.arrays.push(NodeArray { name: name.to_owned(), content, attributes: Vec::new() });
        let last = self.arrays.len() - 1;
        &mut self.arrays[last]
    }

    /// Whether there is nothing in the group.
    pub(in crate::io) fn is_empty(&self) -> bool {
        self.attributes.is_empty() && self.arrays.is_empty() && self.groups.is_empty()
    }

    /// Adds a group.
    pub(in crate::io) fn group(&mut self, group: Self) {
        self.groups.push(group);
    }
}
