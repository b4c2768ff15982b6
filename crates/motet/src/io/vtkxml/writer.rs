//! Writes elements and arrays of a VTK XML file.

use std::borrow::Cow;
use std::io::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::base::{Csr, Point, Result, VertexId};
use crate::io::format::{Compression, Encoding, WriteOptions, write_all};
use crate::io::scalar::{native_bytes, write_lines, write_text};
use crate::io::vtkxml::codec::{Compressor, vtk_name};
use crate::mesh::{Field, Values};

/// Size of blocks before compression: VTK's own choice, and the size of zlib's window.
const BLOCK: usize = 32 << 10;
/// Placeholder for an offset, which is only known when the array is written.
const OFFSET_BLANKS: &str = "                      ";

/// The values of an array for writing.
pub(super) enum Data<'a> {
    Values(&'a Values),
    Points(&'a [Point]),
    /// Ids, or indices in a list, written as Int64.
    Ids(&'a [u32]),
    Int64(Vec<i64>),
    Bytes(&'a [u8]),
}

impl Data<'_> {
    fn type_name(&self) -> &'static str {
        match self {
            Self::Points(_) => "Float64",
            Self::Ids(_) | Self::Int64(_) => "Int64",
            Self::Bytes(_) => "UInt8",
            Self::Values(values) => match values {
                Values::I8(_) => "Int8",
                Values::U8(_) => "UInt8",
                Values::I16(_) => "Int16",
                Values::U16(_) => "UInt16",
                Values::I32(_) => "Int32",
                Values::U32(_) => "UInt32",
                Values::I64(_) => "Int64",
                Values::U64(_) => "UInt64",
                Values::F32(_) => "Float32",
                Values::F64(_) => "Float64",
                Values::Text(_) => "String",
            },
        }
    }

    /// The bytes as stored in memory; `None` for ids, which are widened during writing.
    fn bytes(&self) -> Option<Cow<'_, [u8]>> {
        match self {
            Self::Values(values) => Some(native_bytes(values)),
            Self::Points(points) => Some(Cow::Borrowed(bytemuck::cast_slice(points))),
            Self::Int64(values) => Some(Cow::Borrowed(bytemuck::cast_slice(values))),
            Self::Bytes(bytes) => Some(Cow::Borrowed(bytes)),
            Self::Ids(_) => None,
        }
    }

    /// Calls `each` with the total number of bytes and each block of `BLOCK` bytes; the last block may be
    /// shorter.
    fn blocks(&self, mut each: impl FnMut(usize, &[u8]) -> Result<()>) -> Result<()> {
        if let Some(bytes) = self.bytes() {
            return bytes.chunks(BLOCK).try_for_each(|block| each(bytes.len(), block));
        }
        let Self::Ids(ids) = self else { return Ok(()) };
        let mut wide = Vec::with_capacity(BLOCK / 8);
        ids.chunks(BLOCK / 8).try_for_each(|ids_of_block| {
            wide.clear();
            wide.extend(ids_of_block.iter().map(|&id| i64::from(id)));
            each(ids.len() * 8, bytemuck::cast_slice(&wide))
        })
    }

    /// Writes all bytes to `sink`, in as few calls as possible.
    fn write_to(&self, sink: &mut dyn Write) -> Result<()> {
        match self.bytes() {
            Some(bytes) => write_all(sink, &bytes),
            None => self.blocks(|_, block| write_all(sink, block)),
        }
    }

    fn n_bytes(&self) -> usize {
        match self {
            Self::Ids(ids) => ids.len() * 8,
            Self::Points(points) => size_of_val(*points),
            other => other.bytes().map_or(0, |b| b.len()),
        }
    }
}

/// A file being written.
pub(super) struct Writer<'a> {
    out: Vec<u8>,
    depth: usize,
    encoding: Encoding,
    compression: Compression,
    compressor: Compressor,
    /// Arrays for the appended part: the position of their offset, and their data.
    appended: Vec<(usize, Data<'a>)>,
    /// What could not be written unchanged.
    pub(super) lost: Vec<String>,
}

