//! Reads groups, attributes and arrays of a file.

use std::collections::HashMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::rc::Rc;

use hdf5_pure::{AttrValue, DType, Dataset, File, is_hdf5_bytes};

use crate::base::{Error, Result};
use crate::io::memory_budget::MemoryBudget;
use crate::mesh::Values;

/// Whether the bytes begin with the HDF5 signature.
pub(in crate::io) fn is_hdf5(bytes: &[u8]) -> bool {
    is_hdf5_bytes(bytes)
}

/// Opens a file in memory and returns its root group.
pub(in crate::io) fn open(bytes: &[u8]) -> Result<Group> {
    if !is_hdf5(bytes) {
        return Err(Error::input("is not an HDF5 file: the signature is missing")
            .remedy("get a new copy of the file"));
    }
    let file = guarded("/", || File::from_bytes(bytes.to_vec()))?;
    let budget = Rc::new(MemoryBudget::of(bytes.len() as u64));
    Group::new(guarded("/", || Ok(file.root()))?, String::new(), budget)
}

/// Opens a file on disk and returns its root group; only what is requested is read.
pub(in crate::io) fn open_in_place(path: &Path) -> Result<Group> {
    let io_error = |e: std::io::Error| Error::io(path, e);
    let size = std::fs::metadata(path).map_err(io_error)?.len();
    let file = guarded("/", || File::open_streaming(path))?;
    Group::new(guarded("/", || Ok(file.root()))?, String::new(), Rc::new(MemoryBudget::of(size)))
}

/// Calls the library: adds the place to its errors, and turns its panics into errors.
fn guarded<T>(place: &str, call: impl FnOnce() -> Result<T, hdf5_pure::Error>) -> Result<T> {
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(e)) => Err(Error::input(e.to_string()).at(place)),
        Err(_) => Err(Error::input("the HDF5 library (hdf5-pure) failed here").at(place)),
    }
}

/// A group, which is a folder within the file.
pub(in crate::io) struct Group {
    inner: hdf5_pure::Group,
    path: String,
    attributes: HashMap<String, AttrValue>,
    groups: Vec<String>,
    arrays: Vec<String>,
    budget: Rc<MemoryBudget>,
}

impl Group {
    fn new(inner: hdf5_pure::Group, path: String, budget: Rc<MemoryBudget>) -> Result<Self> {
        let place = if path.is_empty() { "/" } else { &path };
        let attributes = guarded(place, || inner.attrs())?;
        let mut groups = guarded(place, || inner.groups())?;
        let mut arrays = guarded(place, || inner.datasets())?;
        // The library lists them in storage order, which carries no meaning.
        groups.sort_unstable();
        arrays.sort_unstable();
        Ok(Self { inner, path, attributes, groups, arrays, budget })
    }

    /// The path of the group in the file.
    pub(in crate::io) fn path(&self) -> &str {
        if self.path.is_empty() { "/" } else { &self.path }
    }

    /// The names of its arrays, sorted.
    pub(in crate::io) fn arrays(&self) -> &[String] {
        &self.arrays
    }

    /// The names of its subgroups, sorted.
    pub(in crate::io) fn groups(&self) -> &[String] {
        &self.groups
    }

    /// The subgroup with this name, if there is one.
    pub(in crate::io) fn group(&self, name: &str) -> Result<Option<Self>> {
        if self.groups.binary_search_by(|g| g.as_str().cmp(name)).is_err() {
            return Ok(None);
        }
        let path = format!("{}/{name}", self.path);
        let inner = guarded(&path, || self.inner.group(name))?;
        Self::new(inner, path, self.budget.clone()).map(Some)
    }

    /// The array with this name, if there is one.
    pub(in crate::io) fn array(&self, name: &str) -> Result<Option<Array>> {
        if self.arrays.binary_search_by(|a| a.as_str().cmp(name)).is_err() {
            return Ok(None);
        }
        let path = format!("{}/{name}", self.path);
        let inner = guarded(&path, || self.inner.dataset(name))?;
        Array::new(inner, path, &self.budget).map(Some)
    }

