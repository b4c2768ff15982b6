//! An opened VTK XML file: its kind, its data layout and its arrays.

use std::borrow::Cow;
use std::rc::Rc;

use crate::base::{Error, Point, Result, Threads};
use crate::io::format::{Compression, Notes};
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::memory_budget::MemoryBudget;
use crate::io::scalar::{ByteOrder, Scalar, fill_ids, to_ids, to_points};
use crate::io::vtkxml::codec::by_vtk_name;
use crate::io::vtkxml::document::{Document, Element};
use crate::io::vtkxml::payload::{Layout, Payload};
use crate::io::vtkxml::tail::Tail;
use crate::mesh::{Field, Values};

/// An opened file.
#[derive(Debug)]
pub(super) struct File<'a> {
    document: Document<'a>,
    threads: &'a Threads,
    pub(super) notes: &'a Notes,
    /// The appended data, if they were left in the file.
    tail: Option<&'a Tail>,
    layout: Layout,
    /// Start offsets of arrays in the appended data, ascending.
    starts: Vec<usize>,
    budget: Rc<MemoryBudget>,
}

impl<'a> File<'a> {
    pub(super) fn open(bytes: &'a [u8], threads: &'a Threads, notes: &'a Notes) -> Result<Self> {
        Self::open_within(bytes, threads, notes, Rc::new(MemoryBudget::of(bytes.len() as u64)))
    }

    /// Opens one of the files that make up a mesh, which share a memory budget.
    pub(super) fn open_within(
        bytes: &'a [u8],
        threads: &'a Threads,
        notes: &'a Notes,
        budget: Rc<MemoryBudget>,
    ) -> Result<Self> {
        let document = Document::parse(bytes)?;
        let root = &document.root;
        if root.name != "VTKFile" {
            return Err(Error::input(format!("expected root element `VTKFile`, found `{}`", root.name))
                .at(format!("line {}", root.line))
                .remedy("this is not a VTK file: give it the extension of its format"));
        }
        let layout = layout(root)?;
        let mut starts = Vec::new();
        collect_starts(root, &mut starts);
        starts.sort_unstable();
        Ok(Self { document, threads, notes, tail: None, layout, starts, budget })
    }

    /// Opens a file whose appended data are read array by array.
    pub(super) fn open_tail(tail: &'a Tail, threads: &'a Threads, notes: &'a Notes) -> Result<Self> {
        let budget = Rc::new(MemoryBudget::of((tail.head.len() + tail.len) as u64));
        Ok(Self { tail: Some(tail), ..Self::open_within(&tail.head, threads, notes, budget)? })
    }

    /// The kind of data: `UnstructuredGrid`, `PolyData`, `Collection`, ...
    pub(super) fn kind(&self) -> &str {
        self.document.root.attribute("type").unwrap_or("unknown")
    }

    /// The element with the data set, which has the name of the file's kind.
    pub(super) fn data_set(&self) -> Result<&Element<'a>> {
        let kind = self.kind();
        self.document.root.child(kind).ok_or_else(|| {
            Error::input(format!("the element {kind} is missing"))
                .at(self.document.root.place())
                .remedy("the file is truncated or damaged: write it again")
        })
    }

    /// The arrays among the children of `element`; none if there is no element.
    pub(super) fn arrays<'s>(
        &'s self,
        element: Option<&'s Element<'a>>,
    ) -> impl Iterator<Item = Result<Array<'s, 'a>>> {
        let children = element.map(|e| e.children.as_slice()).unwrap_or_default();
        children
            .iter()
            .filter(|c| c.name == "DataArray" || c.name == "Array")
            .map(|element| Array::open(self, element))
    }

    /// The array called `name` among the children of `element`, if there is one.
    pub(super) fn array<'s>(&'s self, element: &'s Element<'a>, name: &str) -> Result<Option<Array<'s, 'a>>> {
        let mut named = element.children.iter().filter(|c| c.attribute("Name") == Some(name));
        named.next().map(|element| Array::open(self, element)).transpose()
    }

    /// The array called `name`; an error if it is missing.
    pub(super) fn required_array<'s>(
        &'s self,
        element: &'s Element<'a>,
        name: &str,
    ) -> Result<Array<'s, 'a>> {
        self.array(element, name)?.ok_or_else(|| {
            Error::input(format!("the array {name} is missing"))
                .at(element.place())
                .remedy("the file is damaged: write it again")
        })
    }

    /// A field for each array of `element`, with `n_rows` rows each, or with the number that the array
    /// declares (`None`).
    pub(super) fn fields(&self, element: Option<&Element<'a>>, n_rows: Option<usize>) -> Result<Vec<Field>> {
        let mut fields = Vec::new();
        for array in self.arrays(element) {
            let array = array?;
            let n_rows = match n_rows {
                Some(n) => Some(n),
                None => array.element.count("NumberOfTuples")?,
            };
            let name = array.element.raw_attribute("Name").unwrap_or("unnamed").to_owned();
            fields.push(Field { name, components: array.components, values: array.values(n_rows)? });
        }
        Ok(fields)
    }
}

