//! Classic netCDF files: a header that lists dimensions and arrays, then their values, big-endian.

use std::collections::HashMap;

use crate::base::{Error, Result};
use crate::io::memory_budget::MemoryBudget;
use crate::io::scalar::{ByteOrder, Scalar};
use crate::mesh::Values;

/// Whether the bytes begin with the signature.
pub(super) fn is_classic(bytes: &[u8]) -> bool {
    matches!(bytes, [b'C', b'D', b'F', 1 | 2 | 5, ..])
}

/// A file with its header read.
pub(super) struct Classic<'a> {
    bytes: &'a [u8],
    pub(super) dimensions: HashMap<String, usize>,
    pub(super) arrays: HashMap<String, Array>,
    n_records: usize,
    record_size: usize,
    /// Many arrays may be the same bytes.
    budget: MemoryBudget,
}

/// An array: its type, `None` for characters; the lengths of its dimensions; and where its values begin.
pub(super) struct Array {
    kind: Option<Scalar>,
    shape: Vec<usize>,
    is_record: bool,
    begin: usize,
    pub(super) texts: HashMap<String, String>,
}

/// Reads the header.
struct Header<'a> {
    bytes: &'a [u8],
    at: usize,
    version: u8,
}

const TAGS: [(u64, &str); 3] = [(10, "dimensions"), (11, "arrays"), (12, "attributes")];
const DIMENSIONS: usize = 0;
const ARRAYS: usize = 1;
const ATTRIBUTES: usize = 2;