    /// The array with this name; an error if it is missing.
    pub(in crate::io) fn required_array(&self, name: &str) -> Result<Array> {
        self.array(name)?.ok_or_else(|| {
            Error::input(format!("the array {name} is missing"))
                .at(self.path())
                .remedy("the file is damaged or incomplete: write it again")
        })
    }

    /// A text attribute, without padding.
    pub(in crate::io) fn text(&self, name: &str) -> Option<&str> {
        self.attributes.get(name)?.as_str().map(|text| text.trim_end_matches(['\0', ' ']))
    }

    /// An attribute with one or several integers.
    pub(in crate::io) fn ints(&self, name: &str) -> Option<Vec<i64>> {
        self.attributes.get(name)?.to_i64s()
    }
}

/// An array: its shape and type; values are read on request.
pub(in crate::io) struct Array {
    inner: Dataset,
    path: String,
    shape: Vec<usize>,
    kind: DType,
}

impl Array {
    fn new(inner: Dataset, path: String, budget: &MemoryBudget) -> Result<Self> {
        let shape = guarded(&path, || inner.shape())?;
        let kind = guarded(&path, || inner.dtype())?;
        let size = guarded(&path, || inner.element_size())?;
        let chunk = guarded(&path, || inner.chunk_shape())?.unwrap_or_default();
        // Variable-length strings are stored elsewhere; in memory each is a `String`.
        let size =
            if matches!(kind, DType::VariableLengthString | DType::String) { size.max(40) } else { size };
        // An array with no values but an enormous number of rows is rejected too.
        let bytes = |shape: &[u64]| shape.iter().fold(size, |n, &d| n.saturating_mul(d.max(1)));
        // Values that were never written take no space in the file, but may take much memory.
        budget.take_once(&path, bytes(&shape).max(bytes(&chunk))).map_err(|e| e.at(path.as_str()))?;
        let fits = shape.iter().map(|&d| usize::try_from(d).ok()).collect::<Option<Vec<_>>>();
        let shape = fits.ok_or_else(|| Error::input("the array is too large").at(path.as_str()))?;
        Ok(Self { inner, path, shape, kind })
    }

    /// The path of the array in the file.
    pub(in crate::io) fn path(&self) -> &str {
        &self.path
    }

    /// Number of rows: its first dimension.
    pub(in crate::io) fn rows(&self) -> usize {
        self.shape.first().copied().unwrap_or(1)
    }

    /// Number of values per row: the product of its other dimensions.
    pub(in crate::io) fn components(&self) -> usize {
        self.shape.iter().skip(1).fold(1, |n, &d| n.saturating_mul(d))
    }

    /// All values.
    pub(in crate::io) fn all(&self) -> Result<Values> {
        self.values(0..self.rows())
    }

    /// The values of a range of rows, in the type of the file.
    pub(in crate::io) fn values(&self, rows: Range<usize>) -> Result<Values> {
        if rows.start > rows.end || rows.end > self.rows() {
            let (start, end, n) = (rows.start, rows.end, self.rows());
            return Err(self.error(format!("rows {start} to {end} requested, but there are {n}")));
        }
        let expected = rows.len().saturating_mul(self.components());
        let values = if expected == 0 { self.empty()? } else { self.read(rows)? };
        match values.len() == expected {
            true => Ok(values),
            false => Err(self.error(format!("expected {expected} values, found {}", values.len()))),
        }
    }

    /// The values of a range of rows as integers, whatever their integer type.
    pub(in crate::io) fn ints(&self, rows: Range<usize>) -> Result<Vec<i64>> {
        let values = self.values(rows)?;
        values.to_i64().ok_or_else(|| self.error("expected whole numbers"))
    }