fn layout(root: &Element<'_>) -> Result<Layout> {
    let unknown = |name: &str, value: &str, known: &str| {
        Error::input(format!("unknown value {name}=\"{value}\""))
            .at(root.place())
            .remedy(format!("use {known}"))
    };
    let order = match root.attribute("byte_order") {
        None | Some("LittleEndian") => ByteOrder::Little,
        Some("BigEndian") => ByteOrder::Big,
        Some(other) => return Err(unknown("byte_order", other, "LittleEndian or BigEndian")),
    };
    let word = match root.attribute("header_type") {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => return Err(unknown("header_type", other, "UInt32 or UInt64")),
    };
    let compression = root.attribute("compressor").map_or(Ok(Compression::None), by_vtk_name)?;
    Ok(Layout { order, word, compression })
}

fn collect_starts(element: &Element<'_>, starts: &mut Vec<usize>) {
    starts.extend(element.attribute("offset").and_then(|o| o.parse::<usize>().ok()));
    element.children.iter().for_each(|c| collect_starts(c, starts));
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Type {
    Number(Scalar),
    Bit,
    Text,
}

/// A `DataArray` with parsed attributes, whose data have not been read yet.
#[derive(Debug)]
pub(super) struct Array<'s, 'a> {
    file: &'s File<'a>,
    pub(super) element: &'s Element<'a>,
    kind: Type,
    pub(super) components: usize,
}

enum Content<'s> {
    Ascii(&'s str),
    Binary(Payload<'s>),
}

impl<'s, 'a> Array<'s, 'a> {
    fn open(file: &'s File<'a>, element: &'s Element<'a>) -> Result<Self> {
        let kind = match element.attribute("type").unwrap_or("Float32") {
            "Int8" => Type::Number(Scalar::I8),
            "UInt8" => Type::Number(Scalar::U8),
            "Int16" => Type::Number(Scalar::I16),
            "UInt16" => Type::Number(Scalar::U16),
            "Int32" => Type::Number(Scalar::I32),
            "UInt32" => Type::Number(Scalar::U32),
            "Int64" => Type::Number(Scalar::I64),
            "UInt64" => Type::Number(Scalar::U64),
            "Float32" => Type::Number(Scalar::F32),
            "Float64" => Type::Number(Scalar::F64),
            "Bit" => Type::Bit,
            "String" => Type::Text,
            other => {
                return Err(Error::input(format!("unknown value type {other}"))
                    .at(element.place())
                    .remedy("supported: Int8 to Int64, UInt8 to UInt64, Float32, Float64, Bit, String"));
            }
        };
        match element.count("NumberOfComponents")?.unwrap_or(1) {
            0 => Err(Error::input("has no components").at(element.place())),
            components => Ok(Self { file, element, kind, components }),
        }
    }

    /// The values: `n_rows` rows, or all that are present.
    pub(super) fn values(&self, n_rows: Option<usize>) -> Result<Values> {
        self.read(n_rows).map_err(|e| e.at(self.element.place()))
    }

    /// The values as ids of points or cells, or as indices in a list of ids.
    pub(super) fn ids(&self, n_rows: Option<usize>) -> Result<Vec<u32>> {
        self.ids_after(&[], n_rows)
    }

    /// The start of each of `n` lists and the end of the last, computed from the end of each list.
    pub(super) fn offsets(&self, n: usize) -> Result<Vec<u32>> {
        self.ids_after(&[0], Some(n))
    }

    fn ids_after(&self, first: &[u32], n_rows: Option<usize>) -> Result<Vec<u32>> {
        if let Some(ids) = self.fast_ids(first, n_rows).map_err(|e| e.at(self.element.place()))? {
            return Ok(ids);
        }
        let ids = self.slow_ids(n_rows)?;
        Ok(if first.is_empty() { ids } else { [first, &ids].concat() })
    }

    /// Binary ids of the usual types, converted block by block during decompression; `None` for all others,
    /// and if an id does not fit.
    fn fast_ids(&self, first: &[u32], n_rows: Option<usize>) -> Result<Option<Vec<u32>>> {
        let Type::Number(kind @ (Scalar::I32 | Scalar::U32 | Scalar::I64 | Scalar::U64)) = self.kind else {
            return Ok(None);
        };
        if n_rows == Some(0) || self.element.attribute("format") == Some("ascii") {
            return Ok(None);
        }
        let Content::Binary(payload) = self.content()? else { return Ok(None) };
        let n = payload.len() / kind.size();
        let fits = payload.len().is_multiple_of(kind.size()) && payload.block().is_multiple_of(kind.size());
        if !fits || n_rows.is_some_and(|rows| rows.checked_mul(self.components) != Some(n)) {
            return Ok(None);
        }
        let mut ids = vec![0; first.len() + n];
        ids[..first.len()].copy_from_slice(first);
        let order = self.file.layout.order;
        let convert = |ids: &mut [u32], bytes: &[u8]| fill_ids(ids, kind, order, bytes);
        let fits = payload.read_ids(kind.size(), &mut ids[first.len()..], convert, self.file.threads)?;
        Ok(fits.then_some(ids))
    }

    fn slow_ids(&self, n_rows: Option<usize>) -> Result<Vec<u32>> {
        to_ids(&self.values(n_rows)?).map_err(|bad| {
            Error::input(format!("{bad} is not a valid id"))
                .at(self.element.place())
                .remedy("the file is damaged, or has more than 2^32 points")
        })
    }

    /// The values as `n` points.
    pub(super) fn points(&self, n: usize) -> Result<Vec<Point>> {
        if self.components != 3 {
            return Err(Error::input(format!("expected 3 components per point, found {}", self.components))
                .at(self.element.place()));
        }
        to_points(self.values(Some(n))?)
            .ok_or_else(|| Error::input("point coordinates are text, not numbers").at(self.element.place()))
    }

    fn read(&self, n_rows: Option<usize>) -> Result<Values> {
        let expected = match n_rows {
            Some(n) => Some(n.checked_mul(self.components).ok_or_else(|| {
                Error::input(format!(
                    "{n} rows of {} components exceed the available memory",
                    self.components
                ))
            })?),
            None => None,
        };
        if expected == Some(0) {
            return self.empty();
        }
        match (self.content()?, self.kind) {
            (Content::Ascii(text), Type::Number(kind)) => read_ascii(text, kind, expected),
            (Content::Ascii(text), Type::Bit) => read_ascii(text, Scalar::U8, expected),
            (Content::Ascii(text), Type::Text) => self.texts(&ascii_characters(text)?, expected),
            (Content::Binary(payload), Type::Number(kind)) => {
                read_binary(&payload, kind, self.file.layout, expected, self.file.threads)
            }
            (Content::Binary(payload), Type::Bit) => read_bits(&payload, expected, self.file.threads),
            (Content::Binary(payload), Type::Text) => {
                self.texts(&payload.to_bytes(self.file.threads)?, expected)
            }
        }
    }

    fn texts(&self, bytes: &[u8], expected: Option<usize>) -> Result<Values> {
        // A single byte may end a text, and each text takes memory of its own.
        let n = bytes.iter().filter(|&&b| b == 0).count() as u64;
        self.file.budget.take(n.saturating_mul(2 * size_of::<String>() as u64))?;
        split_texts(bytes, expected)
    }

    fn empty(&self) -> Result<Values> {
        match self.kind {
            Type::Number(kind) => kind.numbers(&[], ByteOrder::NATIVE),
            Type::Bit => Ok(Values::U8(Vec::new())),
            Type::Text => Ok(Values::Text(Vec::new())),
        }
    }

    /// The data, whose decompressed size has been charged to the memory budget.
    fn content(&self) -> Result<Content<'s>> {
        let content = self.content_unchecked()?;
        if let Content::Binary(payload) = &content {
            let each = if self.kind == Type::Bit { 8 } else { 1 };
            self.file.budget.take((payload.len() as u64).saturating_mul(each))?;
        }
        Ok(content)
    }

    fn content_unchecked(&self) -> Result<Content<'s>> {
        match self.element.attribute("format").unwrap_or("ascii") {
            "ascii" => std::str::from_utf8(self.element.text)
                .map(Content::Ascii)
                .map_err(|_| Error::input("the text does not consist of numbers").remedy(WRITE_AGAIN)),
            "binary" if self.element.text.is_empty() => {
                Err(Error::input("contains no data").remedy(WRITE_AGAIN))
            }
            "binary" => Payload::open_base64(self.element.text, self.file.layout).map(Content::Binary),
            "appended" => self.appended().map(Content::Binary),
            other => {
                Err(Error::input(format!("unknown format {other}"))
                    .remedy("supported: ascii, binary, appended"))
            }
        }
    }

    fn appended(&self) -> Result<Payload<'s>> {
        let Some(appended) = &self.file.document.appended else {
            return Err(Error::input("the data are declared as appended, but there is no AppendedData")
                .remedy("the file is truncated or damaged: write it again"));
        };
        let Some(offset) = self.element.count("offset")? else {
            return Err(Error::input("the data are declared as appended, but the offset is missing")
                .remedy(WRITE_AGAIN));
        };
        let len = self.file.tail.map_or(appended.bytes.len(), |tail| tail.len);
        if offset > len {
            return Err(Error::input(format!(
                "the data start at byte {offset}, but the appended data have {len} bytes"
            ))
            .remedy("the file is truncated or damaged: copy or write it again"));
        }
        let starts = &self.file.starts;
        let next = starts.get(starts.partition_point(|&s| s <= offset)).map_or(len, |&s| s.min(len));
        if let Some(tail) = self.file.tail {
            return Payload::open_file(tail, offset, next, self.file.layout);
        }
        if !appended.base64 {
            // In compressed data the array ends where the next one starts, whichever way the file is read;
            // plain data declare their length.
            let end = if self.file.layout.compression == Compression::None { len } else { next };
            return Payload::open(Cow::Borrowed(&appended.bytes[offset..end]), self.file.layout);
        }
        let text = &appended.bytes[offset..next];
        let end = text.iter().position(|&b| b == b'<').unwrap_or(text.len());
        Payload::open_base64(&text[..end], self.file.layout)
    }
}