impl<'a> Header<'a> {
    fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what)
            .at(format!("header, byte {}", self.at))
            .remedy("the file is truncated or damaged: get a new copy")
    }

    fn take(&mut self, n: usize) -> Result<&'a [u8]> {
        let taken = self.bytes.get(self.at..).and_then(|rest| rest.get(..n));
        let taken = taken.ok_or_else(|| self.error("the header ends early"))?;
        self.at += n;
        Ok(taken)
    }

    fn unsigned(&mut self, n_bytes: usize) -> Result<u64> {
        Ok(self.take(n_bytes)?.iter().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    /// A count, of 8 bytes in version 5.
    fn number(&mut self) -> Result<usize> {
        let number = self.unsigned(if self.version == 5 { 8 } else { 4 })?;
        usize::try_from(number).map_err(|_| self.error(format!("{number} is too large")))
    }

    /// A count of things that take at least `bytes_each` of the rest.
    fn count(&mut self, what: &str, bytes_each: usize) -> Result<usize> {
        let n = self.number()?;
        let room = (self.bytes.len() - self.at) / bytes_each;
        match n <= room {
            true => Ok(n),
            false => Err(self.error(format!("{n} {what} declared, but the rest can hold at most {room}"))),
        }
    }

    /// The number of entries of a list, which may be absent.
    fn list(&mut self, which: usize) -> Result<usize> {
        let (expected, what) = TAGS[which];
        let tag = self.unsigned(4)?;
        let n = self.count(what, 8)?;
        match tag == expected || (tag == 0 && n == 0) {
            true => Ok(n),
            false => Err(self.error(format!("expected the list of {what}, found tag {tag}"))),
        }
    }

    fn name(&mut self) -> Result<String> {
        let n = self.count("characters of a name", 1)?;
        let name = String::from_utf8_lossy(self.take(n)?).into_owned();
        self.take(n.wrapping_neg() % 4)?;
        Ok(name)
    }

    /// The type of values: `None` for characters.
    fn kind(&mut self) -> Result<Option<Scalar>> {
        Ok(match self.unsigned(4)? {
            1 => Some(Scalar::I8),
            2 => None,
            3 => Some(Scalar::I16),
            4 => Some(Scalar::I32),
            5 => Some(Scalar::F32),
            6 => Some(Scalar::F64),
            7 => Some(Scalar::U8),
            8 => Some(Scalar::U16),
            9 => Some(Scalar::U32),
            10 => Some(Scalar::I64),
            11 => Some(Scalar::U64),
            other => return Err(self.error(format!("values of type {other} are not known"))),
        })
    }

    /// The attributes that are texts.
    fn texts(&mut self) -> Result<HashMap<String, String>> {
        let mut texts = HashMap::new();
        for _ in 0..self.list(ATTRIBUTES)? {
            let name = self.name()?;
            let kind = self.kind()?;
            let size = kind.map_or(1, Scalar::size);
            let n_bytes = self.count("values of an attribute", size)? * size;
            let value = self.take(n_bytes)?;
            self.take(n_bytes.wrapping_neg() % 4)?;
            if kind.is_none() {
                texts.insert(name, trimmed(value));
            }
        }
        Ok(texts)
    }
}

/// A text up to the byte that ends it, without blanks around it.
pub(super) fn trimmed(bytes: &[u8]) -> String {
    let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(text).trim().to_owned()
}

impl<'a> Classic<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        let mut header = Header { bytes, at: 4, version: bytes[3] };
        let n_records = header.number()?;
        let mut lengths = Vec::new();
        let mut dimensions = HashMap::new();
        for _ in 0..header.list(DIMENSIONS)? {
            let (name, length) = (header.name()?, header.number()?);
            lengths.push(length);
            dimensions.insert(name, length);
        }
        header.texts()?;
        let mut arrays = HashMap::new();
        let mut record_sizes = Vec::new();
        for _ in 0..header.list(ARRAYS)? {
            let name = header.name()?;
            let n = header.count("dimensions of an array", 4)?;
            let ids = (0..n).map(|_| header.number()).collect::<Result<Vec<_>>>()?;
            let texts = header.texts()?;
            let kind = header.kind()?;
            header.number()?;
            let begin = header.unsigned(if header.version == 1 { 4 } else { 8 })?;
            let shape: Option<Vec<usize>> = ids.iter().map(|&id| lengths.get(id).copied()).collect();
            let mut shape =
                shape.ok_or_else(|| header.error(format!("array {name} has unknown dimensions")))?;
            // The dimension over time has no length of its own.
            let is_record = shape.first() == Some(&0);
            if is_record {
                shape.remove(0);
                record_sizes.push(n_bytes(kind, &shape).unwrap_or(usize::MAX));
            }
            let begin = usize::try_from(begin).unwrap_or(usize::MAX);
            arrays.insert(name, Array { kind, shape, is_record, begin, texts });
        }
        // Records of several arrays start at whole words.
        let record_size = match record_sizes[..] {
            [one] => one,
            _ => record_sizes
                .iter()
                .fold(0usize, |sum, n| sum.saturating_add(n.saturating_add(n.wrapping_neg() % 4))),
        };
        // A file that is still being written does not tell how many.
        let most = bytes.len() / record_size.max(1);
        Ok(Self {
            bytes,
            dimensions,
            arrays,
            n_records: n_records.min(most),
            record_size,
            budget: MemoryBudget::of(bytes.len() as u64),
        })
    }

    /// Number of rows of an array over time, `None` for other arrays; and the lengths of its dimensions.
    pub(super) fn shape<'s>(&self, array: &'s Array) -> (Option<usize>, &'s [usize]) {
        (array.is_record.then_some(self.n_records), &array.shape)
    }

    /// The values of an array, of one record if it is over time; characters as bytes.
    pub(super) fn values(&self, name: &str, array: &Array, record: usize) -> Result<Values> {
        let start = record.checked_mul(if array.is_record { self.record_size } else { 0 });
        let range = start
            .and_then(|start| start.checked_add(array.begin))
            .and_then(|start| Some(start..start.checked_add(n_bytes(array.kind, &array.shape)?)?));
        let bytes = range.and_then(|range| self.bytes.get(range)).ok_or_else(|| {
            Error::input("the values lie beyond the end of the file")
                .at(format!("array {name}"))
                .remedy("the file is truncated: get a new copy")
        })?;
        self.budget.take(bytes.len() as u64)?;
        match array.kind {
            Some(kind) => kind.numbers(bytes, ByteOrder::Big),
            None => Ok(Values::U8(bytes.to_vec())),
        }
    }
}

/// Number of bytes of values of a shape; `None` if it is too large.
fn n_bytes(kind: Option<Scalar>, shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(kind.map_or(1, Scalar::size), |n, &length| n.checked_mul(length))
}