    /// The bytes of each row, which may be a record of bytes.
    pub(in crate::io) fn records(&self) -> Result<Vec<Vec<u8>>> {
        if self.rows() == 0 || self.components() == 0 {
            return Ok(Vec::new());
        }
        let bytes = guarded(&self.path, || self.inner.read_raw())?;
        let width = bytes.len() / self.rows();
        if width * self.rows() != bytes.len() || width == 0 {
            return Err(self.error(format!("expected {} records, found {} bytes", self.rows(), bytes.len())));
        }
        Ok(bytes.chunks_exact(width).map(<[u8]>::to_vec).collect())
    }

    /// The bytes of all rows, end to end: of texts of any length those of the texts, with any padding.
    pub(in crate::io) fn bytes(&self) -> Result<Vec<u8>> {
        match self.kind {
            DType::VariableLengthString => match self.all()? {
                Values::Text(texts) => Ok(texts.concat().into_bytes()),
                _ => Err(self.unknown()),
            },
            _ if self.rows() == 0 || self.components() == 0 => Ok(Vec::new()),
            _ => guarded(&self.path, || self.inner.read_raw()),
        }
    }

    /// An attribute with one or several integers.
    pub(in crate::io) fn attribute(&self, name: &str) -> Result<Option<Vec<i64>>> {
        let attributes = guarded(&self.path, || self.inner.attrs())?;
        Ok(attributes.get(name).and_then(AttrValue::to_i64s))
    }

    /// An attribute that is a text, without padding.
    pub(in crate::io) fn text(&self, name: &str) -> Result<Option<String>> {
        let attributes = guarded(&self.path, || self.inner.attrs())?;
        let text = attributes.get(name).and_then(AttrValue::as_str);
        Ok(text.map(|text| text.trim_end_matches(['\0', ' ']).to_owned()))
    }

    /// An error that names this array.
    pub(in crate::io) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what).at(self.path.as_str()).remedy("the file is damaged or invalid: write it again")
    }
}

macro_rules! reading {
    ($($kind:ident $t:ty, $all:ident, $some:ident;)*) => {
        impl Array {
            fn read(&self, rows: Range<usize>) -> Result<Values> {
                let whole = rows == (0..self.rows());
                let (start, n) = (rows.start as u64, rows.len() as u64);
                let read = || Ok(match self.kind {
                    $(DType::$kind if whole => Some(Values::$kind(self.inner.$all()?)),
                    DType::$kind => Some(Values::$kind(self.inner.$some(start, n)?)),)*
                    DType::String | DType::VariableLengthString => {
                        Some(Values::Text(self.inner.read_string_rows(start, n)?))
                    }
                    _ => None,
                });
                guarded(&self.path, read)?.ok_or_else(|| self.unknown())
            }

            fn empty(&self) -> Result<Values> {
                match self.kind {
                    $(DType::$kind => Ok(Values::$kind(Vec::<$t>::new())),)*
                    DType::String | DType::VariableLengthString => Ok(Values::Text(Vec::new())),
                    _ => Err(self.unknown()),
                }
            }

            /// Whether the values are numbers or text, rather than records or other types.
            pub(in crate::io) fn is_supported(&self) -> bool {
                self.empty().is_ok()
            }
        }
    };
}

reading! {
    I8 i8, read_i8, read_i8_rows;
    U8 u8, read_u8, read_u8_rows;
    I16 i16, read_i16, read_i16_rows;
    U16 u16, read_u16, read_u16_rows;
    I32 i32, read_i32, read_i32_rows;
    U32 u32, read_u32, read_u32_rows;
    I64 i64, read_i64, read_i64_rows;
    U64 u64, read_u64, read_u64_rows;
    F32 f32, read_f32, read_f32_rows;
    F64 f64, read_f64, read_f64_rows;
}

impl Array {
    fn unknown(&self) -> Error {
        self.error(format!("values of type {} are neither numbers nor text", self.kind))
    }
}