const WRITE_AGAIN: &str = "the file is damaged: write it again";

fn wrong_count(found: usize, expected: usize) -> Error {
    Error::input(format!("expected {expected} values, found {found}"))
        .remedy("the file is truncated or damaged: write it again")
}

fn read_binary(
    payload: &Payload<'_>,
    kind: Scalar,
    layout: Layout,
    expected: Option<usize>,
    threads: &Threads,
) -> Result<Values> {
    let n = payload.len() / kind.size();
    if expected.is_some_and(|e| e != n) || !payload.len().is_multiple_of(kind.size()) {
        return Err(wrong_count(n, expected.unwrap_or(n)));
    }
    kind.filled(n, layout.order, |out| payload.read_into(out, threads))
}

fn read_ascii(text: &str, kind: Scalar, expected: Option<usize>) -> Result<Values> {
    let mut tokens = text.split_ascii_whitespace();
    let values = kind.parse(expected.unwrap_or(usize::MAX), &mut tokens).map_err(|bad| {
        let bad: String = bad.chars().take(30).collect();
        let what = if kind.is_integer() { "whole number of the declared type" } else { "number" };
        Error::input(format!("`{bad}` is not a {what}")).remedy(WRITE_AGAIN)
    })?;
    let found = values.len() + tokens.count();
    match expected {
        Some(expected) if expected != found => Err(wrong_count(found, expected)),
        _ => Ok(values),
    }
}

