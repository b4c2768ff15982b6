//! Elements and arrays of a VTK XML file, written out.

use std::borrow::Cow;
use std::io::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::base::{Csr, Error, ErrorKind, Point, Result, VertexId};
use crate::io::format::{Compression, Encoding, WriteOptions};
use crate::io::scalar::{native_bytes, write_lines, write_text};
use crate::io::vtkxml::codec::{Packer, vtk_name};
use crate::mesh::{Field, Values};

/// Bytes packed at a time: VTK's own choice, and the reach of zlib's window.
const BLOCK: usize = 32 << 10;
/// Room for an offset, which is known only when the array is written.
const OFFSET_BLANKS: &str = "                      ";

/// The values of an array to be written.
pub(super) enum Data<'a> {
    Values(&'a Values),
    Points(&'a [Point]),
    /// Ids, or places in a list, as Int64.
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

    /// The bytes as they stand in memory; `None` for ids, which are widened on the way.
    fn bytes(&self) -> Option<Cow<'_, [u8]>> {
        match self {
            Self::Values(values) => Some(native_bytes(values)),
            Self::Points(points) => Some(Cow::Borrowed(bytemuck::cast_slice(points))),
            Self::Int64(values) => Some(Cow::Borrowed(bytemuck::cast_slice(values))),
            Self::Bytes(bytes) => Some(Cow::Borrowed(bytes)),
            Self::Ids(_) => None,
        }
    }

    /// Calls `each` on blocks of `BLOCK` bytes, the last one shorter; `each`
    /// hears how many bytes there are in all first.
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

    /// All bytes, in as few pieces as may be.
    fn give_to(&self, sink: &mut dyn Write) -> Result<()> {
        match self.bytes() {
            Some(bytes) => give(sink, &bytes),
            None => self.blocks(|_, block| give(sink, block)),
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

fn give(sink: &mut dyn Write, bytes: &[u8]) -> Result<()> {
    sink.write_all(bytes).map_err(|e| Error::new(ErrorKind::Output, format!("cannot be written: {e}")))
}

/// A file on its way out.
pub(super) struct Writer<'a> {
    out: Vec<u8>,
    depth: usize,
    encoding: Encoding,
    compression: Compression,
    packer: Packer,
    /// Arrays for the appended part: where their offset goes, and their data.
    appended: Vec<(usize, Data<'a>)>,
    /// What could not be written as it was.
    pub(super) lost: Vec<String>,
}

impl<'a> Writer<'a> {
    /// Starts a file that holds `kind`.
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
            packer: Packer::new(compression),
            appended: Vec::new(),
            lost: Vec::new(),
        };
        writer.open(&format!(
            "VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\"{compressor}"
        ));
        writer.open(kind);
        writer
    }

    /// Opens an element: its name, and its attributes if it has any.
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

    /// Writes an element with one array for each field; `rows` also says how many rows each has.
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
        let header = write_raw(&mut raw, data, self.compression, &mut self.packer)?;
        // VTK reads the header of compressed data on its own, and so wants it padded.
        let header = if self.compression == Compression::None { 0 } else { header };
        let text = STANDARD.encode(&raw[..header]) + &STANDARD.encode(&raw[header..]);
        self.out.extend(text.as_bytes());
        self.out.push(b'\n');
        Ok(())
    }

    /// Closes everything, adds the appended arrays, and gives it all to `sink`;
    /// returns what could not be written as it was.
    ///
    /// Arrays that are not packed go to the sink as they are: a copy of a large mesh
    /// in memory would cost as much time as the writing itself.
    pub(super) fn finish(mut self, kind: &str, sink: &mut dyn Write) -> Result<Vec<String>> {
        self.close(kind);
        let arrays = std::mem::take(&mut self.appended);
        let any_appended = !arrays.is_empty();
        let mut unpacked = Vec::new();
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
                    unpacked.push(data);
                } else {
                    write_raw(&mut self.out, &data, self.compression, &mut self.packer)?;
                    end = self.out.len();
                }
            }
        }
        give(sink, &self.out)?;
        for data in &unpacked {
            give(sink, &(data.n_bytes() as u64).to_ne_bytes())?;
            data.give_to(sink)?;
        }
        self.out.clear();
        if any_appended {
            self.out.push(b'\n');
            self.line("</AppendedData>");
        }
        self.close("VTKFile");
        give(sink, &self.out)?;
        Ok(self.lost)
    }

    /// `text` as the value of an attribute.
    fn escaped(&mut self, text: &str) -> String {
        let breaks = ['\t', '\n', '\r'];
        let illegal =
            |c: char| (c.is_control() && !breaks.contains(&c)) || matches!(c, '\u{fffe}' | '\u{ffff}');
        let mut legal = Cow::Borrowed(text);
        if text.contains(illegal) {
            legal = Cow::Owned(text.replace(illegal, "?"));
            self.lost.push(format!(
                "the name {text:?} has characters that XML forbids: they became question marks"
            ));
        }
        let escaped = quick_xml::escape::escape(&*legal);
        escaped.replace('\t', "&#9;").replace('\n', "&#10;").replace('\r', "&#13;")
    }

    fn note_zero_bytes(&mut self, name: &str, data: &Data<'_>) {
        if matches!(data, Data::Values(Values::Text(texts)) if texts.iter().any(|t| t.contains('\0'))) {
            self.lost
                .push(format!("texts of the array {name} hold zero bytes, which end a text in VTK's files"));
        }
    }
}

/// Adds the header and the blocks of one array; returns the bytes of the header.
fn write_raw(
    out: &mut Vec<u8>,
    data: &Data<'_>,
    compression: Compression,
    packer: &mut Packer,
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
        packer.pack(block, out)?;
        let size = (out.len() - from) as u64;
        out[size_at..size_at + 8].copy_from_slice(&size.to_ne_bytes());
        size_at += 8;
        Ok(())
    })?;
    Ok(header)
}

/// As text; texts as the numbers of their bytes.
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

/// The ids of lists, end to end, as plain numbers.
pub(super) fn plain(ids: &[VertexId]) -> &[u32] {
    bytemuck::cast_slice(ids)
}

/// Where each list ends.
pub(super) fn ends(lists: &Csr<VertexId>) -> &[u32] {
    &lists.offsets()[1..]
}
