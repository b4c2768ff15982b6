//! The arrays of a netCDF file of either kind.

use super::classic::{Classic, is_classic, trimmed};
use crate::base::{Error, Result};
use crate::io::hdf;
use crate::mesh::Values;

/// A file.
pub(super) enum Source<'a> {
    Classic(Box<Classic<'a>>),
    Hdf(Box<hdf::Group>),
}

/// Values in rows.
pub(super) struct Table {
    pub(super) values: Values,
    pub(super) n_columns: usize,
}

impl<'a> Source<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        if is_classic(bytes) {
            return Classic::open(bytes).map(|file| Source::Classic(Box::new(file)));
        }
        if hdf::is_hdf5(bytes) {
            return hdf::open(bytes).map(|root| Source::Hdf(Box::new(root)));
        }
        Err(Error::input("is not a netCDF file: the signature is missing")
            .remedy("check the format of the file"))
    }

    /// The names of all arrays.
    pub(super) fn names(&self) -> Vec<&str> {
        match self {
            Source::Classic(file) => file.arrays.keys().map(String::as_str).collect(),
            Source::Hdf(root) => root.arrays().iter().map(String::as_str).collect(),
        }
    }

    /// The length of a dimension.
    pub(super) fn dimension(&self, name: &str) -> Result<Option<usize>> {
        match self {
            Source::Classic(file) => Ok(file.dimensions.get(name).copied()),
            Source::Hdf(root) => Ok(root.array(name)?.map(|array| array.rows())),
        }
    }

    /// All values of an array that is not over time.
    pub(super) fn table(&self, name: &str) -> Result<Option<Table>> {
        match self {
            Source::Classic(file) => {
                let Some(array) = file.arrays.get(name) else { return Ok(None) };
                let n_columns =
                    file.shape(array).1.iter().skip(1).fold(1, |n: usize, &d| n.saturating_mul(d));
                Ok(Some(Table { values: file.values(name, array, 0)?, n_columns }))
            }
            Source::Hdf(root) => {
                let Some(array) = root.array(name)? else { return Ok(None) };
                Ok(Some(Table { n_columns: array.components(), values: array.all()? }))
            }
        }
    }

    /// The values of an array over time at its last step.
    pub(super) fn last(&self, name: &str) -> Result<Option<Values>> {
        let Some(n) = self.n_steps(name)? else { return Ok(None) };
        let Some(last) = n.checked_sub(1) else { return Ok(None) };
        match self {
            Source::Classic(file) => match file.arrays.get(name) {
                Some(array) => file.values(name, array, last).map(Some),
                None => Ok(None),
            },
            Source::Hdf(root) => match root.array(name)? {
                Some(array) => array.values(last..n).map(Some),
                None => Ok(None),
            },
        }
    }

    /// The number of steps of an array over time.
    pub(super) fn n_steps(&self, name: &str) -> Result<Option<usize>> {
        match self {
            Source::Classic(file) => Ok(file.arrays.get(name).and_then(|array| file.shape(array).0)),
            Source::Hdf(root) => Ok(root.array(name)?.map(|array| array.rows())),
        }
    }

    /// Whole numbers; empty if there is no such array.
    pub(super) fn ints(&self, name: &str) -> Result<Vec<i64>> {
        let Some(table) = self.table(name)? else { return Ok(Vec::new()) };
        table
            .values
            .to_i64()
            .ok_or_else(|| Error::input("expected whole numbers").at(format!("array {name}")))
    }

    /// The texts in the rows of an array; none if there is no such array.
    pub(super) fn texts(&self, name: &str) -> Result<Vec<String>> {
        let Some(table) = self.table(name)? else { return Ok(Vec::new()) };
        let n = table.n_columns.max(1);
        Ok(match &table.values {
            Values::U8(bytes) => bytes.chunks(n).map(trimmed).collect(),
            // Each character is a text.
            Values::Text(texts) => {
                let text = |row: &[String]| {
                    trimmed(
                        &row.iter()
                            .flat_map(|c| if c.is_empty() { b"\0" } else { c.as_bytes() })
                            .copied()
                            .collect::<Vec<_>>(),
                    )
                };
                texts.chunks(n).map(text).collect()
            }
            _ => return Err(Error::input("expected texts").at(format!("array {name}"))),
        })
    }

    /// An attribute of an array that is a text.
    pub(super) fn attribute(&self, array: &str, name: &str) -> Result<Option<String>> {
        match self {
            Source::Classic(file) => {
                Ok(file.arrays.get(array).and_then(|array| array.texts.get(name).cloned()))
            }
            Source::Hdf(root) => match root.array(array)? {
                Some(array) => array.text(name),
                None => Ok(None),
            },
        }
    }
}