fn read_bits(payload: &Payload<'_>, expected: Option<usize>, threads: &Threads) -> Result<Values> {
    let bytes = payload.to_bytes(threads)?;
    let n = expected.unwrap_or(bytes.len() * 8);
    if bytes.len() != n.div_ceil(8) {
        return Err(wrong_count(bytes.len() * 8, n));
    }
    Ok(Values::U8((0..n).map(|i| bytes[i / 8] >> (7 - i % 8) & 1).collect()))
}

/// Decodes texts in ASCII files, which are stored as the numbers of their bytes; VTK writes those above 127
/// as negative numbers.
fn ascii_characters(text: &str) -> Result<Vec<u8>> {
    text.split_ascii_whitespace()
        .map(|t| {
            let number = t.parse::<i16>().ok().filter(|n| (-128..256).contains(n));
            number
                .map(|n| n as u8)
                .ok_or_else(|| Error::input(format!("`{t}` is not a character code")).remedy(WRITE_AGAIN))
        })
        .collect()
}

fn split_texts(bytes: &[u8], expected: Option<usize>) -> Result<Values> {
    let mut parts: Vec<&[u8]> = bytes.split(|&b| b == 0).collect();
    // Every text ends with a zero byte, so the last part is empty.
    if parts.last().is_some_and(|rest| rest.is_empty()) {
        parts.pop();
    }
    match expected {
        Some(expected) if expected != parts.len() => Err(wrong_count(parts.len(), expected)),
        _ => Ok(Values::Text(parts.into_iter().map(decode_utf8_or_latin1).collect())),
    }
}