impl<'a> Writer<'a> {
    /// Starts a file with data of `kind`.
    pub(super) fn new(kind: &str, options: &WriteOptions) -> Self {
        let ascii = options.encoding == Encoding::Ascii;
        let compression = if ascii { Compression::None } else { options.compression };
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let compressor =
            vtk_name(compression).map(|name| format!(" compressor=\"{name}\"")).unwrap_or_default();
        let mut writer = Self {
            out: b"<?xml version=\"1.0\"?>\n".to_vec(),
            depth: 0,
            encoding: options.encoding,
            compression,
            compressor: Compressor::new(compression),
            appended: Vec::new(),
            lost: Vec::new(),
        };
        writer.open(&format!(
            "VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\"{compressor}"
        ));
        writer.open(kind);
        writer
    }

    /// Opens an element; `tag` is its name with any attributes.
    pub(super) fn open(&mut self, tag: &str) {
        self.line(&format!("<{tag}>"));
        self.depth += 1;
    }

    pub(super) fn close(&mut self, name: &str) {
        self.depth -= 1;
        self.line(&format!("</{name}>"));
    }

    fn line(&mut self, text: &str) {
        self.out.extend(std::iter::repeat_n(b' ', 2 * self.depth));
        self.out.extend(text.as_bytes());
        self.out.push(b'\n');
    }

