//! Nodes for writing, in the form of "SIDS-to-HDF5 File Mapping", "Node Structure".

use crate::base::Result;
use crate::io::hdf::{Attribute, Node as Group, Storage};
use crate::mesh::{Mesh, Values};

/// Width of a name or label, including a terminating zero.
const WIDTH: u32 = 33;

/// A node for writing.
pub(super) struct Tree {
    group: Group,
}

impl Tree {
    /// A node without values.
    pub(super) fn new(name: &str, label: &str) -> Self {
        Self::of_type(name, label, "MT")
    }

    /// A node with values.
    pub(super) fn with(name: &str, label: &str, values: Values) -> Self {
        let n = values.len();
        Self::shaped(name, label, values, &[n])
    }

    /// A node with values of a given shape, in C order; the documentation lists dimensions in Fortran order,
    /// reversed.
    pub(super) fn shaped(name: &str, label: &str, values: Values, shape: &[usize]) -> Self {
        let mut node = Self::of_type(name, label, type_of(&values));
        node.group.array(" data", values, shape, Storage::Plain);
        node
    }

    /// A node with a text.
    pub(super) fn with_text(name: &str, label: &str, text: &str) -> Self {
        let mut node = Self::of_type(name, label, "C1");
        node.group.array(" data", characters(text.as_bytes(), 0), &[text.len()], Storage::Plain);
        node
    }

    /// A range: its first and last number.
    pub(super) fn range(name: &str, ends: Values) -> Self {
        Self::shaped(name, "IndexRange_t", ends, &[2, 1])
    }

    /// A node with an explicit type, such as a link.
    #[cfg(test)]
    pub(super) fn with_type(name: &str, label: &str, kind: &str) -> Self {
        Self::of_type(name, label, kind)
    }

    fn of_type(name: &str, label: &str, kind: &str) -> Self {
        let mut group = Group::new(name);
        head(&mut group, name, label, kind);
        // The documentation only states that the libraries write 1.
        group.attribute("flags", Attribute::ShortInts(vec![1]));
        Self { group }
    }

    /// Adds a child.
    pub(super) fn child(&mut self, child: Self) {
        self.group.group(child.group);
    }

    /// Adds children.
    pub(super) fn children(&mut self, children: impl IntoIterator<Item = Self>) {
        children.into_iter().for_each(|child| self.child(child));
    }

    /// The file with these nodes under its root.
    pub(super) fn file(nodes: Vec<Self>) -> Result<Vec<u8>> {
        let mut root = Group::new("");
        head(&mut root, "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
        root.array(" format", characters(b"IEEE_LITTLE_32", 15), &[15], Storage::Plain);
        root.array(" hdf5version", characters(b"HDF5 Version 1.8.0", 33), &[33], Storage::Plain);
        nodes.into_iter().for_each(|node| root.group(node.group));
        // The CGNS libraries reject newer file formats.
        root.into_file_v1_8()
    }
}

fn head(group: &mut Group, name: &str, label: &str, kind: &str) {
    for (attribute, text, width) in [("name", name, WIDTH), ("label", label, WIDTH), ("type", kind, 3)] {
        group.attribute(attribute, Attribute::Padded(text.to_owned(), width));
    }
}

/// Text as stored in files, padded with zeros to `n` bytes.
fn characters(text: &[u8], n: usize) -> Values {
    let mut all: Vec<i8> = text.iter().map(|&c| c as i8).collect();
    all.resize(n.max(all.len()), 0);
    Values::I8(all)
}

fn type_of(values: &Values) -> &'static str {
    match values {
        Values::I32(_) => "I4",
        Values::I64(_) => "I8",
        Values::U32(_) => "U4",
        Values::U64(_) => "U8",
        Values::F32(_) => "R4",
        Values::F64(_) => "R8",
        Values::I8(_) | Values::U8(_) | Values::I16(_) | Values::U16(_) | Values::Text(_) => "C1",
    }
}

/// Width of integers: 32 bits where sufficient, which every library reads.
#[derive(Clone, Copy)]
pub(super) struct Ints {
    wide: bool,
}

impl Ints {
    pub(super) fn of(mesh: &Mesh) -> Self {
        // Upper bound for the faces of cells with their corners and a count for each.
        let upper_bound = mesh.cells.connectivity().items().len().saturating_mul(8).max(mesh.points.len());
        Self { wide: i32::try_from(upper_bound).is_err() }
    }

    pub(super) fn values(self, all: impl IntoIterator<Item = i64>) -> Values {
        match self.wide {
            true => Values::I64(all.into_iter().collect()),
            false => Values::I32(all.into_iter().map(|x| x as i32).collect()),
        }
    }
}
