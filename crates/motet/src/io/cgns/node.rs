//! The node tree: each node is an HDF5 group with a name, a label that states its type, children, and an
//! array called ` data`.

use crate::base::{Error, Result};
use crate::io::hdf::{Array, Group, is_hdf5, open};
use crate::mesh::Values;

/// Signature of the older, non-HDF5 form. It follows the four bytes that the Unix command `what` searches
/// for, which may have their highest bits set.
const ADF: &[u8] = b"ADF Database Version";

/// A node of the tree.
pub(super) struct Node {
    pub(super) name: String,
    pub(super) label: String,
    group: Group,
}

impl Node {
    /// Opens the root node, whose children are the bases.
    pub(super) fn root(bytes: &[u8]) -> Result<Self> {
        if bytes.get(4..).is_some_and(|rest| rest.starts_with(ADF)) {
            return Err(Error::input("is a CGNS file in the older ADF format; only HDF5 is read")
                .remedy("convert it to HDF5: cgnsconvert -h old.cgns new.cgns"));
        }
        if !is_hdf5(bytes) {
            return Err(
                Error::input("is not a CGNS file: neither HDF5 nor ADF").remedy("get a new copy of the file")
            );
        }
        Ok(Self { name: String::new(), label: String::new(), group: open(bytes)? })
    }

    /// The path of the node in the file.
    pub(super) fn path(&self) -> &str {
        self.group.path()
    }

    /// All children, sorted by name.
    ///
    /// Fails if a child is a link to a node elsewhere, since links are not followed.
    pub(super) fn children(&self) -> Result<Vec<Self>> {
        let of = |name: &String| self.child(name).transpose();
        self.group.groups().iter().filter_map(of).collect()
    }

    /// All children with a label, sorted by name.
    pub(super) fn children_of(&self, label: &str) -> Result<Vec<Self>> {
        Ok(self.children()?.into_iter().filter(|node| node.label == label).collect())
    }

    /// The first child with a label, by name.
    pub(super) fn child_of(&self, label: &str) -> Result<Option<Self>> {
        Ok(self.children_of(label)?.into_iter().next())
    }

    /// The child with a name, if there is one.
    pub(super) fn child(&self, name: &str) -> Result<Option<Self>> {
        let Some(group) = self.group.group(name)? else { return Ok(None) };
        if group.text("type") == Some("LK") {
            return Err(Error::input("is a link to a node elsewhere: links are not followed")
                .at(group.path())
                .remedy("replace links by their targets: cgnsconvert -f -h -l linked.cgns whole.cgns"));
        }
        let label = group.text("label").unwrap_or_default().to_owned();
        Ok(Some(Self { name: name.to_owned(), label, group }))
    }

    /// The child with a name; an error if it is missing.
    pub(super) fn required_child(&self, name: &str) -> Result<Self> {
        self.child(name)?.ok_or_else(|| self.error(format!("the node {name} is missing")))
    }

    /// The array of the node, if it has one.
    pub(super) fn array(&self) -> Result<Option<Array>> {
        self.group.array(" data")
    }

    /// The values of the node; an error if it has none.
    pub(super) fn values(&self) -> Result<Values> {
        self.array()?.ok_or_else(|| self.error("the node has no values"))?.all()
    }

    /// The values of the node as integers.
    pub(super) fn ints(&self) -> Result<Vec<i64>> {
        self.values()?.to_i64().ok_or_else(|| self.error("expected whole numbers"))
    }

    /// The values of the node as text; empty if it has none.
    pub(super) fn text(&self) -> Result<String> {
        let Some(array) = self.array()? else { return Ok(String::new()) };
        let bytes: Vec<u8> = match array.all()? {
            Values::I8(values) => values.into_iter().map(|c| c as u8).collect(),
            Values::U8(values) => values,
            Values::Text(values) => values.concat().into_bytes(),
            _ => return Err(self.error("expected text")),
        };
        Ok(String::from_utf8_lossy(&bytes).trim_end_matches(['\0', ' ']).to_owned())
    }

    /// The text of the first child with a label; `None` if there is no such child.
    pub(super) fn text_of(&self, label: &str) -> Result<Option<String>> {
        self.child_of(label)?.map(|node| node.text()).transpose()
    }

    /// An error that names this node.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what)
            .at(self.path())
            .remedy("the file is damaged or invalid: check it with cgnscheck and write it again")
    }
}