    /// Writes an element with an array for each field; `rows` states whether to include the number of rows.
    pub(super) fn fields(&mut self, name: &str, fields: &[&'a Field], rows: bool) -> Result<()> {
        self.open(name);
        for field in fields {
            let n_rows = rows.then(|| field.n_rows());
            self.array(&field.name, field.components, n_rows, Data::Values(&field.values))?;
        }
        self.close(name);
        Ok(())
    }

    /// Writes an array.
    pub(super) fn array(
        &mut self,
        name: &str,
        components: usize,
        rows: Option<usize>,
        data: Data<'a>,
    ) -> Result<()> {
        let tag = if data.type_name() == "String" { "Array" } else { "DataArray" };
        let mut attributes = format!("{tag} type=\"{}\" Name=\"{}\"", data.type_name(), self.escaped(name));
        if components != 1 {
            attributes += &format!(" NumberOfComponents=\"{components}\"");
        }
        if let Some(rows) = rows {
            attributes += &format!(" NumberOfTuples=\"{rows}\"");
        }
        self.note_zero_bytes(name, &data);
        match self.encoding {
            Encoding::Binary => {
                let start = format!("<{attributes} format=\"appended\" offset=\"");
                let offset_at = self.out.len() + 2 * self.depth + start.len();
                self.line(&format!("{start}{OFFSET_BLANKS}/>"));
                self.appended.push((offset_at, data));
                return Ok(());
            }
            Encoding::Ascii => {
                self.open(&format!("{attributes} format=\"ascii\""));
                write_ascii(&mut self.out, &data);
            }
            Encoding::Base64 => {
                self.open(&format!("{attributes} format=\"binary\""));
                self.base64(&data)?;
            }
        }
        self.close(tag);
        Ok(())
    }

    fn base64(&mut self, data: &Data<'_>) -> Result<()> {
        let mut raw = Vec::new();
        let header = write_raw(&mut raw, data, self.compression, &mut self.compressor)?;
        // VTK decodes the header of compressed data separately, so it needs its own padding.
        let header = if self.compression == Compression::None { 0 } else { header };
        let text = STANDARD.encode(&raw[..header]) + &STANDARD.encode(&raw[header..]);
        self.out.extend(text.as_bytes());
        self.out.push(b'\n');
        Ok(())
    }

    /// Closes all elements, adds the appended arrays, and writes everything to `sink`; returns what could not
    /// be written unchanged.
    ///
    /// Uncompressed arrays are written directly: copying a large mesh in memory would take as long as writing
    /// it.
    pub(super) fn finish(mut self, kind: &str, sink: &mut dyn Write) -> Result<Vec<String>> {
        self.close(kind);
        let arrays = std::mem::take(&mut self.appended);
        let any_appended = !arrays.is_empty();
        let mut uncompressed = Vec::new();
        if any_appended {
            self.line("<AppendedData encoding=\"raw\">");
            self.out.push(b'_');
            let start = self.out.len();
            let mut end = start;
            for (offset_at, data) in arrays {
                let offset = format!("{}\"", end - start);
                self.out[offset_at..offset_at + offset.len()].copy_from_slice(offset.as_bytes());
                if self.compression == Compression::None {
                    end += 8 + data.n_bytes();
                    uncompressed.push(data);
                } else {
                    write_raw(&mut self.out, &data, self.compression, &mut self.compressor)?;
                    end = self.out.len();
                }
            }
        }
        write_all(sink, &self.out)?;
        for data in &uncompressed {
            write_all(sink, &(data.n_bytes() as u64).to_ne_bytes())?;
            data.write_to(sink)?;
        }
        self.out.clear();
        if any_appended {
            self.out.push(b'\n');
            self.line("</AppendedData>");
        }
        self.close("VTKFile");
        write_all(sink, &self.out)?;
        Ok(self.lost)
    }

    /// Escapes `text` for the value of an attribute.
    fn escaped(&mut self, text: &str) -> String {
        let breaks = ['\t', '\n', '\r'];
        let illegal =
            |c: char| (c.is_control() && !breaks.contains(&c)) || matches!(c, '\u{fffe}' | '\u{ffff}');
        let mut legal = Cow::Borrowed(text);
        if text.contains(illegal) {
            legal = Cow::Owned(text.replace(illegal, "?"));
            self.lost.push(format!(
                "the name {text:?} has characters that XML does not allow: they are replaced by question marks"
            ));
        }
        let escaped = quick_xml::escape::escape(&*legal);
        escaped.replace('\t', "&#9;").replace('\n', "&#10;").replace('\r', "&#13;")
    }

    fn note_zero_bytes(&mut self, name: &str, data: &Data<'_>) {
        if matches!(data, Data::Values(Values::Text(texts)) if texts.iter().any(|t| t.contains('\0'))) {
            self.lost
                .push(format!("texts of the array {name} contain zero bytes, which end a text in VTK files"));
        }
    }
}

/// Appends the header and the blocks of an array; returns the size of the header in bytes.
fn write_raw(
    out: &mut Vec<u8>,
    data: &Data<'_>,
    compression: Compression,
    compressor: &mut Compressor,
) -> Result<usize> {
    let n_bytes = data.n_bytes();
    let start = out.len();
    if compression == Compression::None {
        out.extend((n_bytes as u64).to_ne_bytes());
        data.blocks(|_, block| {
            out.extend_from_slice(block);
            Ok(())
        })?;
        return Ok(8);
    }
    let n_blocks = n_bytes.div_ceil(BLOCK);
    let header = (3 + n_blocks) * 8;
    for word in [n_blocks, BLOCK, n_bytes % BLOCK] {
        out.extend((word as u64).to_ne_bytes());
    }
    out.resize(start + header, 0);
    let mut size_at = start + 3 * 8;
    data.blocks(|_, block| {
        let from = out.len();
        compressor.compress(block, out)?;
        let size = (out.len() - from) as u64;
        out[size_at..size_at + 8].copy_from_slice(&size.to_ne_bytes());
        size_at += 8;
        Ok(())
    })?;
    Ok(header)
}

/// Writes an array as text; texts become the numbers of their bytes.
fn write_ascii(out: &mut Vec<u8>, data: &Data<'_>) {
    match data {
        Data::Values(values @ Values::Text(_)) => write_lines(out, &native_bytes(values)),
        Data::Values(values) => write_text(out, values),
        Data::Points(points) => write_lines(out, points.as_flattened()),
        Data::Ids(ids) => write_lines(out, ids),
        Data::Int64(values) => write_lines(out, values),
        Data::Bytes(bytes) => write_lines(out, bytes),
    }
}

/// Concatenated ids as plain numbers.
pub(super) fn plain(ids: &[VertexId]) -> &[u32] {
    bytemuck::cast_slice(ids)
}

/// The end of each list.
pub(super) fn ends(lists: &Csr<VertexId>) -> &[u32] {
    &lists.offsets()[1..]
}
