//! Refuses HDF5 files where the library was built without them.

use std::ops::Range;
use std::path::Path;

use super::tree::Node;
use crate::base::{Error, Result};
use crate::mesh::Values;

/// Whether the bytes begin with the HDF5 signature.
pub(in crate::io) fn is_hdf5(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89HDF\r\n\x1a\n")
}

/// Opens no file.
pub(in crate::io) fn open(_: &[u8]) -> Result<Group> {
    Err(refused())
}

/// Opens no file.
pub(in crate::io) fn open_in_place(_: &Path) -> Result<Group> {
    Err(refused())
}

fn refused() -> Error {
    Error::input("motet was built without HDF5").remedy("build it with the feature `hdf5`")
}

impl Node {
    /// Writes no file.
    pub(in crate::io) fn into_file(self) -> Result<Vec<u8>> {
        Err(refused())
    }

    /// Writes no file.
    pub(in crate::io) fn into_file_v1_8(self) -> Result<Vec<u8>> {
        Err(refused())
    }
}

/// A group, of which there is none.
pub(in crate::io) enum Group {}

/// An array, of which there is none.
pub(in crate::io) enum Array {}

/// Methods of types without values.
macro_rules! never {
    ($type:ident { $(fn $name:ident($($argument:ty),*) -> $result:ty;)* }) => {
        #[allow(clippy::unused_self, reason = "there is no such value")]
        impl $type {
            $(never! { @fn $name($($argument),*) -> $result })*
        }
    };
    (@fn $name:ident() -> $result:ty) => {
        pub(in crate::io) fn $name(&self) -> $result {
            match *self {}
        }
    };
    (@fn $name:ident($argument:ty) -> $result:ty) => {
        pub(in crate::io) fn $name(&self, _: $argument) -> $result {
            match *self {}
        }
    };
}

never! { Group {
    fn path() -> &str;
    fn arrays() -> &[String];
    fn groups() -> &[String];
    fn group(&str) -> Result<Option<Self>>;
    fn array(&str) -> Result<Option<Array>>;
    fn required_array(&str) -> Result<Array>;
    fn text(&str) -> Option<&str>;
    fn ints(&str) -> Option<Vec<i64>>;
} }

never! { Array {
    fn path() -> &str;
    fn rows() -> usize;
    fn components() -> usize;
    fn all() -> Result<Values>;
    fn values(Range<usize>) -> Result<Values>;
    fn ints(Range<usize>) -> Result<Vec<i64>>;
    fn error(impl Into<String>) -> Error;
    fn is_supported() -> bool;
    fn records() -> Result<Vec<Vec<u8>>>;
    fn bytes() -> Result<Vec<u8>>;
    fn text(&str) -> Result<Option<String>>;
    fn attribute(&str) -> Result<Option<Vec<i64>>>;
} }
